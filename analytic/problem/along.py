"""A quantity that varies along the vibrissa: pieces of Chebyshev series by arc length, a value."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.chebyshev import chebvander
from numpy.polynomial.polyutils import trimcoef

from analytic.numerics.arrays import Floats
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
_TO_SERIES = np.linalg.inv(chebvander(_NODES, _DEGREE))
_CUBIC_NODES = np.cos(np.pi * (np.arange(4) + 0.5) / 4)
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
        """What was given as a function of arc length or as a table; monotone between its points."""
        if isinstance(given, Mapping):  # as a file has it
            given = cls(given.get("ends", ()), given.get("series", ()))
        if isinstance(given, cls):
            found = given
            _check_span(name, found.ends[0], found.ends[-1], length)
        elif callable(given):
            found = sampled(name, given, length)
        else:
            found = _interpolated(name, given, length)
        constant = {piece[0] for piece in found.series if len(piece) == 1}
        if len(constant) == 1 and all(len(piece) == 1 for piece in found.series):
            return constant.pop()
        return found

    @classmethod
    def through(cls, pieces: Sequence[Chebyshev]) -> "Along":
        ends = [piece.domain[0] for piece in pieces]
        series = tuple(tuple(piece.coef.tolist()) for piece in pieces)
        return cls((*ends, pieces[-1].domain[1]), series)

    def __repr__(self) -> str:
        begin, end = self.ends[0], self.ends[-1]
        first, last = self(np.array([begin, end]))
        return f"<{first:g} to {last:g} along s = {begin:g} to {end:g}>"

    def __format__(self, _: str) -> str:
        return repr(self)

    def __call__(self, s: Floats) -> Floats:
        s = np.clip(s, self.ends[0], self.ends[-1])
        i = np.searchsorted(self._inner, s, side="right")
        x = (s - self._middle[i]) / self._half[i]
        above, value = np.zeros_like(x), np.zeros_like(x)
        for coefficient in self._coefficients[:0:-1]:  # Clenshaw's recurrence
            value, above = coefficient[i] + 2 * x * value - above, value
        return np.asarray(self._coefficients[0][i] + x * value - above)

    def times(self, factor: float, stretch: float = 1.0) -> "Along":
        return Along(
            tuple(end * stretch for end in self.ends),
            tuple(tuple(c * factor for c in piece) for piece in self.series),
        )

    def integral(self) -> "Along":
        pieces, reached = list[Chebyshev](), 0.0
        for piece in self._pieces:
            found = piece.integ(lbnd=piece.domain[0], k=reached)
            reached = float(found.coef.sum())
            pieces.append(found)
        return Along.through(pieces)

    def first_not_positive(self) -> float | None:
        """Where the quantity is first zero, but for rounding, or negative."""
        nothing = _NOTHING * float(np.abs(self._coefficients).sum(axis=0).max())
        vanishes = None
        for piece in self._pieces:
            (begin, end), roots = piece.domain, piece.roots()
            real = roots.real[abs(roots.imag) < 1e-12 * (end - begin)]
            at = np.sort(np.concatenate([[begin], real[(real > begin) & (real < end)], [end]]))
            at = np.append(at, (at[1:] + at[:-1]) / 2)
            values = piece(at)
            if (values <= 0).any():
                return float(at[values <= nothing].min())
            if vanishes is None and (values <= nothing).any():
                vanishes = float(at[np.argmin(values)])
        return vanishes

    @property
    def _pieces(self) -> list[Chebyshev]:
        ends = pairwise(self.ends)
        return [Chebyshev(piece, end) for piece, end in zip(self.series, ends, strict=True)]

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


def values_at(quantity: float | Along, s: Floats) -> Floats:
    return quantity(s) if isinstance(quantity, Along) else np.full_like(s, quantity)


def rescaled(quantity: float | Along, factor: float, stretch: float = 1.0) -> float | Along:
    if isinstance(quantity, Along):
        return quantity.times(factor, stretch)
    return quantity * factor


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
    at = curve(middle[:, None] + half[:, None] * _CUBIC_NODES)
    cubics = np.linalg.solve(chebvander(_CUBIC_NODES, 3), at.T).T
    return Along(tuple(s.tolist()), tuple(_trimmed(cubic) for cubic in cubics))


def sampled(
    name: str, function: Callable[[Floats], Floats], length: float, breaks: Sequence[float] = ()
) -> Along:
    """The series of a function, on pieces halved until it is exact; at `breaks` it may be rough."""

    def on(begin: float, end: float) -> tuple[Chebyshev, bool]:
        values = _values(name, function, _nodes(begin, end))
        if values.min() == values.max():
            return Chebyshev(values[:1], (begin, end)), True
        series = _TO_SERIES @ values
        size = max(float(np.abs(values).max()), _LEAST * largest)
        exact = bool(np.abs(series[-_TAIL:]).max() <= _EXACT * size)
        return Chebyshev(series, (begin, end)), exact

    largest = float(np.abs(_values(name, function, np.linspace(0, length, 65))).max())
    largest = max(largest, _UNROUNDED)
    pieces = list[Chebyshev]()
    marks = np.unique([*np.linspace(0, length, _FIRST + 1), *breaks])
    ahead = list(pairwise(marks.tolist()))[::-1]
    for _ in range(_MOST_LOOKS):
        if not ahead:
            break
        begin, end = ahead.pop()
        found, exact = on(begin, end)
        if not exact and end - begin > length / 2**_HALVINGS:
            middle = (begin + end) / 2
            ahead += [(middle, end), (begin, middle)]
        elif end - begin > _NARROW * length:  # else a kink or a jump
            # The halves that led to a kink are one smooth piece.
            while (
                pieces and begin not in breaks and _NARROW * length < np.diff(pieces[-1].domain)[0]
            ):
                joined, smooth = on(pieces[-1].domain[0], end)
                # A jump next to an end lies beyond the outermost node: the parts have seen it.
                if not smooth or any(
                    _apart(joined, part) > _JOINED * largest for part in (pieces[-1], found)
                ):
                    break
                found, begin = joined, float(joined.domain[0])
                del pieces[-1]
            pieces.append(found)
    if ahead or len(pieces) > _MOST_PIECES + len(breaks):
        raise InputError(name, f"a function that is rough at s = {begin:g}", _SMOOTH, _OR_PAIRS)
    ends = [0.0, *(float(piece.domain[1]) for piece in pieces[:-1]), length]
    whole = Along(
        tuple(ends), tuple(_trimmed(np.asarray(piece.coef, dtype=float)) for piece in pieces)
    )
    places = np.linspace(0, length, _LOOKS)
    off = np.abs(_values(name, function, places) - whole(places)) > _ALIKE * largest
    off &= np.abs(places[:, None] - ends).min(axis=1) > _NARROW * length  # of a jump, either side
    if off.any():
        what = f"a function with a narrow dent at s = {places[np.argmax(off)]:g}"
        raise InputError(name, what, _SMOOTH, _OR_PAIRS)
    return whole


def _nodes(begin: float, end: float) -> Floats:
    return (begin + end) / 2 + (end - begin) / 2 * _NODES


def _apart(whole: Chebyshev, part: Chebyshev) -> float:
    """By how much a part differs from the series of the whole."""
    at = _nodes(*part.domain)
    return float(np.abs(whole(at) - part(at)).max())


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
    """A series without what is rounding at its end."""
    return tuple(trimcoef(series, _ROUNDING * np.abs(series).max()).tolist())
