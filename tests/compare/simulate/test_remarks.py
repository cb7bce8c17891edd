"""Planted mistakes are named, and sound models are called sound."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic import Beam
from compare.measure.cantilever import tip_of
from compare.simulate.inspection import Inspection
from compare.simulate.rigidity import clamp_stiffness
from mujoco_models import inspect_model, shipped_models
from tests.compare.command import vibrissa
from tests.mujoco_models.inspect.chains import Chain

STATED = Beam()
DATA = Path(__file__).parents[2] / "data"


def faults(tmp_path, chain, stated=STATED):
    found = Inspection(inspect_model(chain.write(tmp_path)), stated)
    return [str(remark) for remark in found.remarks if remark.kind == "fault"]


def test_the_exact_cantilever():
    """Against integration of the elastica; see tests/data/README.md."""
    table = pd.read_csv(DATA / "cantilever_tip_load.csv")
    found = tip_of(table["PL2_EI"].to_numpy())
    expected = table[["w_over_L", "u_over_L"]].to_numpy()
    np.testing.assert_allclose(found, expected, atol=1e-12)


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
        ({"first": "start"}, "the hinge at the clamp stands for half a cell"),
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
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


def test_the_shipped_models_have_the_faults_that_they_say():
    """And no others: the tapered whisker and the sound chain have none."""
    found = {
        name: {r.subject for r in Inspection(inspect_model(path)).remarks if r.kind == "fault"}
        for name, path in shipped_models().items()
        if name != "cable" and "rod" not in name
    }
    assert found == {
        "sound-chain": set(),
        "tapered-whisker": set(),
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
