"""Planted mistakes of MuJoCo 4's rods, of ten edges, are named, and a sound rod is called sound."""

from dataclasses import replace

import pytest

from analytic import Beam
from compare.simulate.fixing import fix
from compare.simulate.inspection import Inspection
from compare.simulate.rigidity import clamp_stiffness
from mujoco_models import available_beams, inspect_model
from tests.mujoco_models.inspect.rods import Rod

pytestmark = pytest.mark.skipif("rod" not in available_beams(), reason="a rod bends since MuJoCo 4")
STATED = Beam(0.1, 6.44e-4, 2.5e-4)


def faults(tmp_path, rod):
    found = Inspection(inspect_model(rod.write(tmp_path)), STATED)
    assert [*found.lines()]
    return [str(remark) for remark in found.remarks if remark.kind == "fault"]


@pytest.mark.parametrize(
    "sound",
    [
        Rod(edges=12),
        pytest.param(Rod(), marks=pytest.mark.slow),
        pytest.param(Rod(10, dof=""), marks=pytest.mark.slow),
        pytest.param(Rod(10, site='euler="0 0 90"'), marks=pytest.mark.slow),
    ],
)
def test_sound_rods_are_called_sound(tmp_path, sound):
    assert faults(tmp_path, sound) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    ("rod", "said"),
    [
        (Rod(rigidity=1.05 * 6.44e-4), "EI: 0.000676203, which is 5.0% more than stated"),
        (Rod(rigidity=0.95 * 6.44e-4), "EI: 0.000611803, which is 5.0% less than stated"),
        (Rod(length=0.102), "length: 0.102, which is 2.0% more than stated"),
        (Rod(radius=5e-4), "radius: 0.0005 instead of 0.00025"),
        (Rod(ahead=0.0), "clamp: bends like EI 16.7% higher"),
        (Rod(edge='<edge equality="true"/>'), "edges: a pull of 3 EI/L^2 stretches one to more"),
        (Rod(edge='<edge equality="true" solref="0.001 1" solimp="0.99 0.99 0.001"/>'),
         "edges: a pull of 3 EI/L^2 stretches one by 2.1%"),
        (Rod(own_tree=True), "sensor: 'F' reads nothing of contacts"),
        (Rod(site='euler="0 0 3"'), "'F' is turned by 3 degrees"),
        (Rod(contact='condim="1"'), "contact: solref of 0.02"),
        (Rod(contact=Rod.contact + ' contype="2" conaffinity="2"'), "10 of 10 geoms"),
        (Rod(gravity="9.81 0 0"), "gravity: 9.81 bends the vibrissa"),
        (Rod(hand=""), "nothing can move"),
    ],
)  # fmt: skip
def test_planted_mistakes_are_named_and_nothing_else(tmp_path, rod, said):
    found = faults(tmp_path, replace(rod, edges=10))
    assert any(said in fault for fault in found), found
    subjects = {fault.split(":")[0].removeprefix("fault, ") for fault in found}
    # Both sensors share a site.
    assert len(subjects - {"force sensor", "torque sensor"}) <= 1, found


@pytest.mark.slow
def test_a_soft_weld_is_a_clamp_that_turns(tmp_path):
    """The tip gives way more by L^2 over the clamp's stiffness, and by what the weld shifts."""
    hard, soft = (inspect_model(Rod(10, weld=weld).write(tmp_path)) for weld in (Rod.weld, ""))
    # EI and L in natural units: the tip's compliance is 1/3, and 1/k more.
    more = (1 / soft.tip_rigidity - 1 / hard.tip_rigidity) * 6.44e-4 / 3
    assert 0.5 * more < 1 / clamp_stiffness(soft) < more
    assert any("turns, by a spring" in line for line in Inspection(soft, STATED).lines())


@pytest.mark.slow
def test_what_can_leave_the_plane_has_a_note(tmp_path):
    for dof, count in (("", 1), ('dof="2d"', 0)):
        found = Inspection(inspect_model(Rod(10, dof=dof).write(tmp_path)), STATED)
        assert [remark.subject for remark in found.remarks].count("plane") == count


def test_behind_a_rigid_first_edge_it_begins_where_the_sensors_are(tmp_path):
    """On the hand, and not on the free body that the rod hangs on, which feels no contacts."""
    path = Rod(ahead=0.0).write(tmp_path)
    before = Inspection(inspect_model(path))
    after = fix(path, {}, before, tmp_path / "fixed.xml").inspection
    assert [r.subject for r in before.remarks if r.kind == "fault"] == ["clamp"]
    assert after.sound, after.remarks
    assert after.found.length == pytest.approx(0.1 * (1 - 1 / 40), rel=1e-3)
