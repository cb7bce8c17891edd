"""The outline of a convex body from straight rays that just touch it, in many directions."""

import numpy as np
from numpy.typing import ArrayLike

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError


def outline_of_tangents(angle: ArrayLike, distance: ArrayLike) -> Floats:
    """The polygon that tangents enclose: where each of them meets the next.

    A tangent whose outward normal has the angle theta lies at the distance h(theta) from the
    origin, the support function of the body. The idea of first contacts as rays is tomography's;
    derived here.
    """
    theta, h = np.asarray(angle, dtype=float), np.asarray(distance, dtype=float)
    if theta.ndim != 1 or theta.shape != h.shape or len(theta) < 3:
        raise InputError(
            "tangents",
            f"of shapes {theta.shape} and {h.shape}",
            "three or more angles, and as many distances",
            "give one distance an angle",
        )
    turn = np.diff(theta, append=theta[0] + 2 * np.pi)
    if not ((turn > 0) & (turn < np.pi)).all():
        i = int(np.argmax(~((turn > 0) & (turn < np.pi))))
        raise InputError(
            f"turn after tangent {i}",
            f"{turn[i]:.6g} rad",
            "between 0 and half a turn",
            "sort the angles, and add tangents on the side that has none",
        )
    after, h_after = np.roll(theta, -1), np.roll(h, -1)
    x = (h * np.sin(after) - h_after * np.sin(theta)) / np.sin(turn)
    y = (h_after * np.cos(theta) - h * np.cos(after)) / np.sin(turn)
    return np.column_stack([x, y])
