"""The limit of no speed: a sweep in motion tends to the sweep at rest, station by station."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Case, Readings, Sweep, named_case
from mujoco_models import Motion, Settings, simulate_motion, simulate_sweep

CASE = replace(named_case("catenary"), sweep=Sweep(60))
SMOOTH = Settings(segments=10, contact_stiffness=1e3, obstacle="primitive")
FINE = 20  # states at rest for the mean over one station's way
BETWEEN = slice(1, 56)  # but for the first contact and the release


def at_rest_as_means(name: str, rest: Readings, case=CASE):
    """Means of the sweep at rest over the ways that the stations of a moving one are means of."""
    x, way, values = case.foot_x, -rest.values("foot_x"), rest.values(name)
    integral = np.concatenate([[0], np.cumsum((values[1:] + values[:-1]) / 2 * np.diff(way))])
    half = (x[0] - x[1]) / 2
    ends = np.interp(-x + half, way, integral) - np.interp(-x - half, way, integral)
    return ends / (2 * half)


def rms_to(rest, moved, case=CASE):
    """Worst reading's rms over the stations in contact, none of which chatters."""
    between = BETWEEN if case is CASE else slice(1, -1)
    assert moved.trusted[between].all()
    return max(
        np.sqrt(np.mean((moved.values(n) - at_rest_as_means(n, rest, case))[between] ** 2))
        / np.abs(rest.values(n)).max()
        for n in CLAMP_READINGS
    )


def rms_by_speed(motion: Motion, settings: Settings, *speeds: float, case=CASE):
    """The worst reading's rms to the sweep at rest, whose contacts are as stiff."""
    x = case.foot_x
    many = Sweep((len(x) - 1) * FINE + 1, float(x[0]), float(x[-1]))
    rest = simulate_sweep(
        replace(case, sweep=many), replace(settings, contact_stiffness=motion.stiffness)
    )
    return [
        rms_to(rest, simulate_motion(case, replace(motion, speed=v), settings), case)
        for v in speeds
    ]


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


def first_third() -> Case:
    """Tip and tangential contact, where a step takes so long that all of the sweep is too much."""
    x = CASE.foot_x
    return replace(CASE, sweep=Sweep(20, float(x[0]), float(x[19])))


@pytest.mark.slow
def test_forty_segments_tend_to_rest_with_runge_and_kutta():
    """An armature holds their dampers' rates down. Observed 3.3e-3, 1.7e-3, 8.6e-4 at 0.04 L/T1."""
    motion = replace(EXPLICIT, integrator="rk4", timestep=4e-4, armature=20.0)
    settings = Settings(segments=40, obstacle="primitive")
    fast, half = rms_by_speed(motion, settings, 0.16, 0.08, case=first_third())
    assert np.log2(fast / half) == pytest.approx(1.0, abs=0.1)
    assert half < 2e-3


@pytest.mark.trial
@pytest.mark.parametrize("integrator", ["implicitfast", "implicit", "euler"])
def test_forty_segments_on_a_mesh_tend_to_rest_explicitly(integrator):
    """Observed 1.46e-3 with each of them, and 7.2e-4 at half the speed; no station chatters.

    A step is T1/5000, and a millisecond of CPU time.
    """
    settings = Settings(segments=40, obstacle="mesh", contour_points=800)
    motion = replace(EXPLICIT, integrator=integrator, timestep=2e-4)
    fast, half = rms_by_speed(motion, settings, 0.08, 0.04, case=first_third())
    assert np.log2(fast / half) == pytest.approx(1.0, abs=0.1)
    assert half < 8e-4
