"""Where the branch of equilibria ends is closed in on."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from mujoco_models.model.contact_side import Side
from mujoco_models.sweep.bracket import Bracket
from mujoco_models.sweep.state import State


def at(tip_angle):
    """A state at rest with one joint, so that its turn is the tip's."""
    return State(np.array([tip_angle]), {0: 1.0}, settled=True, side=Side.NEAR)


GONE = State(np.array([3.0]), {}, settled=True, side=Side.PASSED)


@given(st.floats(-0.9, 0.9))
def test_the_end_of_a_branch_is_found(end):
    bracket, foot_x, count = Bracket(), 1.0, 0
    bracket.add(-1.0, GONE, foot_x)
    while abs(bracket.nearest - foot_x) > 1e-5:
        trial = bracket.aim(foot_x, lambda state: state.side is Side.NEAR)
        count += 1
        if trial >= end:
            foot_x = trial
            bracket.leave_behind(trial, -1e3)
        else:
            bracket.add(trial, GONE, foot_x)
    assert bracket.nearest < end <= foot_x
    assert count < 45


def test_a_failure_that_is_none_from_nearer_is_gone_to_at_once():
    bracket = Bracket()
    bracket.add(-1.0, GONE, 1.0)
    bracket.add(0.0, at(0.2), 1.0)
    assert bracket.aim(1.0, lambda state: True) == -1.0
    assert bracket.aim(1.0, lambda state: state.side is Side.NEAR) == 0.0
    bracket.leave_behind(-0.5, -2.0)
    assert bracket.nearest == -1.0
