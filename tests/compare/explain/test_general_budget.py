"""Budgets of vibrissae that taper, are curved at rest, or stand on a clamp that turns."""

from dataclasses import replace

import pytest

from analytic import CASE_NAMES, named_case
from compare.explain.budget import SMALL
from compare.simulate.budgets import measure_budget
from mujoco_models import Settings

pytestmark = pytest.mark.usefixtures("in_turn")

VIBRISSAE = {
    "cone": {"tip_radius": 0.4 * 0.005},
    "curved away": {"natural_curvature": -0.5},
    "curved towards": {"natural_curvature": 0.5},
    "on a spring": {},
}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "vibrissa"),
    [
        ("catenary", "cone"),  # observed 1.8e-5; a tip 0.2 % thicker leaves 3.4e-4
        ("catenary", "curved away"),  # 3.0e-5
        ("parabola", "curved towards"),  # 4e-6
        ("catenary", "on a spring"),  # 1.2e-5
    ],
)
def test_it_closes(name, vibrissa):
    # A cone past a polygon is solved corner by corner: of 100, in a quarter of the time of 400.
    if vibrissa == "cone":
        assert_closed(name, vibrissa, segments=40, stations=40, least=30, points=100)
    else:
        assert_closed(name, vibrissa, segments=40, stations=60, least=45, points=400)


@pytest.mark.trial
@pytest.mark.parametrize("segments", [40, 80])
@pytest.mark.parametrize("vibrissa", VIBRISSAE)
@pytest.mark.parametrize("name", CASE_NAMES)
def test_all_close(name, vibrissa, segments):
    """Observed at most 4.1e-5 and 1.5e-5, the order 1.81 to 2."""
    # A flat object is touched twice on most of its way by one that is curved towards it.
    twice = vibrissa == "curved towards" and name.endswith("catenary")
    assert_closed(name, vibrissa, segments, stations=60, least=10 if twice else 45)


def assert_closed(name, vibrissa, segments, stations, least, points=1600):
    case = named_case(name)
    beam = replace(case.beam, **VIBRISSAE[vibrissa])
    stiffness = 8.0 if vibrissa == "on a spring" else float("inf")
    sweep = replace(case.sweep, stations=stations)
    case = replace(case, beam=beam, clamp_stiffness=stiffness, sweep=sweep)
    # The closed form past as many corners, a check, takes long where the vibrissa varies.
    found, _ = measure_budget(case, Settings(contour_points=points, segments=segments))
    assert found.closes
    assert found.stations >= least  # some are free, or within the window before the snap-off
    assert found.blame in ("discretisation", "facets")
    assert found.order > 1.8
    for part in found.parts["unexplained"].values():
        assert part.rms < SMALL
