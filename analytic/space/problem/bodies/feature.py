"""A face, an edge or a corner of a mesh that goes on without end: what a contact stays on."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from analytic.problem.arrays import Floats
from analytic.space.problem.bodies.body import Body, Spot, flat_spot

_TURNS = 0.5  # of the largest turning: a principal value is that or zero


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
