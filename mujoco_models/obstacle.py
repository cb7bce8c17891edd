"""The object as MuJoCo knows it: a convex mesh, extruded along z from points of its contour.

MuJoCo's search for the nearest point of a mesh climbs from vertex to vertex, so its cost grows with
the mesh. The obstacle is therefore given as many meshes of one and the same polygon, each with all
of its vertices near one place (its window) and ever fewer farther away; only the mesh whose window
holds the contact takes part in collisions. A subset of the vertices of a convex polygon spans a
polygon inside it, so a mesh can only be too small, and only where nothing touches.
"""

from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np

from analytic.problem.arrays import Floats, Integers
from analytic.problem.case import Case

_FINE = 32  # vertices at full resolution on either side of a window's centre
_GRADED = 8  # vertices a level farther out; the spacing doubles from level to level
_BEYOND = 0.3  # L; how far the mesh goes on beyond the reach of the vibrissa
_HALF_DEPTH = 0.25  # L, of the extrusion: much more than a penetration, or depths come out wrong
MESH_PREFIX = "obstacle"

# Corners +x, -x, +y, -y, +z, -z; every face with its corners counterclockwise from outside.
_OCTAHEDRON = [
    [x, y, z] if (x + y + z) % 2 else [x, z, y] for x in (0, 1) for y in (2, 3) for z in (4, 5)
]


@dataclass(frozen=True)
class Obstacle:
    """A convex polygon's lower side, and the meshes that stand for it.

    Where the contour goes on beyond the reach of the vibrissa, so does the polygon, along its
    tangent: a tip that presses on the very end must not be pushed out through the top.

    Parameters
    ----------
    vertices : array, shape (n, 2)
        From left to right, in units of the vibrissa's length.
    """

    vertices: Floats

    @classmethod
    def of(cls, case: Case, points: int) -> "Obstacle":
        """The part of the case's object that the vibrissa can reach, with `points` vertices."""
        last, first = case.reach
        body = case.profile.scaled(1 / case.beam.length)
        inscribed = body.outline(last, first, points)
        ends = case.centreline.at(np.array([last, first]))
        cut = ends.eta > 1 - 1e-9  # by the reach of the tip; else the object ends there itself
        heading = np.column_stack([np.cos(ends.alpha), np.sin(ends.alpha)])
        beyond = inscribed[[0, -1]] + _BEYOND * heading * [[-1], [1]]
        return cls(np.concatenate([beyond[:1][cut[:1]], inscribed, beyond[1:][cut[1:]]]))

    @cached_property
    def facet_angles(self) -> Floats:
        """Slope angle of each facet, shape (n - 1,), ascending [rad]."""
        run, rise = np.diff(self.vertices, axis=0).T
        angles: Floats = np.arctan2(rise, run)
        return angles

    @cached_property
    def curvature(self) -> Floats:
        """Mean curvature near each vertex, shape (n,) [1/L]."""
        length = np.hypot(*np.diff(self.vertices, axis=0).T)
        inner = 2 * np.diff(self.facet_angles) / (length[1:] + length[:-1])
        return np.concatenate([inner[:1], inner, inner[-1:]])

    @property
    def normal_error(self) -> float:
        """Largest angle between a facet's normal and the smooth contour's [rad]."""
        return float(np.diff(self.facet_angles).max()) / 2

    @property
    def chord_error(self) -> float:
        """Largest distance of a facet from the smooth contour that its ends lie on [L]."""
        length = np.hypot(*np.diff(self.vertices, axis=0).T)
        turn = np.diff(self.facet_angles)
        return float((np.minimum(length[1:], length[:-1]) * turn).max()) / 8

    @cached_property
    def centres(self) -> Integers:
        """Vertices at which the windows are centred; neighbouring windows overlap by half."""
        n = len(self.vertices)
        return np.append(np.arange(0, n - 1, _FINE), n - 1)

    def nearest_vertex(self, slope: Floats) -> Integers:
        """Vertices at which the contour has these slope angles."""
        return np.searchsorted(self.facet_angles, slope)

    def faces(self, slope: Floats) -> bool:
        """Whether contacts with these slope angles are with the contour, not with its far side."""
        slack = 2 * self.normal_error + 1e-9
        return bool(
            ((slope > self.facet_angles[0] - slack) & (slope < self.facet_angles[-1] + slack)).all()
        )

    def near(self, points: Floats, distance: float) -> Integers:
        """Which of the points, shape (n, 2), may be nearer to the contour than `distance`.

        The distance from the line of any one facet is not more than that from the polygon. The
        facet above a point gives a bound, and the one that is nearest by that a better one.
        """
        left, right = self.vertices[[0, -1], 0]
        found = np.flatnonzero((points[:, 0] > left - distance) & (points[:, 0] < right + distance))
        foot = points[found, 0]
        for _ in range(2):
            bound, slope = self._below(points[found], foot)
            close = bound < distance
            found, foot = found[close], (points[found, 0] - bound * np.sin(slope))[close]
        return found

    def _below(self, points: Floats, x: Floats) -> tuple[Floats, Floats]:
        """How far the points are below the lines of the facets at `x`, and the facets' slopes."""
        facet = np.clip(np.searchsorted(self.vertices[:, 0], x) - 1, 0, len(self.facet_angles) - 1)
        slope = self.facet_angles[facet]
        offset = points - self.vertices[facet]
        return offset[:, 0] * np.sin(slope) - offset[:, 1] * np.cos(slope), slope

    def clearance(self, point: Floats) -> tuple[float, int]:
        """Distance of a point from the polygon, negative inside, and the vertex it is at."""
        offset = point - self.vertices[:-1]
        distance = offset[:, 0] * np.sin(self.facet_angles) - offset[:, 1] * np.cos(
            self.facet_angles
        )
        facet = int(np.argmax(distance))
        return float(distance[facet]), facet

    def window_of(self, vertex: float) -> int:
        """The window whose centre is nearest to a vertex."""
        return int(np.argmin(np.abs(self.centres - vertex)))

    def is_inside(self, window: int, vertices: Integers) -> bool:
        """Whether `window` has all of the contour around these vertices."""
        return bool((np.abs(vertices - self.centres[window]) <= _FINE - 2).all())

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add one mesh geom a window to the world body, named `MESH_PREFIX` and its number."""
        for i, centre in enumerate(self.centres):
            mesh = spec.add_mesh(name=f"{MESH_PREFIX}{i}")
            mesh.uservert, mesh.userface = self._prism(int(centre))
            spec.worldbody.add_geom(
                name=mesh.name,
                type=mujoco.mjtGeom.mjGEOM_MESH,
                meshname=mesh.name,
                contype=1,
                conaffinity=0,
                condim=1,
            )

    def _kept(self, centre: int) -> Integers:
        n = len(self.vertices)
        kept = {0, n - 1, *range(max(0, centre - _FINE), min(n, centre + _FINE + 1))}
        for side in (-1, 1):
            at, stride = centre + side * _FINE, 2
            while 0 <= at < n:
                level = at + side * stride * np.arange(1, _GRADED + 1)
                kept.update(int(j) for j in level if 0 <= j < n)
                at, stride = int(level[-1]), 2 * stride
        return np.array(sorted(kept))

    def _prism(self, centre: int) -> tuple[Floats, Integers]:
        """Vertices and faces of one window's mesh.

        Vertices are stored in single precision relative to the centroid of the *faces*, while
        collisions use the hull of all vertices. So the only faces are those of a speck just inside
        the obstacle at the window's centre: rounding there is 1e-9 instead of 1e-7. The speck is an
        octahedron whose axes of inertia are those of the world, so that both ends of the prism
        round alike and its sides stay flat.
        """
        polygon = self.vertices[self._kept(centre)]
        prism = np.concatenate(
            [
                np.column_stack([polygon, np.full(len(polygon), z)])
                for z in (-_HALF_DEPTH, _HALF_DEPTH)
            ]
        )
        here = self.vertices[centre]
        inward = 1e-2 * (self.vertices.mean(axis=0) - here)
        corners = 1e-4 * np.kron(np.diag([1, 2, 3]), [[1], [-1]])
        speck = np.append(here + inward, 0) + corners
        faces = len(prism) + np.array(_OCTAHEDRON, dtype=np.int32)
        return np.concatenate([prism, speck]).ravel(), faces.ravel()
