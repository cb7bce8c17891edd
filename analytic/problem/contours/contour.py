"""What the solver needs of a convex contour: points by a parameter along it."""

from abc import ABC, abstractmethod
from typing import NamedTuple

from analytic.problem.arrays import Floats
from analytic.problem.contours.solid import ConvexMesh


class ContourPoint(NamedTuple):
    """Points of a contour and how fast they move along it; every field an array of one shape.

    ``alpha`` [rad], ``xi`` and ``eta`` [length] at contour parameter t; ``turning`` is
    d(alpha)/dt and ``stretch`` is d(arc length)/dt, so d(xi)/dt = stretch cos(alpha) and
    d(eta)/dt = stretch sin(alpha).
    """

    alpha: Floats
    xi: Floats
    eta: Floats
    turning: Floats
    stretch: Floats


class Contour(ABC):
    """The lower side of a convex body, from slope angle -pi/2 on the left to pi/2 on the right.

    A parameter t runs along it; the slope angle never decreases with t. Where the contour is
    smooth both the point and the angle move; along a straight part only the point does; round a
    corner, as at the ends of an open contour, only the angle does.
    """

    label: str
    solid: ConvexMesh | None = None
    """The mesh that the contour is a section of, if it is one."""

    @property
    @abstractmethod
    def t_range(self) -> tuple[float, float]:
        """Parameters of the left (alpha = -pi/2) and right (alpha = pi/2) end."""

    @abstractmethod
    def at(self, t: Floats) -> ContourPoint:
        """Points at contour parameters `t`, shape (n,) [length, rad]."""

    @abstractmethod
    def parameter(self, alpha: Floats) -> Floats:
        """Contour parameter of the first point, from the left, with slope angle `alpha` [rad]."""

    @abstractmethod
    def breaks(self) -> Floats:
        """Parameters, ascending, at which the contour is not smooth."""

    @abstractmethod
    def outline(self, begin: float, end: float, points: int) -> Floats:
        """Vertices, shape (n, 2), of a polygon inscribed between parameters `begin` and `end`.

        Exact where the contour is a polygon itself, else `points` in number [length].
        """

    @abstractmethod
    def offset(self, radius: float) -> "Contour":
        """The parallel curve at distance `radius` below: what a centreline at that distance feels.

        Exact for a round tip and for tangential contact, since both touch at the same alpha.
        """

    @abstractmethod
    def scaled(self, factor: float) -> "Contour":
        """The contour enlarged by `factor` about the origin, to change its unit of length."""

    @abstractmethod
    def mirrored(self) -> "Contour":
        """The mirror image: x becomes -x, alpha becomes -alpha, left and right change places."""
