"""Where the foot goes, and how the clamp leans."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError
from analytic.problem.numbers import finite, floats, whole
from analytic.space.problem.numbers import direction

_MOST_STATIONS = 100_000
_MOST_POINTS = 10_000


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
