"""Planted mistakes are named, and sound models are called sound."""

import mujoco
import numpy as np
import pytest

from analytic import Beam
from compare.simulate.inspection import Inspection
from compare.simulate.rigidity import clamp_stiffness
from mujoco_models import inspect_model, shipped_models
from tests.compare.command import vibrissa
from tests.mujoco_models.inspect.chains import Chain

STATED = Beam()
NO_CONTACTS = '<option><flag contact="disable"/></option></mujoco>'
FORCE = '<force name="F" site="clamp" {}/><torque name="T" site="clamp"/>'


def faults(tmp_path, chain, stated=STATED):
    found = Inspection(inspect_model(chain.write(tmp_path)), stated)
    return [str(remark) for remark in found.remarks if remark.kind == "fault"]


@pytest.mark.parametrize(
    "sound",
    [
        Chain(),
        Chain(links=10),
        pytest.param(Chain(links=60), marks=pytest.mark.slow),
        Chain(foot="", inside_foot='<joint name="rail" type="slide" axis="1 0 0"/>'),
        Chain(site='euler="0 0 1.5707963267948966"'),
        Chain(stiffer={i: (1 - 0.04 * i) ** 4 for i in range(1, 21)}),  # a straight taper
    ],
)
def test_sound_models_are_called_sound(tmp_path, sound):
    tapers = bool(sound.stiffer)
    assert faults(tmp_path, sound, None if tapers else STATED) == []


@pytest.mark.parametrize(
    "links", [12, *(pytest.param(n, marks=pytest.mark.slow) for n in (20, 40))]
)
@pytest.mark.parametrize(
    ("mistake", "said"),
    [
        ({"rigidity": 1.05}, "EI: 1.05, which is 5.0% more than stated"),
        ({"rigidity": 0.95}, "EI: 0.95, which is 5.0% less than stated"),
        ({"length": 1.02, "rigidity": 1.0}, "length: 1.02, which is 2.0% more than stated"),
        ({"stiffer": {7: 1.2}}, "uniformity: the joint of 'whisker7'"),
        ({"stiffer": {4: 0.8}}, "is 20% too soft beside its neighbours"),
        ({"first": "end"}, "the first link is rigid over a whole cell"),
        ({"first": "start"}, "the hinge at the clamp should stand for half a cell"),
        ({"site": 'euler="0 0 0.05"'}, "'F' is turned by 2.9 degrees"),
        ({"site": 'euler="0.05 0 0"'}, "'T' is turned by 2.9 degrees"),
        ({"site": 'pos="0 -0.05 0"'}, "torque sensor: 'T' is 0.05 L away"),
        ({"gravity": "0.5 0 0"}, "gravity: 0.5 bends the vibrissa"),
        ({"tip": 'contype="2" conaffinity="2"'}, "1 of"),
        ({"tip": 'contype="0" conaffinity="0"'}, "meet no object"),
        ({"tip": 'solref="0.5 1"'}, "contact: solref of 0.5"),
        ({"curvature": 0.1}, "natural curvature: 0.1/L instead of 0/L"),
        ({"sensors": '<force name="F" site="clamp"/>'}, "torque sensor: none"),
        ({"sensors": '<torque name="T" site="clamp"/>'}, "force sensor: none"),
        ({"length": 1000.0, "radius": 5.0}, "units: the length is 1000, 1000 times"),
        ({"tip": 'margin="0.02"'}, "contact: a margin of 0.02 pushes before anything touches"),
        ({"sensors": FORCE.format('cutoff="1"')}, "force sensor: 'F' is cut off at 1"),
    ],
)
def test_planted_mistakes_are_named_and_nothing_else(tmp_path, mistake, said, links):
    found = faults(tmp_path, Chain(links=links, **mistake))
    assert any(said in fault for fault in found), found
    subjects = {fault.split(":")[0].removeprefix("fault, ") for fault in found}
    # One cause may show in two ways: both sensors share a site, and the joint at the clamp is felt
    # by the tip.
    assert len(subjects - {"force sensor", "torque sensor"}) <= 1, found


def test_a_foot_that_is_fixed_to_the_world_touches_its_first_link(tmp_path):
    """MuJoCo lets no parent touch its child, but the world."""
    found = faults(tmp_path, Chain(foot=""))
    assert any("whisker-geom0 and whisker-geom1 touch" in fault for fault in found)
    assert any("nothing can move" in fault for fault in found)


def changed(tmp_path, chain, *changes):
    path = chain.write(tmp_path)
    text = path.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    path.write_text(text)
    return Inspection(inspect_model(path), STATED).remarks


def test_disabled_contacts_meet_nothing(tmp_path):
    found = changed(tmp_path, Chain(), ("</mujoco>", NO_CONTACTS))
    assert any("21 of 21 geoms" in str(remark) for remark in found)


def test_what_is_only_seen_is_no_part_of_it(tmp_path):
    """Balls without contacts beside capsules that have some: neither its tip nor a fault."""
    seen = '<geom type="sphere" size="0.002" pos="0 0.01 0" contype="0" conaffinity="0"/>'
    found = changed(
        tmp_path, Chain(), ('<geom name="whisker-geom', f'{seen}<geom name="whisker-geom')
    )
    assert [remark for remark in found if remark.kind == "fault"] == []


def test_a_medium_is_noted(tmp_path):
    found = changed(tmp_path, Chain(), ('integrator="', 'density="1000" integrator="'))
    assert [remark.subject for remark in found if remark.subject == "medium"] == ["medium"]


@pytest.mark.skipif(not hasattr(mujoco.MjModel, "jnt_stiffnesspoly"), reason="of MuJoCo 4")
def test_springs_that_stiffen_are_no_lack_of_links(tmp_path):
    found = changed(tmp_path, Chain(), ('stiffness="20.0"', 'stiffness="20 0 1e4"'))
    assert any("its springs stiffen" in str(remark) for remark in found)


def test_a_curved_one_is_sound_if_that_is_stated(tmp_path):
    curved = Chain(curvature=0.3)
    assert faults(tmp_path, curved, Beam(natural_curvature=0.3)) == []
    assert faults(tmp_path, curved, Beam(natural_curvature=-0.3)) != []


@pytest.mark.parametrize(
    ("chain", "stiffness"),
    [
        (Chain(), np.inf),
        (Chain(first="start"), 40.0),  # the first hinge, EI/h, stands for half a cell: 2 N EI/L
        (Chain(stiffer={1: 0.5}), 20.0),  # one cell's bending too much: N EI/L
        (Chain(stiffer={i: (1 - 0.04 * i) ** 4 for i in range(1, 21)}), np.inf),
    ],
)
def test_the_clamps_compliance_is_measured(tmp_path, chain, stiffness):
    found = Inspection(inspect_model(chain.write(tmp_path)))
    assert clamp_stiffness(found.found) == pytest.approx(stiffness, rel=1e-6)
    word = "rigid" if np.isinf(stiffness) else f"turns, by a spring of {stiffness:g} EI/L"
    assert any(line.split()[0] == "clamp" and word in line for line in found.lines())


def test_the_command_prints_and_writes_it(tmp_path):
    done = vibrissa("inspect", "sound-chain", "--out", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "sound chain, in its own units: sound" in done.stdout
    assert (tmp_path / "out" / "inspection.json").is_file()
    done = vibrissa("inspect", "mistakes", cwd=tmp_path)
    assert done.returncode == 1
    for word in ("link8", "rigid over a whole cell", "nothing can move", "time step", "3 degrees"):
        assert word in done.stdout
    (tmp_path / "beam.toml").write_text(
        '[beam]\nlength = "100 mm"\nflexural_rigidity = "6.44e-4 N m^2"\nradius = "0.25 mm"\n'
    )
    done = vibrissa("inspect", "sound-chain", "--beam", "beam.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize(
    "words",
    [("nope",), ("nope.xml",), ("sound-chain", "--foot", "x"), ("sound-chain", "--geoms", "y*")],
)
def test_what_is_wrong_is_one_line(tmp_path, words):
    done = vibrissa("inspect", *words, cwd=tmp_path)
    done.refused()


def test_the_shipped_models_have_the_faults_that_they_say():
    """And no others: the tapered whisker and the sound chain have none."""
    found = {
        name: {r.subject for r in Inspection(inspect_model(path)).remarks if r.kind == "fault"}
        for name, path in shipped_models().items()
        if name != "cable" and "rod" not in name
    }
    assert found == {
        "sound-chain": set(),
        "tapered-whisker": {"contact", "time step"},
        "tutorial-chain": {"clamp", "contact"},
        "mistakes": {
            "clamp",
            "uniformity",
            "gravity",
            "foot",
            "force sensor",
            "torque sensor",
            "contact",
            "time step",
        },
    }
