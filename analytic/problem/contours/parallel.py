"""The parallel curve of a contour: what a centreline feels that has a thickness."""

from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.numbers import positive


@dataclass(frozen=True)
class Parallel(Contour):
    """What lies at a distance below a contour whose parameter is its slope angle."""

    of: Contour  # the contour; it turns at the same rate everywhere, round its corners too
    radius: float  # the distance, positive [length]

    def __post_init__(self) -> None:
        positive("radius of the parallel curve", self.radius)

    @property
    def label(self) -> str:  # type: ignore[override]  # it is that of another one
        return self.of.label

    @property
    def t_range(self) -> tuple[float, float]:
        return self.of.t_range

    def at(self, t: Floats) -> ContourPoint:
        alpha, xi, eta, turning, stretch = self.of.at(t)
        radius = self.radius
        below, aside = radius * np.cos(alpha), radius * np.sin(alpha)
        return ContourPoint(alpha, xi + aside, eta - below, turning, stretch + radius)

    def place(self, t: Floats) -> tuple[Floats, Floats]:
        xi, eta = self.of.place(t)
        return xi + self.radius * np.sin(t), eta - self.radius * np.cos(t)

    def parameter(self, alpha: Floats) -> Floats:
        return alpha

    def breaks(self) -> Floats:
        return self.of.breaks()

    def outline(self, begin: float, end: float, points: int) -> Floats:
        """Vertices at equal steps of slope angle."""
        return np.column_stack(self.place(np.linspace(begin, end, points)))

    def offset(self, radius: float) -> Contour:
        return self if radius == 0 else Parallel(self, radius)

    def scaled(self, factor: float) -> Contour:
        return self if factor == 1 else Parallel(self.of.scaled(factor), self.radius * factor)

    def mirrored(self) -> Contour:
        return Parallel(self.of.mirrored(), self.radius)

    def raised(self, height: float) -> Contour:
        return Parallel(self.of.raised(height), self.radius)
