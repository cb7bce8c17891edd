"""Sweeps in motion past an object that rubs, against the closed form with friction."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, InputError, Sweep, named_case, solve_sweep
from mujoco_models import Motion, Settings, simulate_motion

CASE = replace(named_case("catenary"), friction=0.2, sweep=Sweep(60))
SLOW = Motion(
    speed=0.025,
    timestep=0.002,
    contact_stiffness=1e3,
    damping_ratio=0.2,
    cone="elliptic",
    average=0.2,
)


def rms(exact, moved):
    """Of each reading over its largest magnitude, chattering stations and all."""
    a, b = exact.table, moved.table
    ends = [s.provenance["events"]["snap_off"] for s in (exact, moved)]
    keep = a["foot_x"] > max(ends) + 0.02 * np.ptp(a["foot_x"])
    assert keep.sum() > 50
    return [
        float(np.sqrt(((b[name] - a[name])[keep] ** 2).mean()) / a[name][keep].abs().max())
        for name in CLAMP_READINGS
    ]


@pytest.mark.slow
def test_a_slow_sweep_agrees_with_the_closed_form():
    exact = solve_sweep(CASE)
    moved = simulate_motion(CASE, SLOW, Settings(segments=40, obstacle="primitive"))
    assert (moved.table["status"] == "ok").mean() > 0.9
    assert max(rms(exact, moved)) < 5e-3
    # It is friction that is seen: without, force_x is another by three quarters.
    frictionless = solve_sweep(replace(CASE, friction=0.0))
    assert rms(frictionless, moved)[0] > 0.5
    # It lets go later than without friction, as the closed form does: 0.056 L.
    assert exact.snap_off - moved.snap_off < 0.02
    assert frictionless.snap_off - moved.snap_off > 0.04


def test_the_motions_own_friction_is_taken_before_the_cases():
    """A case that rubs, simulated without friction; few steps, since none is needed."""
    short = replace(CASE, sweep=Sweep(8, start=2.41, stop=2.3))
    settings = Settings(segments=6, obstacle="primitive")
    quick = replace(SLOW, speed=0.1)
    with_it = simulate_motion(short, quick, settings)
    without = simulate_motion(short, replace(quick, friction=0.0), settings)
    plain = simulate_motion(replace(short, friction=0.0), quick, settings)
    assert with_it.provenance["motion"]["friction"] == 0.2
    assert without.table["force_x"].equals(plain.table["force_x"])
    assert not with_it.table["force_x"].equals(plain.table["force_x"])


def test_a_step_in_which_friction_overshoots_is_refused():
    with pytest.raises(InputError, match=r"^motion\.timestep = 0\.02: must be at most .*friction"):
        simulate_motion(CASE, Motion(cone="elliptic"), Settings(segments=6, obstacle="primitive"))
    with pytest.raises(InputError, match=r"^motion\.timestep"):
        simulate_motion(CASE, Motion(solref=(0.01, 1.0)), Settings(segments=6))
