"""The superellipse |x/a|^n + |y/b|^n = 1 by a parameter in which its flat sides are long."""

from dataclasses import dataclass, replace

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.contours.contour import Contour, ContourPoint


@dataclass(frozen=True, eq=False)
class Superellipse(Contour):
    """The lower half of a superellipse with its axes along x and y, or its parallel curve.

    With k = max(n - 1, 1) and j = k/(n - 1) is tan(alpha) = b/a tan(t)^k, and a point is a
    tan(t)^j / (1 + tan(t)^(j n))^(1/n) beside the centre. By its slope angle the flat sides of
    n > 2 would be next to nothing: a curve that is followed along them would be lost.
    """

    across: float  # semi-axes a and b [length]
    upward: float
    x: float  # of the centre [length]
    y: float
    exponent: float  # n
    distance: float = 0.0  # of the parallel curve [length]
    label: str = "superellipse"

    @property
    def t_range(self) -> tuple[float, float]:
        """Without what is upright but for rounding, as a polygon is without its upright sides."""
        end = float(self.parameter(np.array(np.pi / 2)))
        return -end, end

    @property
    def _steepness(self) -> float:
        """K."""
        return max(self.exponent - 1, 1.0)

    def at(self, t: Floats) -> ContourPoint:
        t = np.asarray(t, dtype=float)
        n, k = self.exponent, self._steepness
        j = k / (n - 1)
        sine, cosine = np.abs(np.sin(t)), np.abs(np.cos(t))
        up, along = self.upward * sine**k, self.across * cosine**k
        root = np.hypot(up, along)
        total = sine ** (j * n) + cosine ** (j * n)
        size, flat = total ** (-1 / n), (sine * cosine) ** (k - 1)
        turning = k * self.across * self.upward * flat / root**2
        stretch = j * (sine * cosine) ** (j - 1) * root * size / total
        alpha = np.sign(t) * np.arctan2(up, along)
        xi = self.x + np.sign(t) * self.across * sine**j * size
        eta = self.y - self.upward * cosine**j * size
        return ContourPoint(
            alpha,
            xi + self.distance * np.sin(alpha),
            eta - self.distance * np.cos(alpha),
            turning,
            stretch + self.distance * turning,
        )

    def parameter(self, alpha: Floats) -> Floats:
        alpha, root = np.asarray(alpha, dtype=float), 1 / self._steepness
        up = np.abs(self.across * np.sin(alpha)) ** root
        along = (self.upward * np.maximum(np.cos(alpha), 0.0)) ** root
        return np.asarray(np.sign(alpha) * np.arctan2(up, along))

    def breaks(self) -> Floats:
        return np.empty(0)

    def outline(self, begin: float, end: float, points: int) -> Floats:
        return np.column_stack(self.place(np.linspace(begin, end, points)))

    def offset(self, radius: float) -> "Superellipse":
        return replace(self, distance=self.distance + radius)

    def scaled(self, factor: float) -> "Superellipse":
        names = "across", "upward", "x", "y", "distance"
        return replace(self, **{name: factor * getattr(self, name) for name in names})

    def mirrored(self) -> "Superellipse":
        return replace(self, x=-self.x)

    def raised(self, height: float) -> "Superellipse":
        return replace(self, y=self.y + height)
