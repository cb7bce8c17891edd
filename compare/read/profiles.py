"""The object of a case file: its kind, and what the function of that kind takes."""

from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

from analytic import Contour
from analytic.problem.named import CONTOURS
from compare.read.quantities import Length, PerLength, Point, Points, Table, one_of_kinds


class ProfileTable(Table):
    """A contour that the file itself has, and a factor for all its lengths."""

    kind: str
    scale: Length = 1.0

    def build(self, folder: Path) -> Contour:  # files are in it, if there are any
        numbers = self.model_dump(exclude={"kind", "scale"})
        return CONTOURS[self.kind](**numbers).scaled(self.scale)


if TYPE_CHECKING:
    Drawn: TypeAlias = ProfileTable
else:
    Drawn = one_of_kinds(
        ProfileTable,
        CONTOURS.__getitem__,
        {
            "catenary": {"a": PerLength, "c": Length},
            "parabola": {"a": PerLength, "c": Length},
            "circle": {"radius": Length, "lowest": Point},
            "ellipse": {"semi_axes": Point, "lowest": Point},
            "two-circles": {"right_radius": Length, "left_radius": Length, "lowest": Point},
            "polygon": {"points": Points},
            "points": {"points": Points},
        },
    )


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
        return CONTOURS[self.kind](folder / self.file, **self.model_dump(exclude={"kind", "file"}))
