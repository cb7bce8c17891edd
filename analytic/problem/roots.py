"""Zeros between bounds, many at a time, to the last digit."""

from collections.abc import Callable

import numpy as np

from analytic.problem.arrays import Floats

_MAX_ITERATIONS = 120  # bisection alone needs 53, and 64 more to pass from 1 to 1e-19
_ROUNDING = 2 * float(np.finfo(float).eps)  # of a zero, relative


def zeros(function: Callable[[Floats], Floats], low: Floats, high: Floats) -> Floats:
    """Where `function` changes its sign between `low` and `high`.

    Chandrupatla's method (Adv. Eng. Software 28, 1997): inverse quadratic interpolation where three
    values allow it, bisection elsewhere. Where the function jumps, it is the place of the jump.

    Parameters
    ----------
    function : callable
        Maps an array of shape (n,) to its values, element by element; not continuous or smooth of
        need, but never NaN.
    low, high : array, shape (n,)
        Bounds, at which the function has different signs.

    Returns
    -------
    array, shape (n,)
        Of the two numbers that enclose each zero to rounding, the one with the smaller value.
    """
    a, b = np.array(low, dtype=float), np.array(high, dtype=float)
    if a.size == 0:
        return a
    f_a, f_b = function(a), function(b)
    share = np.full(a.shape, 0.5)
    for _ in range(_MAX_ITERATIONS):
        new = a + share * (b - a)
        f_new = function(new)
        same = np.signbit(f_new) == np.signbit(f_a)
        c, f_c = np.where(same, a, b), np.where(same, f_a, f_b)
        b, f_b = np.where(same, b, a), np.where(same, f_b, f_a)
        a, f_a = new, f_new
        width = np.abs(b - a)
        nearest = np.where(np.abs(f_a) < np.abs(f_b), a, b)
        rounding = _ROUNDING * np.abs(nearest)
        going = (width > 2 * rounding) & (f_a != 0) & (f_b != 0)
        if not going.any():
            break
        share = _share(a, b, c, f_a, f_b, f_c)
        with np.errstate(all="ignore"):  # a bracket that is closed
            margin = np.minimum(rounding / width, 0.5)
        share = np.where(going, np.clip(share, margin, 1 - margin), 0.0)
    return np.where(np.abs(f_a) < np.abs(f_b), a, b)


def zero(function: Callable[[float], float], low: float, high: float) -> float:
    """`zeros` of a function of one number.

    Parameters
    ----------
    function : callable
        Maps a number to a number.
    low, high : float
        Bounds, at which the function has different signs.

    Returns
    -------
    float
        The zero.
    """
    found = zeros(lambda x: np.array([function(float(x[0]))]), np.array([low]), np.array([high]))
    return float(found[0])


def _share(a: Floats, b: Floats, c: Floats, f_a: Floats, f_b: Floats, f_c: Floats) -> Floats:
    """How far from a to b the next point lies."""
    with np.errstate(all="ignore"):  # coinciding values: bisection
        place, value = (a - b) / (c - b), (f_a - f_b) / (f_c - f_b)
        smooth = (value**2 < place) & ((1 - value) ** 2 < 1 - place)
        share = f_a / (f_b - f_a) * f_c / (f_b - f_c) + (c - a) / (b - a) * f_a / (
            f_c - f_a
        ) * f_b / (f_c - f_b)
    return np.where(smooth & np.isfinite(share), share, 0.5)
