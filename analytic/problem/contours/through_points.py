"""A smooth convex contour through given points, made of circular arcs."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.contours.profile import Profile
from analytic.problem.errors import InputError
from analytic.problem.numbers import points_of


class _Arcs(NamedTuple):
    """Circular arcs that share their tangents where they meet; arrays of n arcs."""

    begin: Floats  # slope angle at which each arc begins, ascending [rad]
    centre_x: Floats
    centre_y: Floats
    radius: Floats

    def xi(self, alpha: Floats) -> Floats:
        i = self.on(alpha)
        return self.centre_x[i] + self.radius[i] * np.sin(alpha)

    def eta(self, alpha: Floats) -> Floats:
        i = self.on(alpha)
        return self.centre_y[i] - self.radius[i] * np.cos(alpha)

    def radius_at(self, alpha: Floats) -> Floats:
        return self.radius[self.on(alpha)]

    def on(self, alpha: Floats) -> Integers:
        last = len(self.radius) - 1
        return np.clip(np.searchsorted(self.begin, alpha, side="right") - 1, 0, last)


def through_points(points: ArrayLike, label: str = "curve through points") -> Profile:
    """The contour of two circular arcs between each point and the next (a biarc), C1 and convex.

    The tangent at a point is that of the circle through it and its two neighbours, which always
    lies between the two chords; the arcs meet where the slope is that of the chord, which keeps
    both radii positive. Exact for points on a circle; else the curve is off by the third power of
    the points' spacing.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        At least 3 points of the lower side of a strictly convex body, from left to right or from
        right to left [length].
    label : str
        What reports call the contour.

    Returns
    -------
    Profile
        From the tangent at the leftmost to that at the rightmost point.

    Raises
    ------
    InputError
        If there are fewer than 3 points, one is not finite or not to the right of the one before,
        or the slope of the chords does not grow from left to right.
    """
    at = points_of("point", points)
    if at[0, 0] > at[-1, 0]:
        at = at[::-1]
    run, rise = np.diff(at, axis=0).T
    if not (run > 0).all():
        i = int(np.argmin(run > 0)) + 1
        allowed, remedy = "to the right of the one before", "give the lower side only, in order"
        raise InputError(f"point {i} from the left", at[i], allowed, remedy)
    chord = np.arctan2(rise, run)
    turn = np.diff(chord)
    if not (turn > 0).all():
        i = int(np.argmin(turn > 0)) + 1
        where = f"point {i} from the left, ({at[i, 0]:.6g}, {at[i, 1]:.6g}),"
        what, remedy = (
            f"a turn of {np.rad2deg(turn[i - 1]):.4g} deg",
            "a polygon has straight parts",
        )
        raise InputError(where, what, "a turn to the left, as on a strictly convex body", remedy)
    arcs = _biarcs(at, chord, _tangents(np.hypot(run, rise), chord))
    end = float(arcs.begin[-1]), float(arcs.begin[0])
    return Profile(
        xi=arcs.xi,
        eta=arcs.eta,
        alpha_range=(end[1], end[0]),
        radius_of_curvature=arcs.radius_at,
        kinks=tuple(arcs.begin[1:-1].tolist()),
        label=label,
    )


def _tangents(length: Floats, chord: Floats) -> Floats:
    """Slope angles at the points, of the circles through each and its neighbours."""
    turn = np.diff(chord)
    third = np.sqrt(
        length[1:] ** 2 + length[:-1] ** 2 + 2 * length[1:] * length[:-1] * np.cos(turn)
    )
    inner = chord[:-1] + np.arcsin(np.sin(turn) * length[:-1] / third)
    first = 2 * chord[0] - inner[0]
    last = 2 * chord[-1] - inner[-1]
    return np.concatenate([[max(first, -np.pi / 2)], inner, [min(last, np.pi / 2)]])


def _biarcs(at: Floats, chord: Floats, tangent: Floats) -> _Arcs:
    begin, joint, end = tangent[:-1], chord, tangent[1:]
    length = np.hypot(*np.diff(at, axis=0).T)
    # The chord is the sum of the arcs' own chords, whose slopes lie half-way between their ends.
    first, second = (joint - begin) / 2, (end - joint) / 2
    one = length * np.sin(second) / np.sin(first + second) / (2 * np.sin(first))
    other = length * np.sin(first) / np.sin(first + second) / (2 * np.sin(second))
    angles = np.column_stack([begin, joint]).ravel()
    radius = np.column_stack([one, other]).ravel()
    reached = np.array([_turn(one, begin, joint)]).reshape(2, -1).T + at[:-1]
    start = np.column_stack([at[:-1], reached]).reshape(-1, 2)
    return _Arcs(
        np.append(angles, end[-1]),
        start[:, 0] - radius * np.sin(angles),
        start[:, 1] + radius * np.cos(angles),
        radius,
    )


def _turn(radius: Floats, begin: Floats, end: Floats) -> tuple[Floats, Floats]:
    return radius * (np.sin(end) - np.sin(begin)), radius * (np.cos(begin) - np.cos(end))
