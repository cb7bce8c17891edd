"""The object of a case file: a table for each kind of contour."""

from pathlib import Path
from typing import Literal

from pydantic import Field

import analytic
from analytic import Contour
from compare.read.quantities import Length, PerLength, Point, Points, Table

_FACTORIES = {"two-circles": "two_circles", "points": "through_points"}  # by kind, if not its name


class ProfileTable(Table):
    """The object: a kind of contour, and the numbers that it is made from."""

    kind: str
    scale: Length = Field(default=1.0, gt=0)

    def build(self, folder: Path) -> Contour:  # files are in it, if there are any
        """The contour."""
        factory = getattr(analytic, _FACTORIES.get(self.kind, self.kind))
        contour: Contour = factory(**self.model_dump(exclude={"kind", "scale"}))
        return contour.scaled(self.scale)


class CatenaryTable(ProfileTable):
    """See `analytic.catenary`."""

    kind: Literal["catenary"]
    a: PerLength
    c: Length


class ParabolaTable(ProfileTable):
    """See `analytic.parabola`."""

    kind: Literal["parabola"]
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


class PolygonTable(ProfileTable):
    """See `analytic.polygon`."""

    kind: Literal["polygon"]
    points: Points


class PointsTable(ProfileTable):
    """See `analytic.through_points`."""

    kind: Literal["points"]
    points: Points


Drawn = (
    CatenaryTable
    | ParabolaTable
    | CircleTable
    | EllipseTable
    | TwoCirclesTable
    | PolygonTable
    | PointsTable
)
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
        from analytic import mesh_section  # slow to load, and few cases have a mesh

        numbers = self.model_dump(exclude={"kind", "file"})
        return mesh_section(folder / self.file, **numbers)
