"""Vectors and axes as they are given, checked with one line that says what is wrong."""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError
from analytic.problem.numbers import LARGEST, floats

Vector: TypeAlias = tuple[float, float, float] | Floats


def vector(name: str, value: ArrayLike) -> Floats:
    """Three finite numbers."""
    return floats(name, value, (3,), "three numbers, as (0, 1, 0)")


def direction(name: str, value: ArrayLike) -> Floats:
    """A vector of length 1 along three numbers."""
    found = vector(name, value)
    size = float(np.linalg.norm(found))
    if not size > 1 / LARGEST:
        raise InputError(name, value, "a direction", "one of the three must not be 0")
    return found / size


def axes(name: str, value: ArrayLike) -> Floats:
    """Three unit vectors normal to each other, from three that nearly are."""
    given = floats(name, value, (3, 3), "three vectors, as [[1, 0, 0], ...]")
    left_side, _, right_side = np.linalg.svd(given)
    nearest: Floats = left_side @ right_side
    if np.abs(nearest - given).max() > 1e-6 or np.linalg.det(nearest) < 0:
        allowed = "three unit vectors at right angles, right-handed"
        raise InputError(name, value, allowed, "a row an axis")
    return nearest
