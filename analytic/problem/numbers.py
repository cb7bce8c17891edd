"""Checks of single numbers, each with one line that says what is wrong."""

import math
from numbers import Integral, Real
from typing import TypeGuard

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError

LARGEST = 1e150  # its square is a number still, and so is its inverse


def is_finite_number(value: object) -> TypeGuard[float]:
    """Whether a value is a real, finite number and no boolean."""
    if not isinstance(value, Real) or isinstance(value, bool):
        return False
    try:
        return math.isfinite(value)
    except OverflowError:  # an integer too large for a float
        return False


def is_whole_number(value: object) -> TypeGuard[int]:
    """Whether a value is an integer and no boolean."""
    return isinstance(value, Integral) and not isinstance(value, bool)


def finite(name: str, value: object) -> float:
    """A number that is finite and whose square is, too."""
    if not (is_finite_number(value) and abs(value) <= LARGEST):
        raise InputError(name, value, "a finite number", "correct it")
    return float(value)


def positive(name: str, value: object) -> float:
    """A number that is positive and finite, and whose square and inverse are numbers."""
    if not (is_finite_number(value) and 1 / LARGEST <= value <= LARGEST):
        allowed = f"positive and finite ({1 / LARGEST:g} to {LARGEST:g})"
        raise InputError(name, value, allowed, "correct the number or its sign")
    return float(value)


def pair(name: str, value: object) -> tuple[float, float]:
    """Two finite numbers."""
    first: object
    second: object
    try:
        first, second = value  # type: ignore[misc]  # whatever was given
    except (TypeError, ValueError) as error:
        raise InputError(name, value, "two numbers", "as (0.0, 0.5)") from error
    if not (is_finite_number(first) and is_finite_number(second)):
        raise InputError(name, value, "two finite numbers", "correct them")
    return finite(f"{name}[0]", first), finite(f"{name}[1]", second)


def points_of(name: str, value: object) -> Floats:
    """Points of the plane, at least three."""
    try:
        points = np.array(value, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise InputError(
            name, "no list of points", "a list of points (x, y)", f"correct it ({error})"
        ) from error
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
        raise InputError(
            name, f"of shape {points.shape}", "three or more points (x, y)", "add some"
        )
    wrong = ~(np.abs(points) <= LARGEST).all(axis=1)
    if wrong.any():
        i = int(np.argmax(wrong))
        raise InputError(f"{name} {i}", points[i], "finite", "correct or drop it")
    return points
