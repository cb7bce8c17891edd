"""The object's contour as lines that have it on one side: how far out a point is, and whereto."""

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.case import Case

_POINTS = 2000  # of the contour; a distance is then right to 1e-6 of its radius of curvature


class Surface:
    """What the centreline of a case's vibrissa feels, dimensionless: L = 1."""

    def __init__(self, case: Case) -> None:
        last, first = case.reach
        line = case.centreline
        marks = np.concatenate([[last], line.breaks(), [first]])
        middles = (marks[1:] + marks[:-1]) / 2  # one on every edge
        middles = middles[(middles > last) & (middles < first)]
        on = line.at(np.concatenate([np.linspace(last, first, _POINTS), middles]))
        self._normals = np.column_stack([np.sin(on.alpha), -np.cos(on.alpha)])
        self._heights = on.xi * self._normals[:, 0] + on.eta * self._normals[:, 1]

    def outward(self, points: Floats) -> tuple[Floats, Floats]:
        """How far out points are, negative inside, shape (n,), and the normals there, (n, 2)."""
        out = points @ self._normals.T - self._heights
        return out.max(axis=1), self._normals[out.argmax(axis=1)]
