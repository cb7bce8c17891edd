"""The limit of no speed: a sweep in motion tends to the sweep at rest, station by station."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Readings, Sweep, named_case
from mujoco_models import Motion, Settings, simulate_motion, simulate_sweep

CASE = replace(named_case("catenary"), sweep=Sweep(60))
SMOOTH = Settings(segments=10, contact_stiffness=1e3, obstacle="primitive")
FINE = 20  # states at rest for the mean over one station's way
BETWEEN = slice(1, 56)  # but for the first contact and the release


def at_rest_as_means(name: str, rest: Readings):
    """Means of the sweep at rest over the ways that the stations of a moving one are means of."""
    x, way, values = CASE.foot_x, -rest.values("foot_x"), rest.values(name)
    integral = np.concatenate([[0], np.cumsum((values[1:] + values[:-1]) / 2 * np.diff(way))])
    half = (x[0] - x[1]) / 2
    ends = np.interp(-x + half, way, integral) - np.interp(-x - half, way, integral)
    return ends / (2 * half)


def rms_to(rest, moved):
    """Worst reading's rms over the stations in contact, none of which chatters."""
    assert moved.trusted[BETWEEN].all()
    return max(
        np.sqrt(np.mean((moved.values(n) - at_rest_as_means(n, rest))[BETWEEN] ** 2))
        / np.abs(rest.values(n)).max()
        for n in CLAMP_READINGS
    )


@pytest.mark.slow
def test_a_sweep_in_motion_tends_to_rest_in_proportion_to_its_speed():
    """Contacts of 1e3 EI/L^3 in both. Observed 3.8e-3, 1.9e-3: order 1.0, of the dampers' lag."""
    x = CASE.foot_x
    many = Sweep(59 * FINE + 1, float(x[0]), float(x[-1]))
    rest = simulate_sweep(replace(CASE, sweep=many), SMOOTH)
    slow = Motion(
        timestep=0.002, integrator="implicitfast", contact_stiffness=1e3, damping_ratio=0.3
    )
    fast, half = (
        rms_to(rest, simulate_motion(CASE, replace(slow, speed=v), SMOOTH)) for v in (0.08, 0.04)
    )
    assert np.log2(fast / half) == pytest.approx(1.0, abs=0.1)
    assert half < 2.5e-3
