"""The object as a convex mesh, extruded along z from points of its contour.

MuJoCo's search for the nearest point of a mesh climbs from vertex to vertex, so its cost grows with
the mesh. The obstacle is therefore a mesh of the polygon with all of its vertices near one place
(its window) and ever fewer farther away, whose vertices are written anew as the window follows the
contact. A subset of the vertices of a convex polygon spans a polygon inside it, so the mesh can
only be too small, and only where nothing touches.
"""

import math
from functools import cached_property

import mujoco
import numpy as np

from analytic.numerics.arrays import Complexes, Floats, Integers
from analytic.problem.case import Case
from analytic.problem.contours.polygon import Polygon
from mujoco_models.obstacles.corners import SHARP, Corners, ends_sharp, upright
from mujoco_models.obstacles.faceted import Faceted, own_ends, touchable
from mujoco_models.obstacles.protocol import GEOM
from mujoco_models.obstacles.window import HALF_DEPTH, add_room, write_prism
from mujoco_models.settings import Settings

_FINE = 32  # vertices at full resolution on either side of a window's centre, at least
_SPAN = 4.0  # radii of the vibrissa that they span: a link may rest on several beads
_TURN = 0.1  # rad; or by which they turn, if that is less: farther away single precision shows
_GRADED = 8  # vertices a level farther out; the spacing doubles from level to level
_OF_TURN = 0.01  # of a facet's turn from the last one; so much may its vertices' rounding turn it
_FINEST = 1e-12  # L
_EITHER_SIDE = 2  # facets; the nearest one is found to within the next one
_FEET = 8  # two are usual, five at the tip of a needle
_PLACES = 33  # of a vibrissa, where its curvature is looked at
_BEYOND = 0.3  # L; how far the mesh goes on beyond the reach of the vibrissa


class Prism(Faceted):
    """The meshes that stand for an extruded polygon."""

    upright = True

    def __init__(
        self,
        vertices: Floats,
        slopes: tuple[float, float],
        exact: bool,
        radius: float,
        corner_radius: float,
        ends: tuple[bool, bool] = (False, False),
        apart: float = 0.0,
    ) -> None:
        super().__init__(vertices, slopes)
        self._apart = apart  # how far apart two contacts may be that a window has to have [L]
        self._exact, self._corner_radius = exact, corner_radius
        self._radius, self._ends = radius, ends

    @classmethod
    def of(cls, case: Case, points: int, corner_radius: float = Settings.corner_radius) -> "Prism":
        """The part of the case's object that the vibrissa can reach.

        It has `points` vertices if the contour is curved, or else those of the contour. Where the
        contour goes on beyond reach, so does the polygon, along its tangent: a tip that presses on
        the very end must not be pushed out through the top.
        """
        last, first = case.reach
        body = case.profile.scaled(1 / case.beam.length)
        inscribed = body.outline(last, first, points)
        ends = case.centreline.at(np.array([last, first]))
        cut = ~np.array(own_ends(case))
        heading = np.column_stack([np.cos(ends.alpha), np.sin(ends.alpha)])
        beyond = inscribed[[0, -1]] + _BEYOND * heading * [[-1], [1]]
        vertices = np.concatenate([beyond[:1][cut[:1]], inscribed, beyond[1:][cut[1:]]])
        exact = isinstance(body, Polygon)
        # A smooth contour that ends upright has no corner there, though its facets have.
        sharp = ~cut & (exact | (np.pi / 2 - np.abs(ends.alpha) > SHARP))
        left, right = sharp.tolist()
        # A vibrissa that is curved towards the object may touch it in two places.
        curved = case.beam.curvature_at(np.linspace(0, case.beam.length, _PLACES)).max() > 0
        apart = 1.0 if curved else 0.0
        return cls(
            vertices, touchable(case), exact, case.radius, corner_radius, (left, right), apart
        )

    @property
    def label(self) -> str:
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
    def section(self) -> Floats:
        return self._gridded

    @property
    def windows(self) -> int:  # type: ignore[override]
        return len(self._centres)

    @cached_property
    def corners(self) -> Corners:
        """Those of a polygon; one that is inscribed in a smooth contour has its ends at most."""
        edges = upright(self.vertices, HALF_DEPTH)
        corners = Corners.of(self.vertices, edges, self._corner_radius, self._ends)
        if self._exact or self._ends_sharp:
            return corners
        return Corners.none()

    @property
    def _ends_sharp(self) -> bool:
        """Whether the object ends within reach, with a corner."""
        return ends_sharp(self.vertices, self._ends)

    def gap(self, window: int, points: Floats) -> tuple[Floats, Floats] | None:
        """From the facets about the nearest one; sharp corners are touched by links, not points.

        Points of the plane are complex numbers here: an arrow over a facet's is where it is along
        the facet and, if that is the imaginary part, how far inside.
        """
        if len(self.corners):
            return None
        origin, count = self._origin(window), len(self._about) - 1
        last = len(self.facet_angles) - count
        from_origin = np.subtract(points, origin, order="C").view(complex).T
        number = np.arange(len(points))
        facet: Integers = self._inner.searchsorted(points[:, 0])
        for step in range(_FEET + 1):
            far = step == _FEET
            facet = self._at_vertex(points) if far else self._under(points, facet)
            first = np.minimum(np.maximum(facet - _EITHER_SIDE, 0), last)
            ends = self._in_plane.take(first + self._about) - complex(*origin)
            if not far:  # or what rounds vertices is more than what one is nearer than the next
                ends = ends.astype(np.complex64).astype(complex)  # as in MuJoCo
            begin, run = ends[:-1], ends[1:] - ends[:-1]
            off = from_origin - begin
            share = off / run
            off -= np.minimum(np.maximum(share.real, 0.0), 1.0) * run
            distances = np.abs(off)
            best = distances.argmin(axis=0)
            aside = (best == 0) & (first != 0) | (best == count - 1) & (first != last)
            if not np.count_nonzero(aside):
                break
        here = best * len(points) + number  # of the arrays, taken as flat
        inside = share.imag.take(here) > 0
        if np.count_nonzero(aside & ~inside):
            return None  # a nearer facet may be farther along
        distance = distances.take(here)
        distance[inside] *= -1
        normal: Floats = (off.take(here) / distance).view(float).reshape(-1, 2)
        return distance, normal

    def from_tangents(self, points: Floats, slope: Floats) -> Floats:
        facet = np.minimum(self.vertex(slope), len(self.facet_angles) - 1)
        return self._below(points, facet)[0]

    def _under(self, points: Floats, facet: Integers) -> Integers:
        """The facets nearest to the points, shape (n,), by those that are near to them.

        A step of Newton's method on the foot of the perpendicular; where the contour is sharper
        than a point is far away, a step would go past it without the contour's turn.
        """
        bound, aside = self._below(points, facet)
        begin, curvature = self._begins.take(facet, axis=1)
        across = points[:, 0] - bound * aside - begin
        foot = begin + across / (1 + curvature * np.maximum(bound, 0))
        return np.asarray(self._inner.searchsorted(foot))

    def _at_vertex(self, points: Floats) -> Integers:
        """The facets that begin at the vertices nearest to the points, shape (n,).

        Far off the tip of a needle, steps from foot to foot go past it again and again.
        """
        apart = np.ascontiguousarray(points).view(complex) - self._in_plane
        facet: Integers = np.abs(apart).argmin(axis=1)
        return np.minimum(facet, len(self.facet_angles) - 1)

    def place(self, slope: Floats) -> Floats:
        return self.vertex(slope).astype(float)

    def window_of(self, place: float) -> int:
        return int((np.abs(self._centres - place) / self._fine_there).argmin())

    def is_inside(self, window: int, places: Floats) -> bool:
        """Whether `window` has all of the contour around these vertices."""
        centre = self._centres[window]
        return bool((np.abs(places - centre) <= self._fine[centre] - 2).all())

    def hull(self, window: int) -> Floats:
        """The points of a window in double precision, one end of the extrusion after the other."""
        kept = self._kept(int(self._centres[window]))
        polygon = np.vstack([self.vertices[kept], self.outline[-1]])
        ends = [np.insert(polygon, 2, z, axis=1) for z in (-HALF_DEPTH, HALF_DEPTH)]
        return np.concatenate(ends)

    def _polygon(self, centre: int) -> Floats:
        """A window's vertices, from its centre on: there MuJoCo's search for the nearest begins."""
        kept = self._kept(centre)
        begin, roof = kept.searchsorted(centre), [len(self.vertices)]
        return np.asarray(self._closed[np.concatenate([kept[begin:], roof, kept[:begin]])])

    def add_to(self, spec: mujoco.MjSpec, name: str = GEOM) -> None:
        """One mesh with room for any window; what it is, `show` says."""
        add_room(spec, 2 * self._count, name)

    def show(self, model: mujoco.MjModel, geom: int, window: int) -> None:
        polygon = self._polygon(int(self._centres[window]))
        write_prism(model, geom, polygon, self._origin(window))

    def _origin(self, window: int) -> Floats:
        """From where MuJoCo's vertices are counted: not an end, which is far beyond reach."""
        near = min(max(int(self._centres[window]), 1), len(self.vertices) - 2)
        return np.asarray(self._gridded[near])

    @cached_property
    def _centres(self) -> Integers:
        """Vertices at which the windows are centred; neighbouring windows overlap by half."""
        passed = np.cumsum(1 / self._fine)
        return np.append(np.searchsorted(passed, np.arange(passed[-1])), len(passed) - 1)

    @cached_property
    def _fine_there(self) -> Integers:
        """How many at the centre of each window, see `_fine`, shape (n_windows,)."""
        return self._fine[self._centres]

    @cached_property
    def _fine(self) -> Integers:
        """How many vertices a window has at full resolution on either side of each, shape (n,)."""
        s, number = self._arc_length, np.arange(len(self.vertices))
        with np.errstate(divide="ignore"):
            span = np.minimum(_SPAN * self._radius, _TURN / self._curvature)
        span = np.maximum(span, self._apart)
        ahead, behind = np.searchsorted(s, s + span) - number, number - np.searchsorted(s, s - span)
        return np.asarray(np.maximum(_FINE, np.maximum(ahead, behind)))

    @cached_property
    def _gridded(self) -> Floats:
        """The vertices on a grid so coarse that single precision does not round them in a window.

        Or else neighbouring windows would have facets that are not quite parallel, and a state at
        rest would depend on the way to it. No grid is so coarse that it shows beside the facets.
        """
        s, number = self._arc_length, np.arange(len(self.vertices))
        length = np.diff(s)
        ahead = s[np.minimum(number + self._fine, number[-1])] - s
        behind = s - s[np.maximum(number - self._fine, 0)]
        exact = np.maximum(ahead, behind) * 2.0**-24
        turn = np.pad(np.diff(self.facet_angles), 1, mode="edge" if len(length) > 1 else "constant")
        shorter = np.minimum(np.append(length, length[-1]), np.insert(length, 0, length[0]))
        shows = np.maximum(_OF_TURN * turn * shorter, _FINEST)
        grid = 2.0 ** np.ceil(np.log2(np.minimum(exact, shows)))[:, None]
        return np.asarray(np.round(self.vertices / grid) * grid)

    @cached_property
    def _closed(self) -> Floats:
        """Those, and the vertex above them, shape (n + 1, 2)."""
        return np.vstack([self._gridded, self.outline[-1]])

    @cached_property
    def _in_plane(self) -> Complexes:
        """Those as complex numbers, shape (n,)."""
        return np.ascontiguousarray(self._gridded).view(complex)[:, 0]

    @cached_property
    def _about(self) -> Integers:
        """The ends of the facets about one, counted from the begin of the first of them."""
        return np.arange(min(2 * _EITHER_SIDE + 2, len(self.vertices)))[:, None]

    @cached_property
    def _begins(self) -> Floats:
        """Where each facet begins along x, and the contour's curvature there, shape (2, n - 1)."""
        return np.array([self.vertices[:-1, 0], self._curvature[:-1]])

    @cached_property
    def _arc_length(self) -> Floats:
        """Of the vertices, shape (n,) [L]."""
        length = np.hypot(*np.diff(self.vertices, axis=0).T)
        if not self._exact:
            length[[0, -1]] = length[[1, -2]]  # those beyond reach are longer, and never touched
        return np.insert(np.cumsum(length), 0, 0.0)

    @cached_property
    def _count(self) -> int:
        widest = int(self._fine[self._centres].max())
        return min(len(self.vertices), len(self._offsets(widest)) + 2) + 1

    def _offsets(self, fine: int) -> Integers:
        """Which vertices a window keeps of a long polygon, counted from its centre."""
        out = fine + self._graded
        return np.concatenate([-out[::-1], np.arange(-fine, fine + 1), out])

    @cached_property
    def _graded(self) -> Integers:
        """Where those beyond full resolution are, counted from where that ends."""
        levels = math.ceil(math.log2(1 + len(self.vertices) / _GRADED))
        return np.cumsum(np.repeat(2 ** np.arange(1, levels + 1), _GRADED))

    def _kept(self, centre: int) -> Integers:
        """Those within the polygon, its ends, and the next ones until there are enough."""
        n, count = len(self.vertices), self._count - 1
        kept = centre + self._offsets(int(self._fine[centre]))
        kept = kept[(kept > 0) & (kept < n - 1)]
        missing = count - 2 - len(kept)
        if missing:
            begin = max(1, centre - count)
            near = np.ones(min(n - 1, centre + count + 1) - begin, dtype=bool)
            near[kept[(kept >= begin) & (kept < begin + len(near))] - begin] = False
            spare = begin + np.flatnonzero(near)
            nearest = np.argsort(np.abs(spare - centre), kind="stable")[:missing]
            kept = np.sort(np.append(kept, spare[nearest]))
        return np.concatenate([[0], kept, [n - 1]])
