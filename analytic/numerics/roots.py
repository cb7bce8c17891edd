"""Zeros between bounds, many at a time, to the last digit."""

from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial.chebyshev import chebvander

from analytic.problem.arrays import Booleans, Floats, Integers

_MAX_ITERATIONS = 120  # bisection alone needs 53, and 64 more to pass from 1 to 1e-19
_ROUNDING = 2 * float(np.finfo(float).eps)  # of a zero, relative
_NODES = np.cos(np.pi * (np.arange(13) + 0.5) / 13)  # of a polynomial's, about a likely place
_EACH = np.arange(_NODES.size)
_TO_CHEBYSHEV = chebvander(_NODES, _NODES.size - 1).T * np.where(_EACH > 0, 2, 1)[:, None] / 13
_NEAR = 0.1  # of the width between the bounds: up to so far from that place
_AGREED = 1e-13  # of that width: polynomials of one degree less and of this one agree
_AT_ONCE, _ASIDE = 64, 15  # so many numbers take hardly longer than one; at most, on either side


def zeros(function: Callable[[Integers, Floats], Floats], low: Floats, high: Floats) -> Floats:
    """Where `function` changes its sign, or jumps (Chandrupatla, Adv. Eng. Software 28, 1997)."""
    low, high = np.array(low, dtype=float), np.array(high, dtype=float)
    if not low.size:
        return low
    found, which = np.empty_like(low), np.arange(low.size)
    even = _even(_pairs(which.size))
    x = low[:, None] + even * (high - low)[:, None]
    x[:, -1] = high
    f = _values(function, which, x)
    for _ in range(_MAX_ITERATIONS):
        a, b, c, f_a, f_b, f_c = _narrowed(x, f)
        width = np.abs(b - a)
        nearest = np.where(np.abs(f_a) < np.abs(f_b), a, b)
        rounding = _ROUNDING * np.abs(nearest)
        going = (width > 2 * rounding) & (f_a != 0) & (f_b != 0)
        found[which] = nearest
        if not going.any():
            break
        a, b, c, f_a, f_b, f_c = (values[going] for values in (a, b, c, f_a, f_b, f_c))
        which, margin = which[going], np.minimum(rounding[going] / width[going], 0.5)
        share, smooth = _share(a, b, c, f_a, f_b, f_c)
        inside = _spread(np.clip(share, margin, 1 - margin), margin, smooth, _pairs(which.size))
        x = a[:, None] + inside * (b - a)[:, None]
        f = _values(function, which, x)
        x, f = _between(a, x, b), _between(f_a, f, f_b)
    return found


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
    return float(zeros(lambda _, x: function(x), np.array([low]), np.array([high]))[0])


def _pairs(zeros: int) -> int:
    """At how many places on either side of the most likely one each of so many zeros is sought."""
    return min(_AT_ONCE // max(zeros, 1) // 2, _ASIDE)


def _values(function: Callable[[Integers, Floats], Floats], which: Integers, x: Floats) -> Floats:
    return function(np.repeat(which, x.shape[1]), x.ravel()).reshape(x.shape)


def _narrowed(x: Floats, f: Floats) -> tuple[Floats, ...]:
    """The two neighbours a and b with a zero between them, and the one next to a; their values."""
    other = np.signbit(f) != np.signbit(f[:, :1])
    other[:, -1] = True
    end = np.argmax(other, axis=1)
    row, last = np.arange(end.size), f.shape[1] - 1
    before, after = np.maximum(end - 2, 0), np.minimum(end + 1, last)
    back = (end == last) | ((end > 1) & (np.abs(f[row, before]) < np.abs(f[row, after])))
    places = (
        np.where(back, end - 1, end),
        np.where(back, end, end - 1),
        np.where(back, before, after),
    )
    return (*(x[row, place] for place in places), *(f[row, place] for place in places))


def _share(
    a: Floats, b: Floats, c: Floats, f_a: Floats, f_b: Floats, f_c: Floats
) -> tuple[Floats, Booleans]:
    """How far from a to b the zero most likely lies; whether interpolation says so."""
    with np.errstate(all="ignore"):  # coinciding values: bisection
        place, value = (a - b) / (c - b), (f_a - f_b) / (f_c - f_b)
        smooth = (value**2 < place) & ((1 - value) ** 2 < 1 - place)
        share = f_a / (f_b - f_a) * f_c / (f_b - f_c) + (c - a) / (b - a) * f_a / (
            f_c - f_a
        ) * f_b / (f_c - f_b)
    smooth &= np.isfinite(share)
    return np.where(smooth, share, 0.5), smooth


def _spread(share: Floats, margin: Floats, smooth: Booleans, pairs: int) -> Floats:
    """Places between a and b: about `share`, ever closer up to `margin`, or evenly spaced."""
    if pairs == 0:
        return share[:, None]
    closer = margin[:, None] ** (np.arange(1, pairs + 1) / pairs)
    share = share[:, None]
    about = _between(share - share * closer, share, (share + (1 - share) * closer)[:, ::-1])
    return about if smooth.all() else np.where(smooth[:, None], about, _even(pairs)[1:-1])


@cache
def _even(pairs: int) -> Floats:
    """As many places from 0 to 1 as are looked at first, evenly spaced."""
    return np.linspace(0, 1, 2 * pairs + 3)


def _between(before: Floats, values: Floats, after: Floats) -> Floats:
    """Columns side by side; one may be given as shape (n,)."""
    parts = [x[:, None] if x.ndim == 1 else x for x in (before, values, after)]
    return np.concatenate(parts, axis=1)
