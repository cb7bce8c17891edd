"""The budget of a sweep in motion: planted parts are found, and what is none of them is left.

That of a real sweep closes on the page `mujoco_models/README.md`, whose commands are run.
"""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Readings, Sweep, named_case, solve_sweep
from compare.explain.motion import motion_budget, slower_and_finer, slower_and_finer_of_model
from mujoco_models import Motion, OwnModel

CASE = replace(named_case("catenary"), sweep=Sweep(80))
EXACT = solve_sweep(CASE)
MOTION = Motion(speed=0.08, timestep=0.02)
SLOW = Motion(speed=0.004)


def added(share):
    """The exact sweep with a share of each reading's largest magnitude on top, by a wave."""
    table = EXACT.table.copy()
    wave = np.cos(3 * table["foot_x"].to_numpy())
    for name in CLAMP_READINGS:
        table[name] += share * wave * np.nanmax(np.abs(table[name]))
    return Readings(table, EXACT.beam, "planted", EXACT.provenance)


def runs(
    rate=0.0, order=1.0, step=0.0, rest=0.0, motionless=0.0, damping=0.0, contact=0.0, solver=0.0,
    of=MOTION,
):  # fmt: skip
    """Errors in proportion to speed^order and step, those at rest, and one of all motions alike."""
    found = {
        name: added(
            rest
            + motionless
            + rate * (m.speed / of.speed) ** order
            + step * m.timestep / of.timestep
            + damping * m.damping_ratio / of.damping_ratio * m.speed / of.speed
            + contact * (m.solref is not None)
            + solver * (m.solver != "newton")
        )
        for name, m in slower_and_finer(of).items()
    }
    return {**found, "rest": added(rest)}


@pytest.mark.parametrize("motion", [MOTION, SLOW])
@pytest.mark.parametrize("order", [1.0, 2.0])
def test_planted_parts_are_found(order, motion):
    planted = runs(rate=0.02, order=order, step=1e-3, rest=3e-3, of=motion)
    found = motion_budget(EXACT, planted)
    assert found.order == pytest.approx(order, abs=1e-6)
    assert found.closes
    # Extrapolated from faster sweeps, the rate is as uncertain as it is large.
    assert found.blame == ("rate" if motion is MOTION else "at rest")
    wave = np.sqrt(0.5)
    for name, size in (("rate", 0.02), ("time step", 1e-3), ("at rest", 3e-3)):
        for part in found.parts[name].values():
            assert part.rms == pytest.approx(size * wave, rel=0.15)  # of a wave that is cut
    assert all(part.rms < 1e-12 for part in found.parts["unexplained"].values())


def test_damping_contact_model_solver_and_beam_are_parts_of_their_own():
    stock = replace(MOTION, solref=(0.7, 1.0), solver="cg")
    planted = {"damping": 0.01, "contact": 0.03, "solver": 5e-3}
    found = motion_budget(EXACT, {**runs(**planted, rest=2e-3, of=stock), "beam": added(4e-3)})
    wave = np.sqrt(0.5)
    for name, size in (
        ("damping", 0.01), ("contact model", 0.03), ("solver", 5e-3), ("beam", 4e-3), ("rate", 0.0)
    ):  # fmt: skip
        for part in found.parts[name].values():
            assert part.rms == pytest.approx(size * wave, rel=0.15, abs=1e-9)
    assert found.blame == "contact model"
    # The beam was planted in its part only, and so is missing in what is left.
    for part in found.parts["unexplained"].values():
        assert part.rms == pytest.approx(4e-3 * wave, rel=0.15)


def test_softness_of_a_model_is_a_part_of_its_own():
    """In proportion to 1/stiffness, and a time step whose part it is not."""
    found = runs(rate=1e-3, step=1e-3, rest=2e-3)
    soft, step = 8e-3, 1e-3
    planted = {
        name: added(2e-3 + 1e-3 * share + step * of_step + soft)
        for name, share, of_step in (
            ("base", 1, 1), ("half", 0.5, 1), ("quarter", 0.25, 1), ("fine", 0.25, 0.5),
            ("undamped", 1, 1),
        )
    }  # fmt: skip
    planted["stiff"] = added(2e-3 + 1e-3 * 0.25 + step * 0.5 + soft / 4)
    budget = motion_budget(EXACT, {**planted, "rest": found["rest"]}, of_our_chain=True)
    for part in budget.parts["softness"].values():
        assert part.rms == pytest.approx(soft * np.sqrt(0.5), rel=0.15)
    assert all(part.rms < 1e-12 for part in budget.parts["unexplained"].values())


def test_a_models_stiffer_contacts_are_ours():
    model = OwnModel(Path("my.xml"))
    found = slower_and_finer_of_model(model, MOTION)
    stiff, motion = found["stiff"]
    assert (stiff.contact, stiff.stiffness, stiff.timestep) == ("ours", 4, 0.5)
    assert motion.speed == MOTION.speed / 4
    assert "stiff" not in slower_and_finer_of_model(model, Motion(solref=(0.7, 1.0)))


def test_what_a_motion_has_not_is_no_part():
    found = motion_budget(EXACT, runs(rate=1e-3))
    assert set(found.parts) == {"rate", "damping", "time step", "at rest", "unexplained"}


def test_what_all_motions_share_stays_unexplained():
    found = motion_budget(EXACT, runs(rate=1e-3, rest=1e-3, motionless=0.02))
    assert not found.closes
    assert found.blame == "unexplained"


def test_a_slow_motion_has_faster_neighbours():
    """Slower ones would take seven times as long; the limit lies on the other side of the base."""
    motions = slower_and_finer(SLOW)
    assert {"half", "quarter"}.isdisjoint(motions)
    assert motions["double"].speed == 2 * SLOW.speed
    assert motions["fine"].speed == motions["fourfold"].speed == 4 * SLOW.speed
    assert motions["undamped"].speed == SLOW.speed
    faster = motion_budget(EXACT, runs(rate=0.02, of=SLOW))
    slower = motion_budget(EXACT, runs(rate=0.02))
    for name, part in faster.parts["rate"].items():
        # Extrapolated over as much as it is itself, and not over a quarter of it.
        assert part.uncertainty == pytest.approx(4 * slower.parts["rate"][name].uncertainty)


def test_the_contacts_are_the_same_in_all_of_them():
    motions = slower_and_finer(MOTION)
    assert {m.stiffness for m in motions.values()} == {MOTION.stiffness}
    assert motions["fine"].timestep == MOTION.timestep / 2
    assert motions["quarter"].speed == MOTION.speed / 4
    stock = slower_and_finer(Motion(speed=0.08, solref=(0.7, 1.0)))
    assert {m.solref for name, m in stock.items() if name != "ours"} == {(0.7, 1.0)}
    assert stock["ours"].solref is None
    assert stock["ours"].speed == stock["quarter"].speed
