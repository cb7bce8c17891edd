"""Where the branch of equilibria ends is closed in on without stepping over the edge each time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mujoco_models.model.stance import Stance
from mujoco_models.sweep.state import State
from mujoco_models.sweep.walls import Walls, fold


def at(tip_angle, stance=Stance.NEAR):
    """A state at rest with one joint, so that its turn is the tip's."""
    return State(np.array([tip_angle]), {0: 1.0}, settled=True, stance=stance)


GONE = State(np.array([3.0]), {}, settled=True, stance=Stance.PASSED)


@given(st.floats(-2, 2), st.floats(0.1, 10), st.lists(st.floats(0.01, 1), min_size=3, max_size=3))
def test_the_fold_of_a_parabola(end, bend, steps):
    turns = np.cumsum(steps[::-1]) - sum(steps)  # up to the fold, where the turn is zero
    turns = turns[turns < 0].tolist()
    trail = [(end + bend * s**2, at(s)) for s in [-sum(steps) - 0.1, *turns][:3]]
    assert fold(trail) == pytest.approx(end, abs=1e-9)


@pytest.mark.parametrize(
    "trail",
    [
        [(3.0, at(0.0)), (2.0, at(1.0))],  # too short
        [(3.0, at(0.0)), (2.0, at(1.0)), (1.0, at(2.0))],  # straight
        [(3.0, at(0.0)), (2.0, at(1.0)), (1.5, at(0.5))],  # to and fro
        [(3.0, at(0.0)), (2.9, at(1.0)), (2.0, at(2.0))],  # its fold is behind
        [(3.0, at(0.0, Stance.FAR)), (2.0, at(1.0)), (1.8, at(2.0))],  # not of one kind
    ],
)
def test_no_fold_is_foreseen(trail):
    assert fold(trail) is None


def closes_in(end, wall, start=(-1.2, -1.1, -1.0)):
    """Trials on the branch x = end + s^2, up to where fold and wall are within 1e-5."""
    walls, trail = Walls(1e-5), [(end + s**2, at(s)) for s in start]
    walls.add(wall, GONE, trail[-1][0])
    trials = []
    while abs(walls.nearest - trail[-1][0]) > 1e-5:
        trial = walls.aim(trail, lambda state: state.stance is Stance.NEAR)
        trials.append(trial)
        if trial >= end:
            trail.append((trial, at(-np.sqrt(trial - end))))
            walls.leave_behind(trial, -1e3)
        else:
            walls.add(trial, GONE, trail[-1][0])
    return np.array(trials)


@given(st.floats(-0.5, 0.5))
def test_a_fold_is_found_with_few_failures(end):
    trials = closes_in(end, wall=end - 1)
    # Halving from 2 to 1e-5 takes eighteen, of which nine fail.
    assert (trials < end).sum() <= 2
    assert len(trials) <= 12


@given(st.floats(1e-4, 0.3))
def test_where_the_branch_ends_before_its_fold_halving_finds_it(cut):
    """As where a facet lets the tip go: what is foreseen is beyond the end."""
    walls, trail = Walls(1e-5), [(s**2, at(s)) for s in (-1.2, -1.1, -1.0)]
    walls.add(-1.0, GONE, 1.0)
    count = 0
    while abs(walls.nearest - trail[-1][0]) > 1e-5:
        trial = walls.aim(trail, lambda state: state.stance is Stance.NEAR)
        count += 1
        if trial >= cut:
            trail.append((trial, at(-np.sqrt(trial))))
            walls.leave_behind(trial, -1e3)
        else:
            walls.add(trial, GONE, trail[-1][0])
    assert walls.nearest < cut <= trail[-1][0]
    assert count < 45


def test_a_wall_that_is_none_from_nearer_is_gone_to_at_once():
    walls = Walls(1e-5)
    walls.add(-1.0, GONE, 1.0)
    walls.add(0.0, at(0.2), 1.0)
    assert walls.aim([(1.0, at(0.0))], lambda state: True) == -1.0
    assert walls.aim([(1.0, at(0.0))], lambda state: state.stance is Stance.NEAR) == 0.0
    walls.leave_behind(-0.5, -2.0)
    assert walls.nearest == -1.0
