"""The object as the convex mesh of a file, placed and scaled, with all of its vertices.

Not an extrusion of its section: above and below the plane of the sweep it is what it is.
"""

import math
from functools import cached_property

import mujoco
import numpy as np
from scipy.spatial import ConvexHull, KDTree

from analytic.numerics.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.contours.contour import ConvexMesh
from analytic.problem.errors import InputError
from mujoco_models.obstacles.corners import Corners, upright
from mujoco_models.obstacles.faceted import Faceted, add_hull, own_ends, touchable
from mujoco_models.obstacles.protocol import GEOM

_MOST_VERTICES = 50_000  # the hull of a round body takes MuJoCo half a second then
_SAME_PLACE = 1e-7  # L
_SPECK_OF_EDGE = 1e-5  # L
# L; a bead of radius r touches a side that is tilted by t as if the section were larger by
# r (1/cos(t) - 1). That moves a reading by about twice its share of the height: 2e-3 at 0.5 L.
_LARGEST_SHIFT = 5e-4
_SPECK = 0.1  # of the depth at which it lies in the mesh


class FileMesh(Faceted):
    """A mesh that knows its section."""

    windows = 1

    def __init__(self, case: Case, solid: ConvexMesh, corner_radius: float) -> None:
        if len(solid.vertices) > _MOST_VERTICES:
            raise InputError(
                f"mesh {solid.name}",
                f"of {len(solid.vertices)} vertices",
                f"of at most {_MOST_VERTICES} for MuJoCo",
                "simplify it",
            )
        shift = case.radius * (1 / math.sqrt(1 - min(solid.tilt, 1 - 1e-9) ** 2) - 1)
        if shift > _LARGEST_SHIFT:
            raise InputError(
                f"tilt of mesh {solid.name}",
                f"{math.asin(min(solid.tilt, 1)):.2g} rad out of the plane of the sweep",
                f"smaller: the vibrissa would touch it {shift:.1e} L before its section, "
                f"at most {_LARGEST_SHIFT:g} L",
                "turn it so that its sides are upright where it is touched, or cut it by its "
                "plane of symmetry, or simulate its section as a polygon",
            )
        body = case.profile.scaled(1 / case.beam.length)
        last, first = case.reach
        super().__init__(body.outline(last, first, 0), touchable(case))
        self._solid, self._corner_radius, self._ends = solid, corner_radius, own_ends(case)

    @property
    def label(self) -> str:
        """The file, and how far its sides are from upright in the plane of the sweep."""
        solid = self._solid
        return (
            f"mesh {solid.name} with {len(solid.vertices)} vertices; where the vibrissa can touch "
            f"it, its normals leave the plane of the sweep by up to {solid.tilt:.1e}"
        )

    def hull(self, window: int) -> Floats:
        return self._solid.vertices

    def add_to(self, spec: mujoco.MjSpec, name: str = GEOM) -> None:
        vertices = self._solid.vertices
        inner = vertices.mean(axis=0)
        planes = ConvexHull(vertices).equations
        depth = -float((planes[:, :3] @ inner + planes[:, 3]).max())
        add_hull(spec, vertices, inner, _SPECK * depth / 3, name)

    @cached_property
    def corners(self) -> Corners:
        """Where the mesh's own edges cross the plane of the sweep."""
        return Corners.of(self.vertices, self._edges, self._corner_radius, self._ends)

    def across(self, slope: Floats) -> Floats:
        """Of the edges at corners; facets that are smooth to beads turn with the contour."""
        if len(self.corners) == 0:
            return np.ones(len(slope))
        begin, end = self._edges[self.vertex(slope)].transpose(1, 0, 2)
        edge = end - begin
        slide = edge[:, 0] * np.cos(slope) + edge[:, 1] * np.sin(slope)
        return np.asarray(1 - slide**2 / (edge**2).sum(axis=1))

    @cached_property
    def _edges(self) -> Floats:
        """The edge through each vertex of the section, shape (n, 2, 3) [L].

        A vertex of the mesh that lies in the plane itself is a point: a speck of an edge.
        """
        crossing, begin, end = self._crossing
        edges = upright(self.vertices, _SPECK_OF_EDGE)
        if len(crossing):
            distance, nearest = KDTree(crossing).query(self.vertices)
            found = np.flatnonzero(np.asarray(distance) < _SAME_PLACE)
            edges[found] = np.stack([begin, end], axis=1)[np.asarray(nearest)[found]]
        return edges

    @cached_property
    def _crossing(self) -> tuple[Floats, Floats, Floats]:
        """Where edges of the mesh cross the plane, and where they begin and end [L]."""
        vertices = self._solid.vertices
        triangles = np.asarray(ConvexHull(vertices).simplices)
        pairs = np.sort(
            np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]),
            axis=1,
        )
        begin, end = vertices[np.unique(pairs, axis=0)].transpose(1, 0, 2)
        across = begin[:, 2] * end[:, 2] < 0
        begin, end = begin[across], end[across]
        share = begin[:, 2] / (begin[:, 2] - end[:, 2])
        return begin[:, :2] + share[:, None] * (end - begin)[:, :2], begin, end

    def show(self, model: mujoco.MjModel, geom: int, window: int) -> None:
        """There is only one."""

    def place(self, slope: Floats) -> Floats:
        """The slope angles themselves: it is as true in one place as in any other."""
        return slope

    def window_of(self, place: float) -> int:
        return 0

    def is_inside(self, window: int, places: Floats) -> bool:
        return True
