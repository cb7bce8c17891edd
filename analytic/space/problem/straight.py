"""The straight vibrissa among the bodies: where on its way it first touches. Geometry only."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from analytic.numerics.walk import first_clear, first_touch
from analytic.problem.arrays import Floats
from analytic.space.problem.bodies.body import Body, Spot
from analytic.space.problem.path import FootPath

_ANY = 1.0  # L; the parallel surface does not matter here
_UPRIGHT = 1e-12  # rad
_CLOSEST = 1e-13  # L, of the way
_EXACT = 1e-15  # L, of the way


class Gap(NamedTuple):
    """How near the straight vibrissa is to the body; lengths in L."""

    size: float  # between surface and surface; not positive where they meet
    arc_length: float  # where on the vibrissa they are nearest
    spot: Spot  # where on the body


def straight_gap(body: Body, foot: Floats, tangent: Floats, radius: float) -> Gap:
    """Distance between the body and the straight vibrissa of length 1: convex along it."""
    from scipy.optimize import brentq  # slow to load, and stating a case needs none of it

    def rise(s: float) -> float:
        spot = body.nearest(foot + s * tangent, _ANY)
        return float(spot.normal @ tangent) if spot.distance > 0 else 0.0

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
        """Which way the foot goes from there."""
        return np.asarray(self._slopes[self._leg(travel)])

    def _leg(self, travel: float) -> int:
        return min(int(self.marks.searchsorted(travel, "right")), len(self._slopes)) - 1

    def gap(self, travel: float) -> Gap:
        return straight_gap(self.body, self.foot(travel), self.path.clamp_tangent, self.radius)

    def lowest_contact(self, travel: float, arc_length: float) -> float:
        """Where the side begins to touch: along an upright face it bends about the lower end."""
        foot, tangent = self.foot(travel), self.path.clamp_tangent
        low, high = 0.0, arc_length
        while high - low > _CLOSEST:
            middle = (low + high) / 2
            if self.body.nearest(foot + middle * tangent, _ANY).normal @ tangent < -_UPRIGHT:
                low = middle
            else:
                high = middle
        return high

    def next_touch(self, begin: float) -> float | None:
        """Where the straight vibrissa touches, from where it is clear."""
        return first_touch(self._size, begin, self._corners_after(begin), _EXACT)

    def next_clear(self, begin: float) -> float | None:
        """Where the straight vibrissa is clear of the body again."""
        return first_clear(self._size, begin, self._corners_after(begin), _EXACT)

    def nearest(self) -> tuple[float, Gap]:
        """Where the straight vibrissa is nearest to the body."""
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
