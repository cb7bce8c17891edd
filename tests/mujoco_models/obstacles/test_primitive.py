"""The smooth primitive: no facets, so that nothing hides the beam's order of convergence."""

from functools import cache

import numpy as np
import pytest

from analytic import (
    CLAMP_READINGS,
    Case,
    InputError,
    Profile,
    Sweep,
    circle,
    ellipse,
    named_case,
    polygon,
    solve_sweep,
)
from compare import compare
from mujoco_models import Settings, available_beams, simulate_sweep

CASES = {
    "circle": Case(profile=circle(1.0, lowest=(0.0, 0.4)), sweep=Sweep(stations=30)),
    "ellipse": Case(profile=ellipse((1.0, 0.5), lowest=(0.0, 0.4)), sweep=Sweep(stations=30)),
    "two-circles": Case(profile=named_case("two-circles").profile, sweep=Sweep(stations=30)),
}
FLOOR = 5e-5  # rms, relative: what the contacts' softness and the beads' spacing leave


@cache
def errors(name, beam, segments):
    simulated = simulate_sweep(
        CASES[name], Settings(beam=beam, segments=segments, obstacle="primitive")
    )
    assert (simulated.table["status"] == "ok").all()
    found = compare(solve_sweep(CASES[name]), simulated)
    return np.array([found.disagreement[reading].rms for reading in CLAMP_READINGS])


@pytest.mark.parametrize("name", CASES)
def test_agrees_with_the_closed_form(name):
    # Observed at most 5.4e-4, in force_y; the mesh has 1e-3.
    assert (errors(name, "chain", 40) < 8e-4).all()


@pytest.mark.slow
@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("beam", available_beams())
def test_second_order_until_the_floor(beam, name):
    """Single doublings scatter about 2: the beads' spacing is bounded by more than N."""
    segments = np.array([10, 20, 40, 80, 160] if beam == "chain" else [10, 20, 40, 80])
    found = np.array([errors(name, beam, int(n)) for n in segments])
    slopes = -np.polyfit(np.log(segments), np.log(found), 1)[0]
    assert (slopes > 1.8).all(), (found, slopes)
    assert (slopes < 2.4).all(), (found, slopes)
    if beam == "chain":
        assert (found[-1] < FLOOR).all(), found[-1]


@pytest.mark.parametrize("name", CASES)
def test_contacts_lie_on_the_contour(name):
    """As deep in it as the load presses them, and with its normal there."""
    case = CASES[name]
    table = simulate_sweep(case, Settings(obstacle="primitive")).table
    table = table[table["phase"] == "tip"]  # one bead, so that nothing is averaged
    at = case.profile.at(table["contact_angle"].to_numpy())
    across = np.hypot(table["contact_x"] - at.xi, table["contact_y"] - at.eta)
    depth = np.hypot(table["force_x"], table["force_y"]) / Settings().contact_stiffness
    # MuJoCo puts a contact half its depth inside; the circles are 5e-5 rad apart.
    assert (np.abs(across - depth / 2) < 1e-8).all()


@pytest.mark.parametrize(
    "profile",
    [
        polygon([(-1.0, 0.8), (-0.5, 0.5), (0.3, 0.4), (1.0, 0.9)]),
        Profile(np.sin, lambda alpha: 1.4 - np.cos(alpha), (-0.3, 1.0)),  # ends within reach
    ],
)
def test_corners_have_no_circle(profile):
    with pytest.raises(InputError, match="'mesh', or a contour without corners"):
        simulate_sweep(Case(profile=profile), Settings(obstacle="primitive"))
