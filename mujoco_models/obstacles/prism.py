"""The object as a convex mesh, extruded along z from points of its contour.

MuJoCo's search for the nearest point of a mesh climbs from vertex to vertex, so its cost grows with
the mesh. The obstacle is therefore given as many meshes of one and the same polygon, each with all
of its vertices near one place (its window) and ever fewer farther away; only the mesh whose window
holds the contact takes part in collisions. A subset of the vertices of a convex polygon spans a
polygon inside it, so a mesh can only be too small, and only where nothing touches.
"""

import math
from functools import cached_property

import mujoco
import numpy as np

from analytic.problem.arrays import Floats, Integers
from analytic.problem.case import Case
from analytic.problem.contours.polygon import Polygon
from mujoco_models.obstacles.corners import Corners, upright
from mujoco_models.obstacles.faceted import Faceted, add_hull, touchable
from mujoco_models.settings import Settings

_FINE = 32  # vertices at full resolution on either side of a window's centre, at least
_SPAN = 4.0  # radii of the vibrissa that they span, at least: a link may rest on several beads
_GRADED = 8  # vertices a level farther out; the spacing doubles from level to level
_BEYOND = 0.3  # L; how far the mesh goes on beyond the reach of the vibrissa
# L, of the extrusion: more than the vibrissa's length, so that it cannot leave over the prism's
# ends, and much more than a penetration, or depths come out wrong.
_HALF_DEPTH = 1.5
_SPECK = 1e-4  # L
_SPECK_REACH = 3.5  # of its smallest half axis; a little more than its longest one
_INWARD = (1e-2, 3e-2, 1e-1, 3e-1, 1.0)  # of the way to the middle


class Prism(Faceted):
    """The meshes that stand for an extruded polygon.

    Parameters
    ----------
    vertices, slopes
        See `Faceted`.
    exact : bool
        Whether the contour is that polygon; else the polygon is inscribed in it.
    radius : float
        Of the vibrissa [L].
    corner_radius : float
        Of the edges at sharp corners [L].
    """

    upright = True

    def __init__(
        self,
        vertices: Floats,
        slopes: tuple[float, float],
        exact: bool,
        radius: float,
        corner_radius: float,
    ) -> None:
        super().__init__(vertices, slopes)
        self._exact, self._corner_radius = exact, corner_radius
        facet = float(np.median(np.hypot(*np.diff(vertices, axis=0).T)))
        self._fine = max(_FINE, math.ceil(_SPAN * radius / facet))

    @classmethod
    def of(cls, case: Case, points: int, corner_radius: float = Settings.corner_radius) -> "Prism":
        """The part of the case's object that the vibrissa can reach.

        It has `points` vertices if the contour is curved, or else those of the contour. Where the
        contour goes on beyond reach, so does the polygon, along its tangent: a tip that presses on
        the very end must not be pushed out through the top.

        Parameters
        ----------
        case : Case
            Of a sweep to the left.
        points : int
            Of the polygon, if the contour is curved.
        corner_radius : float
            Of the edges at sharp corners [L].

        Returns
        -------
        Prism
        """
        last, first = case.reach
        body = case.profile.scaled(1 / case.beam.length)
        inscribed = body.outline(last, first, points)
        ends = case.centreline.at(np.array([last, first]))
        cut = ends.eta > 1 - 1e-9  # by the reach of the tip; else the object ends there itself
        heading = np.column_stack([np.cos(ends.alpha), np.sin(ends.alpha)])
        beyond = inscribed[[0, -1]] + _BEYOND * heading * [[-1], [1]]
        vertices = np.concatenate([beyond[:1][cut[:1]], inscribed, beyond[1:][cut[1:]]])
        exact = isinstance(body, Polygon)
        return cls(vertices, touchable(case), exact, case.radius, corner_radius)

    @property
    def label(self) -> str:
        """How fine the polygon is."""
        return (
            f"{len(self.vertices)} contour points, chord error {self.chord_error:.1e} L, "
            f"normal error {self.normal_error:.1e} rad"
        )

    @property
    def normal_error(self) -> float:
        """Largest angle between a facet's normal and the contour's [rad]."""
        return 0.0 if self._exact else float(np.diff(self.facet_angles).max()) / 2

    @property
    def chord_error(self) -> float:
        """Largest distance of a facet from the contour that its ends lie on [L]."""
        if self._exact:
            return 0.0
        length = np.hypot(*np.diff(self.vertices, axis=0).T)
        turn = np.diff(self.facet_angles)
        return float((np.minimum(length[1:], length[:-1]) * turn).max()) / 8

    @property
    def geoms(self) -> int:  # type: ignore[override]
        """One a window."""
        return len(self._centres)

    @cached_property
    def corners(self) -> Corners:
        """Those of a polygon; one that is inscribed in a smooth contour has none of its own."""
        if not self._exact:
            return Corners.none()
        edges = upright(self.vertices, _HALF_DEPTH)
        return Corners.of(self.vertices, edges, self._corner_radius)

    def place(self, slope: Floats) -> Floats:
        """The number of the vertex at which the slope angle is passed."""
        return self.vertex(slope).astype(float)

    def window_of(self, place: float) -> int:
        """The window whose centre is nearest to a vertex."""
        return int(np.argmin(np.abs(self._centres - place)))

    def is_inside(self, window: int, places: Floats) -> bool:
        """Whether `window` has all of the contour around these vertices."""
        return bool((np.abs(places - self._centres[window]) <= self._fine - 2).all())

    def hull(self, window: int) -> Floats:
        """The points of a window's convex mesh, the two ends of the extrusion one after the other.

        Parameters
        ----------
        window : int
            Its number.

        Returns
        -------
        array, shape (n, 3)
            Positions [L].
        """
        polygon = self._polygon(window)
        ends = [np.insert(polygon, 2, z, axis=1) for z in (-_HALF_DEPTH, _HALF_DEPTH)]
        return np.concatenate(ends)

    def _polygon(self, window: int) -> Floats:
        centre = int(self._centres[window])
        return np.vstack([self.vertices[self._kept(centre)], self.outline[-1]])

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """Add one mesh a window."""
        for i, centre in enumerate(self._centres.tolist()):
            polygon = self._polygon(i)
            inner, depth = self._inside(self.vertices[centre], polygon)
            size = min(_SPECK, depth / _SPECK_REACH)
            add_hull(spec, i, self.hull(i), np.append(inner, 0), size)

    def _inside(self, here: Floats, polygon: Floats) -> tuple[Floats, float]:
        """A place near a vertex, and how deep it is in a window's polygon.

        It is deep enough for the speck of a hull, which must not stick out, if there is such a
        place in the polygon.
        """
        middles = (self.vertices, self.outline, polygon)  # a flat underside has only the roof above
        deepest = here, 0.0
        for share in _INWARD:
            for middle in middles:
                inner = here + share * (middle.mean(axis=0) - here)
                depth = _depth(inner, polygon)
                if depth >= _SPECK_REACH * _SPECK:
                    return inner, depth
                deepest = max(deepest, (inner, depth), key=lambda found: found[1])
        return deepest

    @cached_property
    def _centres(self) -> Integers:
        """Vertices at which the windows are centred; neighbouring windows overlap by half."""
        n = len(self.vertices)
        return np.append(np.arange(0, n - 1, self._fine), n - 1)

    def _kept(self, centre: int) -> Integers:
        n = len(self.vertices)
        kept = {0, n - 1, *range(max(0, centre - self._fine), min(n, centre + self._fine + 1))}
        for side in (-1, 1):
            at, stride = centre + side * self._fine, 2
            while 0 <= at < n:
                level = at + side * stride * np.arange(1, _GRADED + 1)
                kept.update(int(j) for j in level if 0 <= j < n)
                at, stride = int(level[-1]), 2 * stride
        return np.array(sorted(kept))


def _depth(point: Floats, polygon: Floats) -> float:
    """How deep a point is in a convex polygon, shape (n, 2), counterclockwise; < 0 outside."""
    edge = np.roll(polygon, -1, axis=0) - polygon
    offset = point - polygon
    return float(
        ((edge[:, 0] * offset[:, 1] - edge[:, 1] * offset[:, 0]) / np.hypot(*edge.T)).min()
    )
