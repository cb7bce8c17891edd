"""What the solver needs of a convex body in space: the nearest point of it to any point outside."""

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np

from analytic.numerics.vectors import cross
from analytic.problem.arrays import Floats

_AXES = np.eye(3)


class Spot(NamedTuple):
    """A point of a body's surface with one of its normals.

    On a face there is one normal, on an edge a fan of them, at a corner a cone. Point and normal
    together are a point of the parallel surface at a distance, which has no edges and no corners.
    """

    point: Floats
    """Shape (3,) [length]."""
    normal: Floats
    """Outward, of length 1, shape (3,)."""
    distance: float
    """Of the point that was asked for; zero or less if it lies inside or on the body [length]."""
    turning: Floats
    """How the normal turns as the point of the parallel surface moves: a symmetric tensor, shape
    (3, 3) [1/length]. Its principal values are 1/(rho + distance of the parallel surface) with the
    principal radii of curvature rho: zero on a face, the inverse distance at a corner."""


class Body(ABC):
    """A convex body, smooth or not, bounded or not."""

    label: str

    @property
    def smooth(self) -> bool:
        """Whether it has neither edges nor corners."""
        return True

    @abstractmethod
    def nearest(self, x: Floats, apart: float) -> Spot:
        """The surface's nearest point.

        Parameters
        ----------
        x : array, shape (3,)
            A point outside [length]; of one inside only the sign of the distance is right.
        apart : float
            Distance of the parallel surface that `Spot.turning` belongs to, positive [length].

        Returns
        -------
        Spot
            Point, normal, distance and how the normal turns.
        """

    def feature(self, spot: Spot) -> "Body":
        """What a contact stays on while nothing happens to it.

        Parameters
        ----------
        spot : Spot
            Of the body.

        Returns
        -------
        Body
            Of a mesh the face, the edge or the corner, as if it had no end; else the body.
        """
        return self

    @abstractmethod
    def scaled(self, factor: float) -> "Body":
        """The body enlarged about the origin, to change its unit of length.

        Parameters
        ----------
        factor : float
            How many new units of length an old one has.

        Returns
        -------
        Body
            In the new unit.
        """

    @abstractmethod
    def patches(self, centre: Floats, reach: float) -> Floats:
        """Polygons to draw the body with.

        Parameters
        ----------
        centre : array, shape (3,)
            Where the picture is of [length].
        reach : float
            How far unbounded bodies are drawn from there [length].

        Returns
        -------
        array, shape (n, k, 3)
            Polygons of k corners [length].
        """


def flat_spot(x: Floats, normal: Floats, height: float) -> Spot:
    """Below a point on a plane; without a normal, of a point that lies inside a body."""
    return Spot(x - height * normal, normal, height, np.zeros((3, 3)))


def grid_patches(x: Floats) -> Floats:
    """The cells of a grid of points."""
    cells = np.stack([x[:-1, :-1], x[1:, :-1], x[1:, 1:], x[:-1, 1:]], axis=2)
    return cells.reshape(-1, 4, 3)


def sphere_grid() -> Floats:
    """Unit vectors by longitude and latitude, shape (97, 49, 3)."""
    around, down = np.meshgrid(
        np.linspace(0, 2 * np.pi, 97), np.linspace(0, np.pi, 49), indexing="ij"
    )
    ring = np.sin(down)
    return np.stack([ring * np.cos(around), np.cos(down), ring * np.sin(around)], axis=-1)


def across(normal: Floats) -> Floats:
    """Two unit vectors that span the plane normal to a vector."""
    first = cross(_AXES[np.abs(normal).argmin(axis=-1)], normal)
    first /= np.sqrt((first * first).sum(axis=-1, keepdims=True))
    return np.concatenate([first[..., None, :], cross(normal, first)[..., None, :]], axis=-2)
