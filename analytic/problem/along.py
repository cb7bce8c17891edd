"""A quantity that varies along the vibrissa: a function of arc length, piece by piece.

Functions and tables become Chebyshev series, to rounding. So the quantity is a value: it can be
compared, hashed, pickled and written to a file, and integrated exactly.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError
from analytic.problem.numbers import floats

_DEGREE = 24
_TAIL = 3  # coefficients, of a series that is exact they are rounding
_EXACT = 1e-13  # of a piece's largest value; the solution is good to 1e-10
_JOINED = 1e-6  # of the largest value; pieces that differ by more from one for both stay apart
_UNROUNDED = 1e-290  # numbers not far below are rounded to a fixed step, not to a share of them
_LEAST = 1e-2  # of the largest value of all; less counts as that
_HALVINGS = 44  # then a piece is 1e-13 L wide, and what is in it is a jump
_FIRST = 8  # pieces of a function that are looked at; nothing narrower is seen for sure
_MOST_PIECES = 200
_MOST_LOOKS = 20_000  # at an interval of a function
_NARROW = 1e-12  # of the length
_NOTHING = 1e-15  # of the largest value; the series of what vanishes somewhere has its rounding
_LOOKS = 4097  # places at which a function is compared with its series
_ALIKE = 1e-9  # of the largest value
_ROUNDING = 4 * float(np.finfo(float).eps)
_NODES = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
_TO_SERIES = np.linalg.inv(chebyshev.chebvander(_NODES, _DEGREE))
_CUBIC = 4  # coefficients
_SMOOTH = "smooth but for a few kinks and jumps"
_OR_PAIRS = "give pairs (arc length, value), or drop what is too narrow to matter"
_SPANS = 1e-9  # of the length; by how much a table's ends may miss the vibrissa's


@dataclass(frozen=True, repr=False)
class Along:
    """A function of arc length as a Chebyshev series on each piece of the vibrissa."""

    ends: tuple[float, ...]  # arc lengths at which n pieces begin and end, ascending [length]
    series: tuple[tuple[float, ...], ...]  # coefficients of each piece's series, in its own unit

    def __post_init__(self) -> None:
        try:
            ends = tuple(float(end) for end in self.ends)
            series = tuple(tuple(float(c) for c in piece) for piece in self.series)
            whole = (
                len(ends) == len(series) + 1 > 1
                and all(series)
                and bool((np.diff(ends) > 0).all())
                and bool(np.isfinite(np.concatenate([ends, *series])).all())
            )
        except (TypeError, ValueError):
            whole = False
        if not whole:
            allowed = "ascending ends of pieces, and finite coefficients for each"
            remedy = "give a function of arc length, or pairs (arc length, value)"
            raise InputError("series along the vibrissa", "other numbers", allowed, remedy)
        object.__setattr__(self, "ends", ends)
        object.__setattr__(self, "series", series)

    @classmethod
    def of(cls, name: str, given: object, length: float) -> "float | Along":
        """What was given as a function of arc length or as a table.

        Between a table's points the monotone cubics of Fritsch and Butland interpolate
        (`scipy.interpolate.PchipInterpolator`): smooth, and never beyond its neighbours.
        """
        if isinstance(given, Mapping):  # as a file has it
            given = cls(given.get("ends", ()), given.get("series", ()))
        if isinstance(given, cls):
            found = given
            _check_span(name, found.ends[0], found.ends[-1], length)
        elif callable(given):
            found = _sampled(name, given, length)
        else:
            found = _interpolated(name, given, length)
        constant = {piece[0] for piece in found.series if len(piece) == 1}
        if len(constant) == 1 and all(len(piece) == 1 for piece in found.series):
            return constant.pop()
        return found

    def __repr__(self) -> str:
        ends = (
            f"{float(self(np.array(self.ends[0]))):g} to {float(self(np.array(self.ends[-1]))):g}"
        )
        return f"<{ends} along s = {self.ends[0]:g} to {self.ends[-1]:g}>"

    def __format__(self, _: str) -> str:
        return repr(self)

    def __call__(self, s: Floats) -> Floats:
        """Values at arc lengths."""
        s = np.clip(s, self.ends[0], self.ends[-1])
        i = np.searchsorted(self._inner, s, side="right")
        x = (s - self._middle[i]) / self._half[i]
        above, value = np.zeros_like(x), np.zeros_like(x)
        for coefficient in self._coefficients[:0:-1]:  # Clenshaw's recurrence
            value, above = coefficient[i] + 2 * x * value - above, value
        return np.asarray(self._coefficients[0][i] + x * value - above)

    def times(self, factor: float, stretch: float = 1.0) -> "Along":
        """The same in other units."""
        return Along(
            tuple(end * stretch for end in self.ends),
            tuple(tuple(c * factor for c in piece) for piece in self.series),
        )

    def integral(self) -> "Along":
        """The integral from the clamp."""
        series, reached = [], 0.0
        for piece, half in zip(self.series, self._half, strict=True):
            found = half * chebyshev.chebint(piece, lbnd=-1)
            found[0] += reached
            reached = float(found.sum())
            series.append(tuple(found.tolist()))
        return Along(self.ends, tuple(series))

    def first_not_positive(self) -> float | None:
        """Where the quantity is first zero, but for rounding, or negative."""
        nothing = _NOTHING * float(np.abs(self._coefficients).sum(axis=0).max())
        vanishes = None
        for piece, middle, half in zip(self.series, self._middle, self._half, strict=True):
            roots = chebyshev.chebroots(piece) if len(piece) > 1 else np.empty(0)
            real = roots.real[(abs(roots.imag) < 1e-12) & (abs(roots.real) <= 1)]
            at = np.sort(np.concatenate([[-1.0], real, [1.0]]))
            at = np.append(at, (at[1:] + at[:-1]) / 2)
            values = chebyshev.chebval(at, piece)
            if (values <= 0).any():
                return float(middle + half * at[values <= 0].min())
            if vanishes is None and (values <= nothing).any():
                vanishes = float(middle + half * at[np.argmin(values)])
        return vanishes

    @cached_property
    def _inner(self) -> Floats:
        return np.array(self.ends[1:-1])

    @cached_property
    def _middle(self) -> Floats:
        return (np.array(self.ends[1:]) + self.ends[:-1]) / 2

    @cached_property
    def _half(self) -> Floats:
        return np.diff(self.ends) / 2

    @cached_property
    def _coefficients(self) -> Floats:
        """By degree and piece."""
        found = np.zeros((max(map(len, self.series)), len(self.series)))
        for i, piece in enumerate(self.series):
            found[: len(piece), i] = piece
        return found


def _check_span(name: str, begin: float, end: float, length: float) -> None:
    if not max(abs(begin), abs(end - length)) <= _SPANS * length:
        allowed = f"from the clamp, s = 0, to the tip, s = {length:g}"
        remedy = "give all of the vibrissa, in the unit of its length"
        raise InputError(name, f"from s = {begin:g} to {end:g}", allowed, remedy)


def _interpolated(name: str, given: object, length: float) -> Along:
    from scipy.interpolate import PchipInterpolator  # slow to load, and few need it

    allowed = (
        f"a number, a function of arc length, or 2 to {_MOST_PIECES} pairs (arc length, value)"
    )
    table = floats(name, given, (None, 2), allowed)
    if not 2 <= len(table) <= _MOST_PIECES:
        raise InputError(name, f"{given!r}"[:80], allowed, "as 1.0, or [(0, 1.0), (1, 0.5)]")
    s, values = table.T
    wrong = np.append(False, np.diff(s) <= 0)
    if wrong.any():
        i = int(np.argmax(wrong))
        what = tuple(table[i].tolist())
        raise InputError(f"{name}, pair {i}", what, "after the one before", "correct or drop it")
    _check_span(name, s[0], s[-1], length)
    s[0], s[-1] = 0.0, length
    curve = PchipInterpolator(s, values)
    half, middle = np.diff(s) / 2, (s[1:] + s[:-1]) / 2
    nodes = np.cos(np.pi * (np.arange(_CUBIC) + 0.5) / _CUBIC)
    at = curve(middle[:, None] + half[:, None] * nodes)
    series = np.linalg.solve(chebyshev.chebvander(nodes, _CUBIC - 1), at.T).T
    return Along(tuple(s.tolist()), tuple(_trimmed(piece) for piece in series))


def _sampled(name: str, function: Callable[[Floats], Floats], length: float) -> Along:
    """The series of a function, on pieces that are halved until it is exact there."""

    def series_on(begin: float, end: float) -> tuple[Floats, bool]:
        nodes = (begin + end) / 2 + (end - begin) / 2 * _NODES
        values = _values(name, function, nodes)
        if values.min() == values.max():
            return values[:1], True
        found = _TO_SERIES @ values
        size = max(float(np.abs(values).max()), _LEAST * largest)
        return found, bool(np.abs(found[-_TAIL:]).max() <= _EXACT * size)

    largest = float(np.abs(_values(name, function, np.linspace(0, length, 65))).max())
    largest = max(largest, _UNROUNDED)
    ends, pieces = [0.0], list[Floats]()
    marks = np.linspace(0, length, _FIRST + 1).tolist()
    ahead = list(pairwise(marks))[::-1]
    for _ in range(_MOST_LOOKS):
        if not ahead:
            break
        begin, end = ahead.pop()
        found, exact = series_on(begin, end)
        if not exact and end - begin > length / 2**_HALVINGS:
            middle = (begin + end) / 2
            ahead += [(middle, end), (begin, middle)]
        elif end - begin > _NARROW * length:  # else a kink or a jump
            # The halves that led to a kink are one smooth piece.
            while pieces and _NARROW * length < ends[-1] - ends[-2]:
                joined, smooth = series_on(ends[-2], end)
                parts = ((ends[-2], ends[-1], pieces[-1]), (begin, end, found))
                # A jump next to an end lies beyond the outermost node: the parts have seen it.
                if not smooth or not all(
                    np.abs(at - there).max() <= _JOINED * largest
                    for at, there in (_both(joined, (ends[-2], end), part) for part in parts)
                ):
                    break
                found = joined
                del ends[-1], pieces[-1]
            ends.append(end)
            pieces.append(found)
    if ahead or len(pieces) > _MOST_PIECES:
        raise InputError(name, f"a function that is rough at s = {begin:g}", _SMOOTH, _OR_PAIRS)
    ends[-1] = length
    whole = Along(tuple(ends), tuple(_trimmed(piece) for piece in pieces))
    places = np.linspace(0, length, _LOOKS)
    off = np.abs(_values(name, function, places) - whole(places)) > _ALIKE * largest
    off &= np.abs(places[:, None] - ends).min(axis=1) > _NARROW * length  # of a jump, either side
    if off.any():
        what = f"a function with a narrow dent at s = {places[np.argmax(off)]:g}"
        raise InputError(name, what, _SMOOTH, _OR_PAIRS)
    return whole


def _both(
    joined: Floats, ends: tuple[float, float], part: tuple[float, float, Floats]
) -> tuple[Floats, Floats]:
    """Two series at the nodes of a part: that of the whole between two ends, and the part's own."""
    begin, end, own = part
    nodes = (begin + end) / 2 + (end - begin) / 2 * _NODES
    x = (2 * nodes - ends[0] - ends[1]) / (ends[1] - ends[0])
    at, there = chebyshev.chebval(x, joined), chebyshev.chebval(_NODES, own)
    return np.asarray(at, dtype=float), np.asarray(there, dtype=float)


def _values(name: str, function: Callable[[Floats], Floats], s: Floats) -> Floats:
    try:
        with np.errstate(all="ignore"):  # what is not finite is reported
            found = np.broadcast_to(np.asarray(function(s), dtype=float), s.shape)
    except (TypeError, ValueError) as error:
        what, allowed = "a function that takes no array", "one of an array of arc lengths"
        raise InputError(name, what, allowed, f"write it with NumPy functions ({error})") from error
    wrong = ~np.isfinite(found)
    if wrong.any():
        i = int(np.argmax(wrong))
        raise InputError(name, f"{found[i]} at s = {s[i]:g}", "finite all along")
    return found


def _trimmed(series: Floats) -> tuple[float, ...]:
    """The series without what is rounding at its end."""
    counts = np.flatnonzero(np.abs(series) > _ROUNDING * np.abs(series).max())
    last = int(counts[-1]) if counts.size else 0
    return tuple(series[: last + 1].tolist())
