"""Three bodies from files, each passed on ten oblique ways, against the closed form."""

import pytest

from analytic.space import solve_space
from analytic.space.solver import hop as landings
from mujoco_models import simulate_space
from mujoco_models.space import walk as walks
from tests.fuzz.space import events, trial
from tests.mujoco_models.space.files import oblique


@pytest.mark.slow
def test_over_an_edge_next_to_a_corner_nothing_beyond_the_corner_holds(tmp_path):
    # 7e-4 L beside the corner; the face beyond has a stable state 0.02 L away, the other way.
    case = trial(82001, tmp_path, stations=8)
    slips = [events(sweep(case), "slip-off") for sweep in (solve_space, simulate_space)]
    assert slips[1] == pytest.approx(slips[0], abs=5e-4)  # of 40 links; found on 1.5e-4 L
    assert len(slips[0]) == 1


@pytest.mark.slow
def test_a_fall_that_begins_slowly_is_followed_to_where_it_lands(tmp_path):
    # At 1.1007 L a side loses its hold and creeps for the first 0.01 L of its 0.04 L.
    case = oblique("ball.stl", 0, tmp_path, stations=8)
    ends = [events(sweep(case), "release") for sweep in (solve_space, simulate_space)]
    assert ends[1] == pytest.approx(ends[0], abs=5e-4)  # of 40 links; found on 1e-6 L
    assert len(ends[0]) == 1


@pytest.mark.slow
@pytest.mark.parametrize("limit", [0.06, 0.18])
@pytest.mark.parametrize(
    ("sweep", "owner", "name"),
    [(solve_space, landings, "_FARTHEST"), (simulate_space, walks, "_LANDING")],
)
def test_each_side_has_its_own_limit_of_a_hop(sweep, owner, name, limit, tmp_path, monkeypatch):
    """On a ball whose facets are 0.15 L wide half of that ends the contact 1 L before it ends."""
    monkeypatch.setattr(owner, name, limit)
    case = oblique("ball.stl", 0, tmp_path, stations=8)
    ends = [events(one(case), "slip-off", "release")[-1] for one in (solve_space, simulate_space)]
    changed = ends[sweep is simulate_space]
    assert (changed < 1.1) == (limit < 0.12)
    assert ends[sweep is solve_space] > 1.9
