"""Vectors in space, their components along the last axis."""

import numpy as np

from analytic.numerics.arrays import Floats

_NEXT, _LAST = [1, 2, 0], [2, 0, 1]  # of x, y and z, in turn


def cross(a: Floats, b: Floats) -> Floats:
    """As `np.cross`, which takes five times as long to find out which axes are meant."""
    if a.ndim == b.ndim == 1:  # six numbers are faster one by one than as arrays
        x, y, z = a.tolist()
        u, v, w = b.tolist()
        return np.array([y * w - z * v, z * u - x * w, x * v - y * u])
    return a[..., _NEXT] * b[..., _LAST] - a[..., _LAST] * b[..., _NEXT]
