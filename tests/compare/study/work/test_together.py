"""Runs in closed form that are done at once have the rows of runs done one by one."""

import pytest

from compare.study.work.perform import perform, perform_all
from tests.compare.study.studies import planned

EVENTS = """
study = { case = "catenary", beams = [] }
axes.sweep.direction = ["left", "right"]
axes.beam.natural_curvature = [0.0, -0.3]
axes.profile.c = [-0.9, -0.8, 0.4]
"""
SWEEPS = """
study = { case = "parabola", beams = [], record = ["events", "reconstruction"] }
axes.profile.c = [0.3, 0.5, 1.5]
axes.contact.friction = [0.0, 0.2]
sweep.stations = 30
noise.relative = 0.01
"""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "outcomes"),
    [
        (EVENTS, {"done", "bad-input"}),  # one that is none leaves all to themselves
        (EVENTS.replace(", 0.4]", "]"), {"done"}),
        (SWEEPS, {"done", "bad-input"}),
    ],
)
def test_rows_are_those_of_runs_one_by_one(tmp_path, text, outcomes):
    plan = planned(tmp_path, text)
    recipe, runs = plan.study.recipe, list(plan)
    together = [result.row for result in perform_all(recipe, runs)]
    alone = [perform(recipe, run).row for run in runs]
    assert {row["outcome"] for row in alone} == outcomes
    for one, other in zip(together, alone, strict=True):
        assert one.keys() == other.keys()
        assert one.pop("seconds") > 0
        other.pop("seconds")
        for name, value in other.items():
            exact = not isinstance(value, float)
            assert one[name] == (value if exact else pytest.approx(value, rel=1e-9, nan_ok=True))
