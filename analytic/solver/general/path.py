"""The equilibria of the general vibrissa from first contact to where it lets go, as cells.

Neither the contour parameter nor the foot position grows steadily along their curve: a vibrissa
that is curved towards the object is straightened first, and its tip climbs. So it is followed by
its own length.
"""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.contour import Contour
from analytic.solver.general.curve import Curve, Point, turning
from analytic.solver.general.rest import Touch
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
    columns = list(zip(*_with_folds(curve, points), strict=True))[:4]
    return Path(*(np.array(values) for values in columns), complete)


def _ended(points: list[Point], reach: tuple[float, float]) -> bool:
    """Whether the vibrissa has let go, is out of reach, or buckled after it lost its hold."""
    if len(points) == 1:
        return False
    here = points[-1]
    return here.z[1] == 0 or here.z[0] in reach or (here.beyond and here.rate > 0)


def _with_folds(curve: Curve, points: list[Point]) -> list[Point]:
    found = points[:1]
    for begin, end in zip(points[:-1], points[1:], strict=True):
        if begin.rate < 0 < end.rate and np.any(begin.z != end.z):
            fold = curve.fold(begin, end)
            if fold is not None:
                found.append(fold)
        found.append(end)
    return found
