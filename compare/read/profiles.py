"""The object of a case file: a table for all kinds of contour that the same numbers make."""

from pathlib import Path
from typing import Literal

from analytic import Contour
from analytic.problem.contours.kinds import CONTOURS
from compare.read.quantities import Length, PerLength, Point, Points, Table


class ProfileTable(Table):
    """The object: a kind of contour, and what the function of that kind takes."""

    kind: str
    scale: Length = 1.0

    def build(self, folder: Path) -> Contour:  # files are in it, if there are any
        """The contour."""
        numbers = self.model_dump(exclude={"kind", "scale"})
        return CONTOURS[self.kind](**numbers).scaled(self.scale)


class GraphTable(ProfileTable):
    """See `analytic.catenary` and `analytic.parabola`."""

    kind: Literal["catenary", "parabola"]
    a: PerLength
    c: Length


class CircleTable(ProfileTable):
    """See `analytic.circle`."""

    kind: Literal["circle"]
    radius: Length
    lowest: Point


class EllipseTable(ProfileTable):
    """See `analytic.ellipse`."""

    kind: Literal["ellipse"]
    semi_axes: Point
    lowest: Point


class TwoCirclesTable(ProfileTable):
    """See `analytic.two_circles`."""

    kind: Literal["two-circles"]
    right_radius: Length = 2.0
    left_radius: Length = 0.5
    lowest: Point = (0.0, 0.5)


class PointsTable(ProfileTable):
    """See `analytic.polygon` and `analytic.through_points`."""

    kind: Literal["polygon", "points"]
    points: Points


Drawn = GraphTable | CircleTable | EllipseTable | TwoCirclesTable | PointsTable
"""Contours that the file itself has."""


class MeshTable(ProfileTable):
    """See `analytic.mesh_section`."""

    kind: Literal["mesh"]
    file: str
    offset: Point = (0.0, 0.0)
    height: float = 0.0
    axes: str = "xy"
    hull: bool = False
    tolerance: float = 0.0

    def build(self, folder: Path) -> Contour:
        """The section of the mesh."""
        return CONTOURS[self.kind](folder / self.file, **self.model_dump(exclude={"kind", "file"}))
