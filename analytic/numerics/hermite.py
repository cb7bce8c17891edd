"""Cubics with given values and derivatives at both ends of intervals, many at a time."""

import numpy as np

from analytic.numerics.arrays import Floats


def hermite(share: Floats, begin: Floats, rate: Floats, end: Floats, end_rate: Floats) -> Floats:
    """Values at a share of the way, from values and derivatives by that share."""
    a, b = share, 1 - share
    first, last = (1 + 2 * a) * begin + a * rate, (1 + 2 * b) * end - b * end_rate
    return np.asarray(b * b * first + a * a * last)


def least_of_hermite(begin: Floats, rate: Floats, end: Floats, end_rate: Floats) -> Floats:
    """At which share of the way cubics are least between their ends."""
    rise = end - begin
    second, third = 3 * rise - 2 * rate - end_rate, rate + end_rate - 2 * rise
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(-rate / (second + np.sqrt(second * second - 3 * third * rate)))
