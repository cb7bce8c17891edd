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


def rms_by_speed(motion: Motion, settings: Settings, *speeds: float):
    """The worst reading's rms to the sweep at rest, whose contacts are as stiff."""
    x = CASE.foot_x
    many = Sweep(59 * FINE + 1, float(x[0]), float(x[-1]))
    rest = simulate_sweep(
        replace(CASE, sweep=many), replace(settings, contact_stiffness=motion.stiffness)
    )
    return [rms_to(rest, simulate_motion(CASE, replace(motion, speed=v), settings)) for v in speeds]


@pytest.mark.slow
@pytest.mark.parametrize("obstacle", ["primitive", "mesh"])
def test_forty_segments_tend_to_rest_to_within_1e_4(obstacle):
    """Observed 2.9e-4, 1.5e-4, 7.9e-5 on the primitive: order 0.95, 0.9. No station chatters."""
    settings = Settings(segments=40, obstacle=obstacle, contour_points=800)
    motion = Motion(timestep=0.01, contact_stiffness=1e4, damping_ratio=0.05)
    speeds = (0.02, 0.01, 0.005) if obstacle == "primitive" else (0.02, 0.005)
    errors = rms_by_speed(motion, settings, *speeds)
    order = np.log(errors[0] / errors[-1]) / np.log(speeds[0] / speeds[-1])
    print(f"{obstacle}: rms {errors}, order in the speed {order:.2f}")
    assert errors[-1] < 1e-4
    assert order == pytest.approx(1.0, abs=0.2)


@pytest.mark.slow
@pytest.mark.parametrize("stiffness", [1e4, 1e5, 1e6])
def test_discrete_makes_contacts_as_stiff_as_stated(stiffness):
    """The same model at rest has the same readings, whatever the stiffness: 2e-4 at 0.01 L/T1."""
    motion = Motion(timestep=0.01, contact_stiffness=stiffness, damping_ratio=0.05)
    assert rms_by_speed(motion, SMOOTH, 0.01)[0] < 3e-4


EXPLICIT = Motion(timestep=1e-3, contact_stiffness=1e3, damping_ratio=0.05)


@pytest.mark.slow
@pytest.mark.parametrize("integrator", ["implicitfast", "implicit", "euler"])
def test_explicit_integrators_tend_to_rest_in_proportion_to_their_speed(integrator):
    """Observed 5.3e-4, 2.9e-4, 1.4e-4 at 0.04, 0.02, 0.01 L/T1, with no station that chatters.

    With MuJoCo's solver at a tolerance of 1e-10 the last would be 3.8e-4, and stay there.
    """
    slow = replace(EXPLICIT, integrator=integrator)
    fast, half = rms_by_speed(slow, SMOOTH, 0.04, 0.01)
    assert np.log2(fast / half) / 2 == pytest.approx(1.0, abs=0.15)
    assert half < 1.7e-4


@pytest.mark.slow
def test_runge_and_kuttas_tends_to_rest_too():
    """Explicit in the dampers, which have to be a tenth as strong. Observed 6.3e-4, 3.2e-4."""
    slow = replace(EXPLICIT, integrator="rk4", timestep=5e-4, damping_ratio=0.005)
    fast, half = rms_by_speed(slow, SMOOTH, 0.08, 0.04)
    assert np.log2(fast / half) == pytest.approx(1.0, abs=0.1)
    assert half < 4e-4
