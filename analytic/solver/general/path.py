"""The equilibria of the general vibrissa from first contact to where it lets go, as cells.

Neither the contour parameter nor the foot position grows steadily along their curve: a vibrissa
that is curved towards the object is straightened first, and its tip climbs. So it is followed by
its own length.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.contour import Contour
from analytic.problem.rest import Touch
from analytic.solver.general.curve import Curve, Point, turning
from analytic.solver.general.states import Vibrissa

_STEP = 0.02  # of the curve's length, at first
_LARGEST = 0.5
_SMALLEST = 1e-7
_TURN = 0.2  # rad; of the curve's direction between neighbours
_MOST = 4000  # points


class Path(NamedTuple):
    """Equilibria in sweep order; a cell lies between two neighbours and is smooth.

    ``z`` has shape (n, 3): contour parameter, normal force, excess; ``direction`` is its derivative
    by the curve's length, ``foot_x`` the foot position [L] and ``rate`` its derivative, shape (n,).
    ``complete`` is false if the curve was lost before its end.
    """

    z: Floats
    direction: Floats
    foot_x: Floats
    rate: Floats
    complete: bool

    @property
    def tangent(self) -> Booleans:
        """Whether each cell is in Phase B, shape (n - 1,)."""
        return self.z[:-1, 2] < 0

    @property
    def snap_off(self) -> int:
        """Which point has the least foot position: from there the vibrissa lets go."""
        return int(np.argmin(self.foot_x))

    def events(self) -> dict[str, int | None]:
        """What happens on the way to the snap-off, and at which point; None where it does not.

        Returns
        -------
        dict
            The first contact, the first start and the last end of Phase B, the contact nearest to
            the clamp in Phase B, and the snap-off, of a curve that is complete.
        """
        excess = self.z[: self.snap_off + 1, 2]
        inside = excess < 0
        change = np.flatnonzero(inside[1:] != inside[:-1]) + 1
        into_b, into_a = change[inside[change]].tolist(), change[~inside[change]].tolist()
        return {
            "first_contact": 0,
            "phase_b_start": 0 if inside[0] else next(iter(into_b), None),
            "phase_b_end": into_a[-1] if into_a and not inside[-1] else None,
            "contact_length_minimum": int(np.argmin(excess)) if inside.any() else None,
            "snap_off": self.snap_off if self.complete else None,
        }

    def cells(self, foot_x: Floats) -> Integers:
        """The cell that holds the state at each foot position.

        Parameters
        ----------
        foot_x : array, shape (n,)
            Between first contact and snap-off [L].

        Returns
        -------
        array of int, shape (n,)
            Of the first cell whose end lies at or left of the foot position: a sweep comes by the
            points at which the foot position falls below all before.
        """
        least = np.minimum.accumulate(self.foot_x)
        end = np.searchsorted(-least, -foot_x, side="left")
        return np.clip(end, 1, len(least) - 1) - 1


def follow(
    centreline: Contour, vibrissa: Vibrissa, touch: Touch, reach: tuple[float, float]
) -> Path:
    """Follow the equilibria from first contact to where force or reach end.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    vibrissa : Vibrissa
        Its numbers.
    touch : Touch
        The first contact.
    reach : tuple of float
        Contour parameters of the last point within reach and of the uppermost on the right.

    Returns
    -------
    Path
        At least two points.
    """
    curve = Curve(centreline, vibrissa, reach, centreline.breaks())
    points = [curve.start(touch.t, touch.excess)]
    length, bend = _STEP, np.zeros(3)
    while len(points) < _MOST and length > _SMALLEST and not _ended(points, reach):
        here = points[-1]
        ahead = curve.advance(here, length, bend)
        turn = turning(here, ahead[0]) if ahead else np.inf
        if turn > 2 * _TURN:
            length /= 2
            continue
        points.extend(ahead)
        bend = np.zeros(3)
        if len(ahead) == 1:
            bend = (ahead[0].direction - here.direction) / length
            length = min(_LARGEST, length * min(2.0, max(0.5, _TURN / max(turn, 1e-3))))
    complete = _ended(points, reach)
    points = _with_turns(curve, points)
    return Path(
        np.array([point.z for point in points]),
        np.array([point.direction for point in points]),
        np.array([point.foot_x for point in points]),
        np.array([point.rate for point in points]),
        complete,
    )


def _ended(points: list[Point], reach: tuple[float, float]) -> bool:
    """Whether the vibrissa has let go, is out of reach, or buckled after it lost its hold."""
    if len(points) == 1:
        return False
    here = points[-1]
    return here.z[1] == 0 or here.z[0] in reach or (here.beyond and here.rate > 0)


def _with_turns(curve: Curve, points: list[Point]) -> list[Point]:
    """The points, and those between where foot position or contact's arc length are least."""
    for rate in (_foot_rate, _excess_rate):
        found = points[:1]
        for begin, end in pairwise(points):
            if rate(begin) < 0 < rate(end) and np.any(begin.z != end.z):
                least = curve.turn(begin, end, rate)
                if least is not None:
                    found.append(least)
            found.append(end)
        points = found
    return points


def _foot_rate(point: Point) -> float:
    return point.rate


def _excess_rate(point: Point) -> float:
    return float(point.direction[2]) if point.z[2] < 0 else 0.0
