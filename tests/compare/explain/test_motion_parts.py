"""The arithmetic of a budget in motion: one known part each, found to the last digit but six."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analytic import CLAMP_READINGS
from compare.explain.motion import (
    MotionBudget,
    motion_budget,
    slower_and_finer,
    slower_and_finer_of_model,
)
from mujoco_models import Motion, OwnModel
from tests.compare.synthetic import (
    EXACT,
    MOTION,
    SIZES,
    TOUCHING,
    added,
    in_motion,
    pattern,
)

SIZE = 1e-2
PARTS = ("rate", "damping", "time step", "contact model", "solver", "at rest", "unexplained")


def split(order=1.0, of=MOTION, **sizes) -> MotionBudget:
    return motion_budget(EXACT, in_motion(of, order, **sizes))


def of(found: MotionBudget, name: str, what: str = "rms") -> np.ndarray:
    return np.array([getattr(found.parts[name][reading], what) for reading in CLAMP_READINGS])


@pytest.mark.parametrize("planted", PARTS)
@pytest.mark.parametrize("order", [1.0, 1.4, 2.0])
def test_one_part_is_found_whole_and_no_other(planted, order):
    """The rate is always there: the order is observed in it."""
    sizes = {"rate": 3e-3} | {planted: SIZE}
    found = split(order, **{name.replace(" ", "_"): size for name, size in sizes.items()})
    assert found.order == pytest.approx(order, abs=1e-6)
    assert set(found.parts) == set(PARTS)
    for name in PARTS:
        np.testing.assert_allclose(of(found, name), sizes.get(name, 0.0) * SIZES, 0, 1e-9)
    assert found.stations == TOUCHING.sum()


def test_a_slow_sweep_is_extrapolated_from_faster_ones():
    found = split(2.0, replace(MOTION, speed=0.004), rate=SIZE, time_step=SIZE)
    np.testing.assert_allclose(of(found, "rate"), SIZE * SIZES, rtol=1e-6)
    np.testing.assert_allclose(of(found, "time step"), SIZE * SIZES, rtol=1e-6)
    np.testing.assert_allclose(of(found, "rate", "uncertainty"), 1.25 * SIZE * SIZES, rtol=1e-6)


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_a_part_is_as_uncertain_as_its_extrapolation(order):
    """The rate by what the slowest sweep still has; what damping may take from it is in that."""
    found = split(order, rate=SIZE)
    slowest = 1.25 * SIZE * SIZES / 4**order
    np.testing.assert_allclose(of(found, "rate", "uncertainty"), slowest, rtol=1e-6)
    found = split(rate=1e-9, time_step=SIZE, contact_model=SIZE, solver=SIZE, at_rest=SIZE)
    for name, share in (("time step", 1.0), ("contact model", 0.0), ("at rest", 0.0)):
        np.testing.assert_allclose(of(found, name, "uncertainty"), share * SIZE * SIZES, 0, 1e-9)
    np.testing.assert_allclose(of(found, "unexplained", "uncertainty"), SIZE * SIZES, 1e-6)
    ours = motion_budget(EXACT, in_motion(rate=1e-9, at_rest=SIZE), of_our_chain=True)
    np.testing.assert_allclose(of(ours, "at rest", "uncertainty"), SIZE * SIZES, rtol=1e-6)


def test_damping_is_as_uncertain_as_what_was_measured_of_it():
    """Half of it, which makes the rate uncertain, too, and not what is left."""
    found = split(damping=SIZE)
    slowest = 1.25 * SIZE * SIZES / 4
    np.testing.assert_allclose(of(found, "damping", "uncertainty"), SIZE / 2 * SIZES, rtol=1e-6)
    rate = np.hypot(slowest, SIZE / 2 * SIZES)
    np.testing.assert_allclose(of(found, "rate", "uncertainty"), rate, rtol=1e-6)
    np.testing.assert_allclose(of(found, "unexplained", "uncertainty"), slowest, rtol=1e-6)


def test_softness_and_the_beam_by_sweeps_of_their_own():
    """A user's model with our contacts four times as stiff, at half the step: 4/3 of the change."""
    runs = in_motion(rate=1e-6, time_step=3e-3)
    soft = SIZE * pattern("softness")
    stiff = added(runs["fine"], soft / 4)
    runs = {name: added(run, soft) for name, run in runs.items() if name not in ("ours", "rest")}
    # Contacts of ours are as soft as those that are stiffened, the sweep at rest has hard ones.
    rest = in_motion()["rest"]
    beam = added(EXACT, SIZE / 2 * pattern("length"))
    found = motion_budget(EXACT, {**runs, "stiff": stiff, "rest": rest, "beam": beam})
    np.testing.assert_allclose(of(found, "softness"), SIZE * SIZES, rtol=1e-6)
    uncertain = 1.25 * SIZE / 3 * SIZES
    np.testing.assert_allclose(of(found, "softness", "uncertainty"), uncertain, rtol=1e-6)
    np.testing.assert_allclose(of(found, "beam"), SIZE / 2 * SIZES, rtol=1e-6)
    np.testing.assert_allclose(of(found, "beam", "uncertainty"), 0.0, atol=1e-12)


@pytest.mark.parametrize(
    ("sizes", "closes", "blame"),
    [
        ({"rate": 1e-9, "unexplained": 2.4e-5}, True, "unexplained"),
        ({"rate": 1e-9, "unexplained": 2.6e-5}, False, "unexplained"),  # 5.2e-5 in force_y
        ({"at_rest": 0.1, "rate": 1e-9, "missing": 0.11}, True, "at rest"),
        ({"at_rest": 0.1, "rate": 1e-9, "missing": 0.12}, False, "at rest"),
        # All of a part of the step is uncertain, and so it is not to blame.
        ({"time_step": 0.1, "at_rest": 0.01, "rate": 1e-9, "missing": 0.0}, True, "at rest"),
    ],
)
def test_when_a_budget_closes_and_what_it_blames(sizes, closes, blame):
    """A tenth of the whole may be left: of one pattern, 0.11/1.11 and not 0.12/1.12."""
    share = sizes.pop("missing", 0.0)
    runs = in_motion(**sizes)
    more = share * sizes.get("at_rest", 0.0) * pattern("at_rest")
    runs = {name: run if name == "rest" else added(run, more) for name, run in runs.items()}
    found = motion_budget(EXACT, runs)
    assert (found.closes, found.blame) == (closes, blame)


def test_a_models_stiffer_contacts_are_ours():
    model = OwnModel(Path("my.xml"))
    found = slower_and_finer_of_model(model, Motion(speed=0.08))
    stiff, motion = found["stiff"]
    assert (stiff.contact, stiff.stiffness, stiff.timestep) == ("ours", 4, 0.5)
    assert motion.speed == 0.02
    assert "stiff" not in slower_and_finer_of_model(model, Motion(solref=(0.7, 1.0)))


def test_a_slow_motion_has_faster_neighbours():
    """Slower ones would take seven times as long; the limit lies on the other side of the base."""
    slow = Motion(speed=0.004)
    motions = slower_and_finer(slow)
    assert {"half", "quarter"}.isdisjoint(motions)
    assert motions["double"].speed == 2 * slow.speed
    assert motions["fine"].speed == motions["fourfold"].speed == 4 * slow.speed
    assert motions["undamped"].speed == slow.speed


def test_the_contacts_are_the_same_in_all_of_them():
    motions = slower_and_finer(plain := Motion(speed=0.08))
    assert {m.stiffness for m in motions.values()} == {plain.stiffness}
    assert motions["fine"].timestep == plain.timestep / 2
    assert motions["quarter"].speed == plain.speed / 4
    stock = slower_and_finer(Motion(speed=0.08, solref=(0.7, 1.0)))
    assert {m.solref for name, m in stock.items() if name != "ours"} == {(0.7, 1.0)}
    assert stock["ours"].solref is None
    assert stock["ours"].speed == stock["quarter"].speed
