"""What an obstacle of flat facets knows of its section by the plane of the sweep: a polygon."""

from functools import cached_property

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.case import Case
from mujoco_models.obstacles.protocol import GEOM, TOP, Obstacle, add_collider

# Corners +x, -x, +y, -y, +z, -z; every face has one of each pair, counterclockwise from outside.
_OCTAHEDRON = (
    (0, 2, 4),
    (0, 5, 2),
    (0, 4, 3),
    (0, 3, 5),
    (1, 4, 2),
    (1, 2, 5),
    (1, 3, 4),
    (1, 5, 3),
)
_FLAT = 1e-5  # rad; MuJoCo's normal of a facet is as good as that
_SINGLE = 2.0**-23  # L; or as rounding of its ends in single precision lets it be
_POINTED = 1e12  # 1/L
_RAMP = 0.05  # of a facet's turn, on either side of its slope angle
# rad; a facet that straddles the end of reach is touched at its own slope, a corner there with a
# bead that may be half a spacing off. A polygon of few corners turns by far more at one of them.
_SLACK = 0.35
# rad; a side that turns less is one facet, whose ends are corners. What touches one there leans by
# as much as soft contacts give way, and single precision turns the facet's own normal by 6e-9.
_STRAIGHT = 1e-6


class Faceted(Obstacle):
    """An obstacle of flat facets."""

    faceted = True

    def __init__(self, vertices: Floats, slopes: tuple[float, float]) -> None:
        self.vertices = vertices
        self._slopes = slopes

    @cached_property
    def facet_angles(self) -> Floats:
        """Slope angle of each facet, shape (n - 1,), ascending [rad]."""
        run, rise = np.diff(self.vertices, axis=0).T
        angles: Floats = np.arctan2(rise, run)
        return angles

    @property
    def largest_curvature(self) -> float:
        """The largest mean curvature [1/L]."""
        return float(self._curvature.max())

    @property
    def lowest(self) -> tuple[float, float]:
        x, y = self.vertices[np.argmin(self.vertices[:, 1])]
        return float(x), float(y)

    def curvature(self, slope: Floats) -> Floats:
        """Mean curvature near the vertex at which the slope angle is passed.

        If it has sharp corners, 0 on a facet and next to infinite round a corner.
        """
        if len(self.corners) == 0:
            return np.asarray(self._curvature[self.vertex(slope)])
        apart = np.abs(np.subtract.outer(slope, self.facet_angles))
        return np.where((apart < self._flat).any(axis=1), 0.0, _POINTED)

    @cached_property
    def _flat(self) -> Floats:
        """How far MuJoCo's normal of each facet may be off, shape (n - 1,) [rad]."""
        return np.asarray(np.maximum(_FLAT, _SINGLE / np.hypot(*np.diff(self.vertices, axis=0).T)))

    def vertex(self, slope: Floats) -> Integers:
        return np.searchsorted(self.facet_angles, slope)

    def support(self, slope: float) -> Floats:
        """The vertex at which the slope angle is passed, or a place on the facet that has it.

        A line that lies on a facet may be loaded anywhere there: from one vertex to the next the
        place passes within a small part of the facets' turn, not at once.
        """
        return np.array([np.interp(slope, self._passed, places) for places in self._places])

    @cached_property
    def _passed(self) -> Floats:
        """Slope angles of the ends of `_places`, shape (2 n - 2,), ascending [rad]."""
        turn = np.pad(np.diff(self.facet_angles), 1, constant_values=np.inf)
        ramp = _RAMP * np.minimum(np.minimum(turn[1:], turn[:-1]), 1.0)
        return np.column_stack([self.facet_angles - ramp, self.facet_angles + ramp]).ravel()

    @cached_property
    def _places(self) -> Floats:
        """The ends of each facet, shape (2, 2 n - 2) [L]."""
        return np.repeat(self.vertices, 2, axis=0)[1:-1].T.copy()

    def faces(self, slope: Floats) -> bool:
        """Whether these slope angles are among those at which it can be touched."""
        low, high = self._faced
        return bool(((slope > low) & (slope < high)).all())

    @cached_property
    def _faced(self) -> tuple[float, float]:
        """The least and the largest slope angle at which a bead or a facet is touched [rad]."""
        turn = float(np.diff(self.facet_angles).max(initial=0.0))
        slack = _SLACK if turn < _STRAIGHT else min(turn, _SLACK)
        return self._slopes[0] - slack, self._slopes[1] + slack

    def near(self, points: Floats, distance: float | Floats) -> Integers:
        """Which of the points, shape (n, 2), may be nearer to the contour than `distance`.

        The distance from the line of any one facet is not more than that from the polygon. The
        facet above a point gives a bound, and the one that is nearest by that a better one.
        """
        x = points[:, 0]
        bound, aside = self._below(points, self._inner.searchsorted(x))
        found = np.flatnonzero(bound < distance)
        if len(found) == 0:
            return found
        points, foot = points[found], (x - bound * aside)[found]
        distance = distance[found] if isinstance(distance, np.ndarray) else distance
        close = self._below(points, self._inner.searchsorted(foot))[0] < distance
        left, right = self._sides
        x = points[:, 0]
        return found[close & (x > left - distance) & (x < right + distance)]

    def _below(self, points: Floats, facet: Integers) -> tuple[Floats, Floats]:
        """How far the points are below the lines of facets, and the sines of their slopes."""
        sin, cos, height = self._lines.take(facet, axis=1)
        return sin * points[:, 0] - cos * points[:, 1] + height, sin

    @cached_property
    def _lines(self) -> Floats:
        """Of each facet sine and cosine of its slope, and how far its line is above the origin."""
        sin, cos = np.sin(self.facet_angles), np.cos(self.facet_angles)
        x, y = self.vertices[:-1].T
        return np.array([sin, cos, y * cos - x * sin])

    @cached_property
    def _sides(self) -> tuple[float, float]:
        """Where its ends are [L]."""
        return float(self.vertices[0, 0]), float(self.vertices[-1, 0])

    @cached_property
    def _inner(self) -> Floats:
        """Where the facets but the first begin, shape (n - 2,) [L]."""
        return self.vertices[1:-1, 0].copy()

    def clearance(self, point: Floats) -> tuple[float, float]:
        """From the nearest edge of the lower side, or of the roof over it; the facet's number."""
        x, last = self.vertices[:, 0], len(self.facet_angles) - 1
        below = min(max(int(np.searchsorted(x, point[0])) - 1, 0), last)
        bound = np.hypot(*(point - self.vertices[below]))  # nothing farther away matters
        first = min(max(int(np.searchsorted(x, point[0] - bound)) - 1, 0), last)
        end = max(int(np.searchsorted(x, point[0] + bound, "right")), first + 1)
        edges = np.append(np.arange(first, min(end, last + 1)), [last + 1, last + 2])
        begin = self.outline[edges]
        edge, offset = np.take(self.outline, edges + 1, axis=0, mode="wrap") - begin, point - begin
        along = np.clip((edge * offset).sum(axis=1) / (edge**2).sum(axis=1), 0, 1)
        distance = np.hypot(*(offset - along[:, None] * edge).T)
        nearest = int(np.argmin(distance))
        inside = (edge[:, 0] * offset[:, 1] > edge[:, 1] * offset[:, 0]).all()
        facet = min(int(edges[nearest]), last)
        return float(-distance[nearest] if inside else distance[nearest]), float(facet)

    def is_cut(self, polyline: Floats) -> bool:
        """By Cyrus and Beck's clipping of each piece by the outline's half-planes."""
        edge = np.roll(self.outline, -1, axis=0) - self.outline
        inward = np.column_stack([-edge[:, 1], edge[:, 0]]) / np.hypot(*edge.T)[:, None]
        depth = ((polyline[:, None] - self.outline) * inward).sum(axis=2)
        begin, end = depth[:-1], depth[1:]
        outside = ((begin <= 0) & (end <= 0)).any(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = begin / (begin - end)
        enters = np.where((begin < 0) & (end > 0), crossing, 0.0).max(axis=1)
        leaves = np.where((begin > 0) & (end < 0), crossing, 1.0).min(axis=1)
        return bool(((enters < leaves) & ~outside).any())

    @cached_property
    def outline(self) -> Floats:
        """The lower side, closed by a vertex above its middle: a flat underside is a solid too."""
        left, right = self.vertices[[0, -1]]
        width = right[0] - left[0]
        roof = [left[0] + width / 2, max(left[1], right[1]) + width / 2]
        return np.vstack([self.vertices, roof])

    @cached_property
    def _curvature(self) -> Floats:
        """Mean curvature near each vertex, shape (n,) [1/L]; the ends are like their neighbours."""
        length = np.hypot(*np.diff(self.vertices, axis=0).T)
        inner = 2 * np.diff(self.facet_angles) / (length[1:] + length[:-1])
        return np.pad(inner, 1, mode="edge") if len(inner) else np.zeros(2)


def touchable(case: Case) -> tuple[float, float]:
    """Slope angles between which a case's object can be touched.

    An end of the object is a corner; there a bead may touch a little above the widest place.
    """
    low, high = case.centreline.at(np.array(case.reach)).alpha
    upright = np.pi / 2 - 1e-9
    return (-TOP if low < -upright else float(low), TOP if high > upright else float(high))


def own_ends(case: Case) -> tuple[bool, bool]:
    """Whether the object itself ends on the left and on the right, not the reach of the tip."""
    last, first = case.reach
    left, right = (case.centreline.at(np.array([last, first])).eta <= 1 - 1e-9).tolist()
    return left, right


def add_hull(
    spec: mujoco.MjSpec, vertices: Floats, inner: Floats, size: float, name: str = GEOM
) -> None:
    """Add the hull of points to the world body.

    MuJoCo stores vertices in single precision relative to the centroid of the *faces*, while
    collisions use the hull of all vertices. So the only faces are those of a speck round a place
    near the contact: there, rounding is 1e-9 instead of 1e-7. The speck is an octahedron whose axes
    of inertia are those of the world, so that both ends of a prism round alike and its sides stay
    flat.
    """
    speck = inner + size * np.kron(np.diag([1, 2, 3]), [[1], [-1]])
    faces = len(vertices) + np.array(_OCTAHEDRON, dtype=np.int32)
    mesh = spec.add_mesh(name=name)
    mesh.uservert, mesh.userface = np.concatenate([vertices, speck]).ravel(), faces.ravel()
    add_collider(spec, mujoco.mjtGeom.mjGEOM_MESH, name, meshname=name)
