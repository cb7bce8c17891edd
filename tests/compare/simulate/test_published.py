"""Published models have their faults and no others; fixed, they sweep as the beam that they are."""

from dataclasses import replace

import pytest

from analytic import CLAMP_READINGS, Beam, solve_sweep
from compare.read.case import load_case
from compare.simulate.expected import SPEED, expected
from compare.simulate.fixing import case_of, fix
from compare.simulate.inspection import Inspection
from mujoco_models import available_beams, inspect_model, simulate_model
from tests.compare.simulate.faults import faults_in
from tests.compare.simulate.published import CABLES, CHAINS
from tests.mujoco_models.export.plain import worst_rms

MODELS = CHAINS | (CABLES if "cable" in available_beams() else {})
SENSORS = {"force sensor", "torque sensor"}
# What is wrong, what no number fixes, and the rms of the fixed one's sweep. Contacts are as hard as
# they can be without chatter: of the cables, they make a third.
FOUND = {
    "RatteChan": ({"clamp", "contact"}, set(), 0.0040),
    "Whisker on a magnet": ({"clamp", "contact"} | SENSORS, set(), 0.0049),
    "WhiskerFBG": ({"clamp", "gravity", "contact", "damping"}, set(), 0.0027),
    "MuJoCo's cable": ({"clamp", "gravity", "contact"}, set(), 0.0021),
    "CathSim's guidewire": ({"clamp", "gravity", "contact", "damping"}, set(), 0.0042),
    # It twists 490 times as easily as it bends, by a modulus that inspect cannot set.
    "MuJoCo's cantilever": (
        {"clamp", "torsion", "contact", "time step", "damping"}, {"torsion"}, None,
    ),
    "Tentacle": ({"clamp", "gravity", "contact", "damping"}, set(), 0.0080),
    # Ten links are 0.8 per cent off by themselves. Swept until it would leave its plane: over the
    # whole way, where it slips off sideways, the mean is 0.0113. Its pieces are steps of a taper:
    # by 11 per cent higher ones than of a course from 20 to 15 mm, which left 0.0129.
    "Elephant's trunk": (
        {"clamp", "limits", "radius", "gravity", "contact", "damping"}, set(), 0.0141,
    ),
    # A hand of a million kilograms: once its contacts are hard, MuJoCo's solver stops before they
    # hold, which is then fixed, too. Contacts five
    # times as hard are 9.1e-3 off, but chatter: at 5 stations of 60, which is a fault.
    "Whip of 15": ({"clamp", "radius", "gravity", "contact"}, set(), 0.0125),
    # A cone of 1 to 30: its last links are too few.
    "Rat's whisker": ({"links", "gravity", "contact"}, {"links"}, 0.04),
    "Mouse's whisker": ({"clamp", "contact", "damping"}, set(), 0.0040),
    # Boxes: what touches them feels steps of their thickness.
    "Spiral robot": ({"clamp", "radius", "gravity", "contact"}, {"radius"}, 0.13),
}  # fmt: skip
_STEPS = 400  # in T1, of those whose own are far shorter
_STABLE = 0.4  # of the longest step of a plugin


def fixed(name, folder):
    path = folder / "published.xml"
    path.write_text(MODELS[name]().text)
    before = Inspection(inspect_model(path))
    return before, fix(path, {}, before, folder / "fixed.xml")


def swept(found, file):
    """The worst reading's rms, of all stations in contact, whether they are trusted or not."""
    case = file.with_name("case.toml")
    case.write_text(case_of(found, file, {}))
    job = load_case(case)
    longer = found.period / found.timestep / _STEPS
    if found.springs == "plugin":
        longer = min(longer, _STABLE * found.stable_step / found.timestep)
    model = replace(job.model, timestep=max(longer, 1.0))
    moved = simulate_model(job.case, model, job.motion, job.settings)
    return worst_rms(solve_sweep(job.case), [moved.values(name) for name in CLAMP_READINGS])


@pytest.mark.parametrize("name", [name for name in FOUND if name in MODELS])
def test_published_models_have_their_faults_and_no_others(name, tmp_path):
    subjects, left, _ = FOUND[name]
    before, after = fixed(name, tmp_path)
    assert faults_in(before) == subjects
    assert faults_in(after.inspection) == left


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in FOUND if name in MODELS and FOUND[name][2]])
def test_fixed_they_sweep_as_their_beam(name, tmp_path):
    _, left, most = FOUND[name]
    _, after = fixed(name, tmp_path)
    found = after.inspection.found
    off = swept(found, after.files[0])
    assert off < most
    if not left:
        assert off < expected(found, SPEED).interval[1]


def test_a_cone_whose_springs_do_not_taper_keeps_its_rigidity():
    """A table of one value is no number, which would follow the radius."""
    beam = Beam(0.4, [[0, 4], [0.2, 4], [0.4, 4]], 0.02, tip_radius=0.015)
    assert replace(beam, radius=0.019).rigidity_at(0.4) == 4
    assert Beam(0.4, 4.0, 0.02, tip_radius=0.015).rigidity_at(0.4) == pytest.approx(4 * 0.75**4)
