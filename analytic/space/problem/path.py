"""Where the foot goes, how the clamp leans, and where the straight vibrissa first touches."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Floats
from analytic.numerics.walk import first_clear, first_touch
from analytic.problem.errors import InputError
from analytic.problem.numbers import direction, finite, floats, whole
from analytic.space.problem.bodies.body import Body, Spot

_MOST_STATIONS = 100_000
_MOST_POINTS = 10_000

_ANY = 1.0  # L; the parallel surface does not matter here
_UPRIGHT = 1e-12  # rad
_CLOSEST = 1e-13  # L, of the way
_EXACT = 1e-15  # L, of the way


@dataclass(frozen=True, eq=False)
class FootPath:
    """A polyline in the base plane, stations at equal distances along it.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        Corners (x, z) of the way of the foot in the plane y = `height`, two for a straight line
        [length].
    height : float
        Of the base plane [length].
    tangent : array_like, shape (3,)
        Direction of the vibrissa at its clamp, of any length; it stays as it is along the way.
    stations : int
        Number of stations, from 2 to 100,000; the first and the last at the way's ends.

    Raises
    ------
    InputError
        If a number cannot be, or two corners that follow each other are the same.
    """

    points: ArrayLike
    height: float = 0.0
    tangent: ArrayLike = (0.0, 1.0, 0.0)
    stations: int = 200

    def __post_init__(self) -> None:
        allowed = f"2 to {_MOST_POINTS:,} points (x, z)"
        points = floats("path.points", self.points, (None, 2), allowed)
        if not 2 <= len(points) <= _MOST_POINTS:
            raise InputError("path.points", len(points), allowed, "as [[1, 0], [-1, 0.2]]")
        lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
        extent = float(np.ptp(points, axis=0).max())
        if not (lengths > 1e-9 * extent).all():
            i = int(np.argmin(lengths))
            allowed = "another place than the one before"
            raise InputError(f"path.points[{i + 1}]", points[i + 1], allowed, "drop it")
        stations = whole("path.stations", self.stations, 2, _MOST_STATIONS)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "height", finite("path.height", self.height))
        object.__setattr__(self, "tangent", direction("path.tangent", self.tangent))
        object.__setattr__(self, "stations", stations)

    @property
    def clamp_tangent(self) -> Floats:
        """Direction of the vibrissa at its clamp, of length 1, shape (3,)."""
        return np.asarray(self.tangent)

    @property
    def corners(self) -> Floats:
        """Corners of the way in space, shape (n, 3) [length]."""
        x, z = np.asarray(self.points).T
        return np.stack([x, np.full_like(x, self.height), z], axis=1)

    @property
    def marks(self) -> Floats:
        """How far along the way its corners are, shape (n,) [length]."""
        steps = np.linalg.norm(np.diff(self.corners, axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def travel(self) -> Floats:
        """How far along the way the stations are, shape (stations,) [length]."""
        return np.linspace(0.0, self.marks[-1], self.stations)

    def at(self, travel: Floats | float) -> Floats:
        """Foot positions.

        Parameters
        ----------
        travel : array or float, any shape
            Distances along the way [length].

        Returns
        -------
        array, shape (..., 3)
            [length]
        """
        corners, marks = self.corners, self.marks
        return np.stack([np.interp(travel, marks, column) for column in corners.T], axis=-1)


class Gap(NamedTuple):
    """How near the straight vibrissa is to the body; lengths in L."""

    size: float  # between surface and surface; not positive where they meet
    arc_length: float  # where on the vibrissa they are nearest
    spot: Spot  # where on the body


def straight_gap(body: Body, foot: Floats, tangent: Floats, radius: float) -> Gap:
    """Distance between the body and the straight vibrissa of length 1: convex along it."""
    from scipy.optimize import brentq  # slow to load, and stating a case needs none of it

    def rise(s: float) -> float:
        return float(body.nearest(foot + s * tangent, _ANY).normal @ tangent)

    ends = rise(0.0), rise(1.0)
    if ends[1] <= 0:
        s = 1.0
    elif ends[0] >= 0:
        s = 0.0
    else:
        s = float(brentq(rise, 0.0, 1.0, xtol=1e-15, rtol=9e-16))
    spot = body.nearest(foot + s * tangent, _ANY)
    return Gap(spot.distance - radius, s, spot)


class StraightVibrissa:
    """The straight vibrissa along a way of its foot, in units of its length."""

    def __init__(self, body: Body, path: FootPath, length: float, radius: float) -> None:
        self.body = body
        self.path = path
        self.length = length
        self.radius = radius / length
        self.marks = path.marks / length
        self._corners = path.corners / length
        self._slopes = np.diff(self._corners, axis=0) / np.diff(self.marks)[:, None]

    def foot(self, travel: float) -> Floats:
        travel = min(max(travel, 0.0), float(self.marks[-1]))
        leg = self._leg(travel)
        return np.asarray(self._corners[leg] + (travel - self.marks[leg]) * self._slopes[leg])

    def onward(self, travel: float) -> Floats:
        return np.asarray(self._slopes[self._leg(travel)])

    def _leg(self, travel: float) -> int:
        return min(int(self.marks.searchsorted(travel, "right")), len(self._slopes)) - 1

    def gap(self, travel: float) -> Gap:
        return straight_gap(self.body, self.foot(travel), self.path.clamp_tangent, self.radius)

    def lowest_contact(self, travel: float, arc_length: float) -> float:
        """Where the side begins to touch: along an upright face it bends about the lower end."""
        foot, tangent = self.foot(travel), self.path.clamp_tangent

        def below(place: float) -> bool:
            normal = self.body.nearest(foot + place * tangent, _ANY).normal
            return float(normal @ tangent) < -_UPRIGHT

        low, high = 0.0, arc_length
        while high - low > _CLOSEST:
            middle = (low + high) / 2
            low, high = (middle, high) if below(middle) else (low, middle)
        # Where a smooth body's side becomes flat it is curved below, where the contact goes.
        return low if self.body.smooth and not below(arc_length) else high

    def next_touch(self, begin: float) -> float | None:
        return first_touch(self._size, begin, self._corners_after(begin), _EXACT)

    def next_clear(self, begin: float) -> float | None:
        return first_clear(self._size, begin, self._corners_after(begin), _EXACT)

    def nearest(self) -> tuple[float, Gap]:
        at = self._least(self._size)
        return at, self.gap(at)

    def meets_clamp(self) -> float | None:
        """Where the clamp itself would run into the body."""

        def clear(travel: float) -> float:
            return self.body.nearest(self.foot(travel), _ANY).distance - self.radius

        deepest = self._least(clear)
        return deepest if clear(deepest) <= 0 else None

    def _least(self, distance: Callable[[float], float]) -> float:
        """Where a distance is least, at the way's corners and between."""
        from scipy.optimize import minimize_scalar

        legs = zip(self.marks[:-1], self.marks[1:], strict=True)
        between = [float(minimize_scalar(distance, bounds=b, method="bounded").x) for b in legs]
        return min([*map(float, self.marks), *between], key=distance)

    def _size(self, travel: float) -> float:
        return self.gap(travel).size

    def _corners_after(self, begin: float) -> list[float]:
        """Up to each of them the way is straight, so that the distance is convex."""
        return [float(mark) for mark in self.marks if mark > begin]
