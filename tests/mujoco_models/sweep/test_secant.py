"""What Newton's steps show of a stiffness that is not what the solver takes it for."""

import numpy as np

from mujoco_models.sweep.secant import Secant


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
