"""Vectors and axes as they are given, checked with one line that says what is wrong."""

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError

Vector: TypeAlias = tuple[float, float, float] | Floats

_LARGEST = 1e100


def vector(name: str, value: ArrayLike) -> Floats:
    """Three finite numbers."""
    try:
        found = np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(name, value, "three numbers", "as (0, 1, 0)") from error
    if found.shape != (3,) or not (np.abs(found) <= _LARGEST).all():
        raise InputError(name, value, "three finite numbers", "as (0, 1, 0)")
    return found


def direction(name: str, value: ArrayLike) -> Floats:
    """A vector of length 1 along three numbers."""
    found = vector(name, value)
    size = float(np.linalg.norm(found))
    if not size > 1 / _LARGEST:
        raise InputError(name, value, "a direction", "one of the three must not be 0")
    return found / size


def axes(name: str, value: ArrayLike) -> Floats:
    """Three unit vectors normal to each other, from three that nearly are."""
    try:
        given = np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(name, value, "three vectors", "as [[1, 0, 0], ...]") from error
    right = given.shape == (3, 3) and bool(np.isfinite(given).all())
    if right:
        left_side, _, right_side = np.linalg.svd(given)
        nearest = left_side @ right_side
        right = bool(np.abs(nearest - given).max() < 1e-6 and np.linalg.det(nearest) > 0)
    if not right:
        raise InputError(
            name, value, "three unit vectors at right angles, right-handed", "a row an axis"
        )
    return np.asarray(nearest)
