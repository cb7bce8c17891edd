"""Checks of numbers and arrays, each with one line that says what is wrong."""

import math
from collections.abc import Sequence
from numbers import Real
from typing import TypeAlias, TypeGuard

import numpy as np
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError, kind_of
from analytic.problem.whole import as_whole

LARGEST = 1e150  # its square is a number still, and so is its inverse

Vector: TypeAlias = tuple[float, float, float] | Floats


def is_finite_number(value: object) -> TypeGuard[float]:
    if not isinstance(value, Real) or isinstance(value, bool):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer too large for a float
        return False


def within(
    name: str, value: object, low: float, high: float = LARGEST, remedy: str = "correct it"
) -> float:
    if not (is_finite_number(value) and low <= float(value) <= high):
        kind = "positive" if low > 0 else "finite"
        if isinstance(value, str):
            remedy = "write a number: units are read in case files alone"
        elif not isinstance(value, Real):  # one that looks like a number may be none
            remedy = f"it is {kind_of(value)}: give a plain number"
        raise InputError(name, value, f"a {kind} number between {low:g} and {high:g}", remedy)
    return float(value)


def whole(name: str, value: object, low: int, high: int) -> int:
    number = as_whole(value)
    if number is None or not low <= number <= high:
        raise InputError(name, value, f"a whole number, {low} to {high:,}", "200 is usual")
    return number


def finite(name: str, value: object) -> float:
    """A number that is finite and whose square is, too."""
    return within(name, value, -LARGEST)


def positive(name: str, value: object) -> float:
    """A number that is positive and finite, and whose square and inverse are numbers."""
    return within(name, value, 1 / LARGEST)


def floats(name: str, value: object, shape: Sequence[int | None], allowed: str) -> Floats:
    """Finite numbers in an array of some shape, of which None is any length."""
    try:
        found = np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        found = np.array(np.nan)
    fits = [n in (None, m) for n, m in zip(shape, found.shape, strict=False)]
    if found.ndim != len(shape) or not all(fits):
        raise InputError(name, f"{value!r}"[:80], allowed)
    wrong = ~(np.abs(found) <= LARGEST)
    if wrong.any():
        place = np.argwhere(wrong)[0].tolist()
        raise InputError(f"{name}{place}", found[tuple(place)], "a finite number")
    return found


def pair(name: str, value: object) -> tuple[float, float]:
    first, second = floats(name, value, (2,), "two numbers, as (0.0, 0.5)").tolist()
    return first, second


def points_of(name: str, value: object) -> Floats:
    points = floats(name, value, (None, 2), "a list of points (x, y)")
    if len(points) < 3:
        raise InputError(name, f"{len(points)} points", "three or more", "add some")
    return points


def vector(name: str, value: ArrayLike) -> Floats:
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
