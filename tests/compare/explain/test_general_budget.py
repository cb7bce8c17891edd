"""Budgets of vibrissae that are curved at rest or on a clamp that turns."""

from dataclasses import replace

import pytest

from analytic import named_case
from compare.explain.budget import UNRESOLVED
from compare.simulate.controlled import measure_budget
from mujoco_models import Settings


@pytest.mark.slow
@pytest.mark.parametrize(
    ("natural_curvature", "clamp_stiffness"), [(-0.5, float("inf")), (0.0, 8.0)]
)
def test_it_closes(natural_curvature, clamp_stiffness):
    case = named_case("catenary")
    beam = replace(case.beam, natural_curvature=natural_curvature)
    case = replace(case, beam=beam, clamp_stiffness=clamp_stiffness)
    found, _ = measure_budget(case, Settings())
    assert found.closes
    assert found.stations > 180  # of 200, seven of them free
    assert found.blame == "discretisation"
    assert found.order > 1.8
    # Observed at most 4.2e-5.
    assert max(part.rms for part in found.parts["unexplained"].values()) < UNRESOLVED
