"""The lower side of a convex polygon: what the section of a mesh is, with nothing left out."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Floats
from analytic.problem.contours.contour import Contour, ContourPoint, ConvexMesh
from analytic.problem.errors import InputError
from analytic.problem.numbers import points_of, positive

_STRAIGHT = 1e-12  # rad; vertices that turn less are dropped: they are on an edge


@dataclass(frozen=True, eq=False)
class Polygon(Contour):
    """The lower chain of a convex polygon, or its parallel curve."""

    # Shape (n, 2); From the leftmost to the rightmost vertex along the lower side [length].
    vertices: Floats
    distance: float = 0.0  # of the parallel curve from the polygon [length]
    label: str = "polygon"  # what reports call the contour
    solid: ConvexMesh | None = None  # what it is the section of

    @property
    def t_range(self) -> tuple[float, float]:
        """From the left end, turned to the vertical, to the right one."""
        return 0.0, float(self._starts[-1])

    def at(self, t: Floats) -> ContourPoint:
        t = np.asarray(t, dtype=float)
        piece = np.clip(
            np.searchsorted(self._starts, t, side="right") - 1, 0, len(self._starts) - 2
        )
        along = t - self._starts[piece]
        on_edge = piece % 2 == 1  # pieces take turns: vertex, edge, vertex, ...
        vertex = piece // 2
        before, after = self._angles[vertex], self._angles[vertex + 1]
        alpha = np.where(on_edge, after, np.minimum(before + along, after))
        shift = np.where(on_edge, along, 0.0)
        xi = self.vertices[vertex, 0] + shift * np.cos(alpha) + self.distance * np.sin(alpha)
        eta = self.vertices[vertex, 1] + shift * np.sin(alpha) - self.distance * np.cos(alpha)
        turning = np.where(on_edge, 0.0, 1.0)
        return ContourPoint(alpha, xi, eta, turning, np.where(on_edge, 1.0, self.distance))

    def parameter(self, alpha: Floats) -> Floats:
        """Parameter of the leftmost point with slope angle `alpha`; on an edge, its left end."""
        vertex = np.searchsorted(self._angles[1:-1], alpha)
        return np.asarray(self._starts[2 * vertex] + alpha - self._angles[vertex])

    def breaks(self) -> Floats:
        return self._starts[1:-1]

    def outline(self, begin: float, end: float, points: int) -> Floats:
        """The polygon's own vertices between the two parameters, and the points there."""
        ends = replace(self, distance=0.0).at(np.array([begin, end]))
        inside = (self._starts[::2] > begin) & (self._starts[1::2] < end)
        chain = np.vstack(
            [[ends.xi[0], ends.eta[0]], self.vertices[inside], [ends.xi[1], ends.eta[1]]]
        )
        apart = np.append(True, np.hypot(*np.diff(chain, axis=0).T) > 0)
        return np.asarray(chain[apart])

    def offset(self, radius: float) -> "Polygon":
        """The parallel curve: the edges moved out, joined by arcs about the vertices."""
        if radius != 0:
            positive("radius of the parallel curve", radius)
        return replace(self, distance=self.distance + radius, solid=None)

    def scaled(self, factor: float) -> "Polygon":
        positive("profile.scale", factor)
        return replace(
            self,
            vertices=factor * self.vertices,
            distance=factor * self.distance,
            solid=self.solid and self.solid.scaled(factor),
        )

    def raised(self, height: float) -> "Polygon":
        """The polygon moved up by `height`; no longer the section of its mesh file."""
        return replace(self, vertices=self.vertices + np.array([0.0, height]), solid=None)

    def mirrored(self) -> "Polygon":
        vertices = self.vertices[::-1] * [-1, 1]
        return replace(
            self,
            vertices=vertices,
            label=f"{self.label}, mirrored",
            solid=self.solid and self.solid.mirrored(),
        )

    @cached_property
    def _angles(self) -> Floats:
        """Slope angles of the edges, between those of the upright sides."""
        run, rise = np.diff(self.vertices, axis=0).T
        return np.concatenate([[-np.pi / 2], np.arctan2(rise, run), [np.pi / 2]])

    @cached_property
    def _starts(self) -> Floats:
        """Parameter at which each piece starts, and at which the last one ends."""
        lengths = np.empty(2 * len(self.vertices) - 1)
        lengths[0::2] = np.diff(self._angles)
        lengths[1::2] = np.hypot(*np.diff(self.vertices, axis=0).T)
        return np.concatenate([[0.0], np.cumsum(lengths)])


def polygon(points: ArrayLike, label: str = "polygon") -> Polygon:
    """The lower side of a convex polygon, exact to the last vertex.

    Parameters
    ----------
    points : array_like, shape (n, 2)
        The vertices in order, either way round [length]. Only the lower side, from the leftmost to
        the rightmost vertex, can be touched.
    label : str
        What reports call the contour.

    Returns
    -------
    Polygon
        Its lower side.

    Raises
    ------
    InputError
        If there are fewer than 3 points, one is not finite, two neighbours coincide, all lie on a
        line, the contour intersects itself, or a vertex is a dent.
    """
    vertices = points_of("polygon vertex", points)
    if (vertices[0] == vertices[-1]).all():
        vertices = vertices[:-1]  # closed explicitly
    edges = np.roll(vertices, -1, axis=0) - vertices
    short = (edges == 0).all(axis=1)
    if short.any():
        i = int(np.argmax(short))
        raise InputError(f"polygon vertex {i}", vertices[i], "apart from the next one", "drop one")
    edges = edges / np.abs(edges).max()  # so that no product overflows or vanishes
    before = np.roll(edges, 1, axis=0)
    cross = before[:, 0] * edges[:, 1] - before[:, 1] * edges[:, 0]
    turn = np.arctan2(cross, (before * edges).sum(axis=1))
    if turn.sum() < -np.pi:  # a multiple of 2 pi; of a figure of eight it is zero
        return polygon(vertices[::-1], label)
    around = float(np.rad2deg(turn.sum()))
    in_order = "it crosses itself: give the vertices in order"
    if np.abs(turn).max() > np.pi - 1e-9:
        where, remedy = _vertex(vertices, np.argmax(np.abs(turn))), "order them, or make it thicker"
        allowed = "a corner that is not all but flat"
        raise InputError(where, "folded back on itself", allowed, remedy)
    if around < 180:
        raise InputError("polygon", f"turning by {around:.4g} deg", "convex, 360 deg", in_order)
    if turn.min() < -_STRAIGHT:
        dent = f"a dent of {np.rad2deg(-turn.min()):.4g} deg"
        where = _vertex(vertices, np.argmin(turn))
        raise InputError(where, dent, "convex", "drop it or take the convex hull")
    if around > 540:
        raise InputError("polygon", f"winding {around / 360:.0f} times", "simple", in_order)
    return Polygon(_lower_side(vertices[turn > _STRAIGHT]), label=label)


def _vertex(vertices: Floats, i: np.intp) -> str:
    return f"polygon vertex {i}, ({vertices[i, 0]:.6g}, {vertices[i, 1]:.6g}),"


def _lower_side(vertices: Floats) -> Floats:
    """From the leftmost to the rightmost vertex of a counterclockwise polygon, lower ones first."""
    first = np.lexsort((vertices[:, 1], vertices[:, 0]))[0]
    ordered = np.roll(vertices, -first, axis=0)
    last = np.lexsort((ordered[:, 1], -ordered[:, 0]))[0]
    return np.asarray(ordered[: last + 1])
