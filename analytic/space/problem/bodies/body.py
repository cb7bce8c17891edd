"""What the solver needs of a convex body in space: the nearest point of it to any point outside."""

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.numerics.vectors import cross

_AXES = np.eye(3)

_TURNS = 0.5  # of the largest turning: a principal value is that or zero


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
            A point outside [length]. Of one inside the distance has the right sign, and falls along
            the normal inwards.
        apart : float
            Distance of the parallel surface that `Spot.turning` belongs to, positive [length].

        Returns
        -------
        Spot
            Point, normal, distance and how the normal turns.
        """

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
    """Below a point on a plane."""
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


@dataclass(frozen=True, eq=False)
class Feature(Body):
    """A plane, a line or a point."""

    point: Floats  # shape (3,); One of it [length]
    # Shape (k, 3); Directions in which normals turn, of length 1: none of a face, one of an edge,
    # all three of a corner.
    free: Floats
    normal: Floats  # shape (3,); Outward, of a face
    label: str = "feature"

    @classmethod
    def of(cls, spot: Spot) -> "Feature":
        """The one that a spot of a mesh is on."""
        values, ways = np.linalg.eigh(spot.turning)
        turns = values > _TURNS * max(float(values[-1]), 1e-300)
        count = int(turns.sum())
        free = np.eye(3) if count == 2 else np.zeros((0, 3))
        if count == 1:  # the normals of an edge span the plane across it
            free = np.stack([ways[:, turns][:, 0], spot.normal])
        return cls(spot.point, free, spot.normal)

    @property
    def flat(self) -> bool:
        """Whether it is a face."""
        return not len(self.free)

    @property
    def basis(self) -> Floats:
        """Unit vectors that span its normals, across each other, shape (1 to 3, 3)."""
        return self.normal[None] if self.flat else self.free

    @cached_property
    def _span(self) -> Floats:
        """Projects on them, shape (3, 3)."""
        return np.asarray(self.free.T @ self.free)

    def nearest(self, x: Floats, apart: float) -> Spot:
        away = x - self.point
        if self.flat:
            return flat_spot(x, self.normal, float(away @ self.normal))
        across = self._span @ away
        distance = math.sqrt(across @ across)
        normal = across / max(distance, 1e-300)
        turning = (self._span - normal[:, None] * normal) / apart
        return Spot(x - across, normal, distance, turning)

    def scaled(self, factor: float) -> "Feature":
        return replace(self, point=factor * self.point)

    def patches(self, centre: Floats, reach: float) -> Floats:
        return np.zeros((0, 3, 3))
