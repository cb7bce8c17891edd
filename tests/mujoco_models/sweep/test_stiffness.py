"""Tridiagonal plus low rank, against the dense matrix."""

from dataclasses import replace

import numpy as np
import pytest

from mujoco_models import DivergedError
from mujoco_models.sweep.stiffness import Stiffness


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
