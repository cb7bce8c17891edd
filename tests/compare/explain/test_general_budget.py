"""Budgets of vibrissae that taper, are curved at rest, or stand on a clamp that turns."""

from dataclasses import replace

import pytest

from analytic import named_case
from compare.explain.budget import UNRESOLVED
from compare.simulate.controlled import measure_budget
from mujoco_models import Settings

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
        ("catenary", "cone"),  # observed 7e-6; 7.4e-5 as long as its swing was left in the limit
        ("two-circles", "cone"),  # 4.1e-5; 7.8e-5 with beads no closer than L/4000
        ("catenary", "curved away"),  # 3.0e-5
        ("parabola", "curved towards"),  # 4e-6
        ("catenary", "on a spring"),  # 1.2e-5
    ],
)
def test_it_closes(name, vibrissa):
    case = named_case(name)
    beam = replace(case.beam, **VIBRISSAE[vibrissa])
    stiffness = 8.0 if vibrissa == "on a spring" else float("inf")
    sweep = replace(case.sweep, stations=120)
    case = replace(case, beam=beam, clamp_stiffness=stiffness, sweep=sweep)
    # The closed form past as many corners, a check, takes long where the vibrissa varies.
    found, _ = measure_budget(case, Settings(contour_points=1600))
    assert found.closes
    assert found.stations > 95  # of 120, some of them free
    assert found.blame in ("discretisation", "facets")
    assert found.order > 1.8
    for part in found.parts["unexplained"].values():
        assert part.rms < UNRESOLVED
