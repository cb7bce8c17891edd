"""Zeros between bounds, many at a time, to the last digit."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from analytic.numerics.arrays import Booleans, Floats, Integers

_ROUNDING = 4 * float(np.finfo(float).eps)  # of a zero, relative
_LEAST = 1e-300  # a zero of less is none
_NODES = np.cos(np.pi * (np.arange(13) + 0.5) / 13)  # of a polynomial's, about a likely place
_EACH = np.arange(_NODES.size)
_TO_CHEBYSHEV = chebvander(_NODES, _NODES.size - 1).T * np.where(_EACH > 0, 2, 1)[:, None] / 13
_NEAR = 0.1  # of the width between the bounds: up to so far from that place
_AGREED = 1e-13  # of that width: polynomials of one degree less and of this one agree


def zeros(function: Callable[[Integers, Floats], Floats], low: Floats, high: Floats) -> Floats:
    """Where `function` changes its sign, or jumps, to the last digit; `high` where it does not."""
    if not low.size:
        return low
    from scipy.optimize.elementwise import find_root  # slow to load, and many need none

    def value(x: Floats, which: Floats) -> Floats:
        return function(which.astype(int), x)

    bounds, each = (low, high), (np.arange(low.size),)
    found = find_root(value, bounds, args=each)
    return np.where(found.success, found.x, high)


def smooth_zeros(
    function: Callable[[Integers, Floats], Floats], low: Floats, high: Floats, likely: Floats
) -> Floats:
    """`zeros` of smooth functions, nearly known: by Lagrange's inverse interpolation."""
    if not low.size:
        return low
    about = Surroundings.of(low, high, likely)
    found, known = about.zeros(_values(function, np.arange(low.size), about.places))
    left = (~known).nonzero()[0]
    if left.size:
        found[left] = zeros(lambda which, at: function(left[which], at), low[left], high[left])
    return found


class Surroundings(NamedTuple):
    """Places about likely zeros, those of Chebyshev's polynomials, for interpolation."""

    centre: Floats  # shape (n,)
    radius: Floats  # up to how far on either side, shape (n,)

    @classmethod
    def of(cls, low: Floats, high: Floats, likely: Floats) -> "Surroundings":
        width = high - low
        centre = np.clip(likely, low + _NEAR * width, high - _NEAR * width)
        return cls(np.where(np.isfinite(centre), centre, low + width / 2), _NEAR * width)

    @property
    def places(self) -> Floats:
        """The places, shape (n, 13)."""
        return np.asarray(self.centre[:, None] + self.radius[:, None] * _NODES)

    def zeros(self, values: Floats) -> tuple[Floats, Booleans]:
        """Where functions vanish, by Lagrange's inverse interpolation."""
        f = values
        with np.errstate(all="ignore"):  # values that coincide: no polynomial
            shares = f[:, None, :] / (f[:, None, :] - f[:, :, None])
            shares[:, _EACH, _EACH] = 1.0
            weighted = shares.prod(axis=2) * self.radius[:, None] * _NODES
            ahead = weighted.sum(axis=1)
            # Without the first value or the last one it is a polynomial of one degree less.
            doubt = np.maximum(
                np.abs((weighted[:, 1:] / shares[:, 1:, 0]).sum(axis=1) - ahead),
                np.abs((weighted[:, :-1] / shares[:, :-1, -1]).sum(axis=1) - ahead),
            )
            known = doubt <= _AGREED / _NEAR * np.abs(self.radius)
        crosses = np.signbit(f[:, 0]) != np.signbit(f[:, -1])
        return self.centre + ahead, np.asarray(crosses & known)

    def between(self, values: Floats, x: Floats) -> Floats:
        """What functions are elsewhere among the places, by the polynomials through the values."""
        share = (x - self.centre[:, None]) / self.radius[:, None]
        with np.errstate(invalid="ignore"):
            weights = np.cos(np.arccos(share)[..., None] * _EACH) @ _TO_CHEBYSHEV
        found: Floats = np.einsum("mnj,nkj->mnk", values, weights)
        return found


def zero(function: Callable[[Floats], Floats], low: float, high: float) -> float:
    """One zero between bounds at which a function has different signs, to the last digit."""
    from scipy.optimize import brentq

    def value(x: float) -> float:
        return float(function(np.array([x]))[0])

    return float(brentq(value, low, high, xtol=_LEAST, rtol=_ROUNDING, maxiter=1000))


def _values(function: Callable[[Integers, Floats], Floats], which: Integers, x: Floats) -> Floats:
    return function(np.repeat(which, x.shape[1]), x.ravel()).reshape(x.shape)
