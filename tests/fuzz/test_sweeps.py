"""A short run of the random sweeps."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Sweep
from mujoco_models import simulate_sweep
from tests.fuzz.sweeps import KINDS, Outcome, main, trial


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_random_sweeps_have_no_silent_error(kind):
    for made, outcome in main(2, 7_000, kind):
        assert isinstance(outcome, Outcome), (made.label, outcome)
        assert not {"silent", "lost"} & set(outcome.flags), (made.label, outcome)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [pytest.param(1060030, marks=pytest.mark.slow), 1250061])
def test_few_stations_rest_where_many_do(seed, tmp_path):
    """A tip that a long step of the foot would carry off its facet is still on it, if it can be."""
    found = trial(seed, tmp_path)
    stations, between = found.case.sweep.stations, 6
    first, last = (float(x) for x in found.case.foot_x[[0, -1]])
    many = Sweep((stations - 1) * between + 1, first, last)
    few = simulate_sweep(found.case, found.settings)
    reference = simulate_sweep(replace(found.case, sweep=many), found.settings)
    assert few.trusted.all()
    for name in CLAMP_READINGS:
        there = reference.values(name)[::between]
        # The window of vertices that is faced moves a reading by 1e-6; another facet by 0.1.
        assert few.values(name) == pytest.approx(there, abs=1e-5 * np.abs(there).max())


def test_a_corner_hidden_beside_another_is_not_taken_for_passed(tmp_path):
    """It is 5e-6 L behind the one that is touched, and faces away from the link."""
    found = trial(900351, tmp_path, wide=True)
    assert simulate_sweep(found.case, found.settings).trusted.all()
