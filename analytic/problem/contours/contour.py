"""What the solver needs of a convex contour: points by a parameter along it."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import NamedTuple

from analytic.numerics.arrays import Floats


@dataclass(frozen=True, eq=False)
class ConvexMesh:
    """The hull of points, cut by the plane of the sweep at z = 0."""

    vertices: Floats  # shape (n, 3); In the case's frame [length]
    # The largest z component of its unit normals along the lower side of the section: 0 where the
    # mesh is a prism there, or symmetric about the plane. Where it is not, the section is not what
    # a bead touches; see `gap`.
    tilt: float
    name: str  # of the file

    def gap(self, radius: float) -> float:
        """How much earlier a bead touches the body than it would touch the section's prism."""
        return radius * (1 / math.sqrt(max(1 - self.tilt**2, 1e-300)) - 1)

    def scaled(self, factor: float) -> "ConvexMesh":
        return replace(self, vertices=factor * self.vertices)

    def mirrored(self) -> "ConvexMesh":
        return replace(self, vertices=self.vertices * [-1, 1, 1])


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
        """Points of the contour.

        Parameters
        ----------
        t : array, any shape
            Contour parameters, within `t_range`.

        Returns
        -------
        ContourPoint
            Arrays of the shape of `t` [length, rad].
        """

    def place(self, t: Floats) -> tuple[Floats, Floats]:
        """Where points of the contour are, and nothing more of them.

        Parameters
        ----------
        t : array, shape (n,)
            Contour parameters, within `t_range`.

        Returns
        -------
        xi, eta : array, shape (n,)
            Coordinates [length], those that `at` has.
        """
        point = self.at(t)
        return point.xi, point.eta

    @abstractmethod
    def parameter(self, alpha: Floats) -> Floats:
        """Contour parameter of the first point, from the left, with a given slope angle.

        Parameters
        ----------
        alpha : array, any shape
            Slope angles from -pi/2 to pi/2 [rad].

        Returns
        -------
        array, shape of `alpha`
            Contour parameters.
        """

    @abstractmethod
    def breaks(self) -> Floats:
        """Where the contour is not smooth.

        Returns
        -------
        array, shape (n,)
            Contour parameters, ascending.
        """

    @abstractmethod
    def outline(self, begin: float, end: float, points: int) -> Floats:
        """A polygon inscribed in a part of the contour.

        Parameters
        ----------
        begin, end : float
            Contour parameters of the part's ends.
        points : int
            How many vertices; a contour that is a polygon itself has its own.

        Returns
        -------
        array, shape (n, 2)
            Its vertices [length].
        """

    @abstractmethod
    def offset(self, radius: float) -> "Contour":
        """The parallel curve at distance `radius` below: what a centreline at that distance feels.

        Exact for a round tip and for tangential contact, since both touch at the same alpha.

        Parameters
        ----------
        radius : float
            The distance [length].

        Returns
        -------
        Contour
            The parallel curve.
        """

    @abstractmethod
    def scaled(self, factor: float) -> "Contour":
        """The contour enlarged about the origin, to change its unit of length.

        Parameters
        ----------
        factor : float
            How many new units of length an old one has.

        Returns
        -------
        Contour
            In the new unit.
        """

    @abstractmethod
    def mirrored(self) -> "Contour":
        """The mirror image: x becomes -x, alpha becomes -alpha, left and right change places.

        Returns
        -------
        Contour
            The mirror image.
        """

    @abstractmethod
    def raised(self, height: float) -> "Contour":
        """The contour moved up, away from the foot's line.

        Parameters
        ----------
        height : float
            By how much [length].

        Returns
        -------
        Contour
            The same shape.
        """
