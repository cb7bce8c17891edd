"""The object as the convex mesh of a file, placed and scaled, with all of its vertices.

Not an extrusion of its section: above and below the plane of the sweep it is what it is.
"""

import mujoco
from scipy.spatial import ConvexHull

from analytic.problem.arrays import Floats
from analytic.problem.case import Case
from analytic.problem.contours.solid import ConvexMesh
from analytic.problem.errors import InputError
from mujoco_models.obstacles.faceted import Faceted, add_hull, touchable

_MOST_VERTICES = 50_000  # the hull of a round body takes MuJoCo half a second then
_SPECK = 0.1  # of the depth at which it lies in the mesh


class FileMesh(Faceted):
    """A mesh that knows its section.

    Parameters
    ----------
    case : Case
        Whose contour is the section of `solid`.
    solid : ConvexMesh
        In units of the vibrissa's length.

    Raises
    ------
    InputError
        If it has too many vertices for MuJoCo to find its hull in a reasonable time.
    """

    geoms = 1

    def __init__(self, case: Case, solid: ConvexMesh) -> None:
        if len(solid.vertices) > _MOST_VERTICES:
            raise InputError(
                f"mesh {solid.name}",
                f"of {len(solid.vertices)} vertices",
                f"of at most {_MOST_VERTICES} for MuJoCo",
                "simplify it",
            )
        body = case.profile.scaled(1 / case.beam.length)
        last, first = case.reach
        super().__init__(body.outline(last, first, 0), touchable(case))
        self._solid = solid

    @property
    def label(self) -> str:
        """The file, and how far its sides are from upright in the plane of the sweep."""
        solid = self._solid
        return (
            f"mesh {solid.name} with {len(solid.vertices)} vertices; where the vibrissa can touch "
            f"it, its normals leave the plane of the sweep by up to {solid.tilt:.1e}"
        )

    def add_to(self, spec: mujoco.MjSpec) -> None:
        """One geom."""
        vertices = self._solid.vertices
        inner = vertices.mean(axis=0)
        planes = ConvexHull(vertices).equations
        depth = -float((planes[:, :3] @ inner + planes[:, 3]).max())
        add_hull(spec, 0, vertices, inner, _SPECK * depth / 3)

    def place(self, slope: Floats) -> Floats:
        """The slope angles themselves: it is as true in one place as in any other."""
        return slope

    def window_of(self, place: float) -> int:
        """The only one."""
        return 0

    def is_inside(self, window: int, places: Floats) -> bool:
        """Everything is."""
        return True
