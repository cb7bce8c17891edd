"""A sweep in motion that turns round: the way back, and what friction makes of it."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Case, Sweep, circle, named_case, solve_sweep, turn_back
from mujoco_models import Motion, Settings, simulate_there_and_back

CATENARY = replace(named_case("catenary"), sweep=Sweep(30, stop=0.4))
SETTINGS = Settings(segments=20, contour_points=800)
RUBBING = Motion(speed=0.1, timestep=0.002, contact_stiffness=1e3, cone="elliptic", impratio=100.0)


def rms(found, exact):
    return float(np.sqrt(np.mean((found - exact) ** 2)) / np.abs(exact).max())


def apart(speed):
    """How far the way back is from the way on."""
    on, back = simulate_there_and_back(CATENARY, Motion(speed=speed), SETTINGS)
    assert back.values("foot_x")[::-1] == pytest.approx(on.values("foot_x"), abs=0)
    assert back.provenance["events"]["turn"] < on.values("foot_x").min()
    assert back.values("time")[0] > on.values("time")[-1]
    return rms(back.values("force_x")[::-1], on.values("force_x"))


@pytest.mark.slow
def test_without_friction_the_way_back_is_the_way_on_as_the_speed_goes_to_zero():
    """Observed 7.1e-3 and 3.4e-3: of first order in the speed, as damping is."""
    fast, slow = apart(0.1), apart(0.05)
    assert slow < 5e-3
    assert 1.7 < fast / slow < 2.3


@pytest.mark.slow
def test_with_friction_it_sticks_and_slides_back_as_in_closed_form():
    """Of the largest force on the way back, a fifth of that on the way on, 5.2e-3 are observed.

    3.8e-3 of it are the last station: there the contact ends, and bounces.
    """
    case = replace(CATENARY, friction=0.2)
    on, back = simulate_there_and_back(case, RUBBING, SETTINGS)
    exact = turn_back(case, back.provenance["events"]["turn"], 2000)
    there, touch = back.values("foot_x"), on.provenance["events"]["first_contact"]
    expected = np.interp(there, exact["foot_x"], exact["force_x"])
    assert rms(on.values("force_x"), solve_sweep(case).values("force_x")) < 3e-3
    assert rms(back.values("force_x"), expected) < 8e-3
    assert rms(on.values("force_x")[::-1], expected) > 0.3
    assert back.provenance["events"]["release"] == pytest.approx(touch, abs=5e-3)


@pytest.mark.slow
def test_past_a_symmetric_object_it_comes_back_as_its_own_mirror_image():
    """It has let go, comes to the other side, and lets go there."""
    case = Case(profile=circle(0.2, (0, 0.5)), sweep=Sweep(40, 1.4, -1.4))
    on, back = simulate_there_and_back(case, Motion(speed=0.05), SETTINGS)
    assert on.snap_off == pytest.approx(solve_sweep(case).snap_off, abs=0.03)  # late, in motion
    assert back.snap_off == pytest.approx(-on.snap_off, abs=2e-3)
    assert back.provenance["events"]["release"] is None
    held = np.abs(on.values("foot_x") - on.snap_off) > 0.1  # beside it the tip bounces
    assert rms(-back.values("force_x")[held], on.values("force_x")[held]) < 5e-3
