"""How a step is found: the stiffness against the dense matrix, contact forces, secants, an end."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

from mujoco_models import DivergedError
from mujoco_models.model.contact_side import Side
from mujoco_models.sweep.bracket import Bracket
from mujoco_models.sweep.secant import Secant
from mujoco_models.sweep.state import State
from mujoco_models.sweep.stiffness import Stiffness
from mujoco_models.sweep.unilateral import unilateral


def dense(stiffness, shift=0.0):
    count = len(stiffness.springs)
    joints = np.eye(count) - np.eye(count, k=-1)  # a joint's angle, from those of the links
    low = stiffness.directions.T @ np.diag(stiffness.weights) @ stiffness.directions
    return joints.T @ np.diag(stiffness.springs + shift) @ joints + np.diag(stiffness.links) + low


def drawn(draw, count):
    """As at rest: springs N, a load that presses or pulls, contacts held and turning.

    Pressed by more than pi^2/4, the clamped beam alone buckles; what holds it prevents that, if it
    is stiff. One in four lies on more beads than it has links.
    """
    load = draw.choice([-4.0, -2.0, 2.0]) * draw.uniform(0.8, 1.2, count)
    held = draw.uniform(0.5, 1.0, (int(draw.choice([1, 2, 3, 2 * count])), count)) / count
    turning = draw.normal(size=(int(draw.integers(3)), count)) / count
    weights = [
        np.full(len(held), draw.choice([1e3, 0.1])),
        draw.choice([5.0, -5.0, -1e4], len(turning)),
    ]
    springs = count * draw.uniform(0.8, 1.2, count)
    return Stiffness(springs, load / count, np.vstack([held, turning]), np.concatenate(weights))


@pytest.mark.parametrize("count", [1, 2, 3, 12, 40])
def test_solves_as_the_dense_matrix_does(count):
    """Positive definite ones as they are, others without what pulls, or shifted by the least."""
    draw, plain, shifted, indefinite, without = np.random.default_rng(count), 0, 0, 0, 0
    for _ in range(100):
        stiffness = whole = drawn(draw, count)
        if np.linalg.eigvalsh(dense(whole))[0] <= 0:
            kept = whole.weights > 0
            stiffness = replace(
                whole, directions=whole.directions[kept], weights=whole.weights[kept]
            )
        shift = 0.0
        while np.linalg.eigvalsh(dense(stiffness, shift))[0] <= 0:
            shift = max(2 * shift, 0.02 * count)
        alone = Stiffness(stiffness.springs, stiffness.links, np.zeros((0, count)), np.zeros(0))
        plain += shift == 0
        shifted += shift > 0
        without += stiffness is not whole and shift == 0
        indefinite += shift == 0 and np.linalg.eigvalsh(dense(alone))[0] < 0
        moments = draw.normal(size=(3, count))
        exact = np.linalg.solve(dense(stiffness, shift), moments.T).T
        for near in (0, 2, 9):
            found, doubled = whole.solve(moments, near)
            assert shift == (0.02 * count * 2.0 ** (doubled - 1) if doubled else 0)
            # Observed at most 1e-12, beside a tridiagonal part that is next to singular.
            np.testing.assert_allclose(found, exact, rtol=0, atol=1e-10 * np.abs(exact).max())
    assert plain and shifted and indefinite and without  # all ways have been gone


def test_what_is_not_finite_is_refused():
    stiffness = Stiffness(np.array([1.0, np.nan]), np.zeros(2), np.zeros((0, 2)), np.zeros(0))
    with pytest.raises(DivergedError, match="finite"):
        stiffness.solve(np.ones((1, 2)))


STIFF = 1e4


def drawn_contacts(seed, contacts, links):
    draw = np.random.default_rng(seed)
    comes = draw.normal(size=(contacts, links))
    root = draw.normal(size=(links, links))
    turns = comes @ np.linalg.inv(root @ root.T + np.eye(links))
    return comes, turns, np.full(contacts, 1 / STIFF), draw.normal(size=contacts)


@given(st.integers(0, 10**6), st.integers(1, 60), st.integers(2, 20))
@settings(max_examples=100)
def test_what_pushes_closes_its_gap_and_the_others_stay_open(seed, contacts, links):
    comes, turns, soft, gap = drawn_contacts(seed, contacts, links)
    force = unilateral(comes, turns, soft, gap, gap < 0)
    left = comes @ (force @ turns) + soft * force + gap
    near = 1e-9 * (1 + np.abs(left).max())
    assert (force >= 0).all()
    assert (left > -near).all()
    assert np.abs(force * left).max() < near * (1 + force.max())


@pytest.mark.parametrize("guessed", [False, True])
def test_any_guess_leads_to_the_forces_of_another_method(guessed):
    comes, turns, soft, gap = drawn_contacts(1, 40, 6)
    root = np.linalg.cholesky(comes @ turns.T + np.diag(soft))
    expected = nnls(root.T, -np.linalg.solve(root, gap))[0]
    found = unilateral(comes, turns, soft, gap, np.full(40, guessed))
    np.testing.assert_allclose(found, expected, atol=1e-8 * expected.max())


def iterate(count, secant):
    """Newton's method on a stiffness of which three directions are unknown to it."""
    draw = np.random.default_rng(5)
    known = np.diag(draw.uniform(1, 3, size=count))
    off = draw.normal(size=(count, 3))
    stiffness, moments = known + 0.05 * off @ off.T, draw.normal(size=count)
    angles = np.zeros(count)
    for i in range(100):
        imbalance = moments - stiffness @ angles
        if np.abs(imbalance).max() < 1e-9:
            return i
        step = np.linalg.solve(known, imbalance)
        angles = angles + (secant.better(angles, step) if secant else step)
    return None


def test_as_many_steps_as_directions_are_unknown():
    # Two before it begins, one for each direction, and two to the end.
    assert iterate(20, Secant()) <= 7
    assert iterate(20, None) is None or iterate(20, None) > 20


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
