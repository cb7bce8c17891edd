"""Case files of sweeps in space."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias

import numpy as np
from pydantic import Field

from analytic import InputError, space
from analytic.space import Body, FootPath, SpatialCase, convex_mesh, prism
from compare.judge.tolerances import SpatialTolerances
from compare.read.complaints import name_of
from compare.read.job import SpaceJob
from compare.read.limits import tolerances_of
from compare.read.motion import MotionTable
from compare.read.profiles import Drawn
from compare.read.quantities import (
    FileName,
    Length,
    Point,
    Table,
    known_keys,
    one_of_kinds,
    validated,
)
from compare.read.tables import BeamTable, ContactTable
from compare.read.toml import TomlFile
from mujoco_models.settings import SpatialSettings

Position = Annotated[tuple[Length, Length, Length], Field(strict=False)]
Axis = Annotated[tuple[float, float, float], Field(strict=False)]


class BodyTable(Table):
    """The body: a kind, which is the name of a function of `analytic.space`, and what it takes."""

    kind: str

    def build(self, folder: Path) -> Body:  # files are in it, if there are any
        body: Body = getattr(space, self.kind)(**self.model_dump(exclude={"kind"}))
        return body


_Frame = Annotated[list[Axis], Field(min_length=3, max_length=3)] | None
if TYPE_CHECKING:
    Stated: TypeAlias = BodyTable
else:
    Stated = one_of_kinds(
        BodyTable,
        partial(getattr, space),
        {
            "sphere": {"radius": Length, "centre": Position},
            "ellipsoid": {"semi_axes": Position, "centre": Position, "frame": _Frame},
            "cylinder": {"radius": Length, "through": Position, "axis": Axis},
            "polyhedron": {"points": list[Position]},
        },
    )


class PrismTable(BodyTable):
    """See `analytic.space.prism`; the contour is the table ``[profile]``."""

    kind: Literal["prism"]
    axis: Axis = (0.0, 0.0, 1.0)
    origin: Position = (0.0, 0.0, 0.0)


class SolidTable(BodyTable):
    """See `analytic.space.convex_mesh`."""

    kind: Literal["mesh"]
    file: str
    scale: Length = 1.0
    offset: Position = (0.0, 0.0, 0.0)
    hull: bool = False
    tolerance: Length = 0.0

    def build(self, folder: Path) -> Body:
        return convex_mesh(folder / self.file, **self.model_dump(exclude={"kind", "file"}))


class PathTable(Table):
    points: Annotated[list[Point], Field(min_length=2)]
    height: Length = 0.0
    tangent: Axis = (0.0, 1.0, 0.0)
    stations: int = 200
    turn: float = Field(default=0.0, allow_inf_nan=False)

    def build(self) -> FootPath:
        """The way, turned about y by so many degrees: 90 take x to -z."""
        points = self.points
        if self.turn:
            cos, sin = np.cos(np.radians(self.turn)), np.sin(np.radians(self.turn))
            points = [(cos * x + sin * z, cos * z - sin * x) for x, z in points]
        return FootPath(points, self.height, self.tangent, self.stations)


class SpaceFile(Table):
    name: FileName | None = None  # what files and reports call the case
    beam: BeamTable = BeamTable()
    body: Annotated[Stated | PrismTable | SolidTable, Field(discriminator="kind")]
    profile: Annotated[Drawn, Field(discriminator="kind")] | None = None  # of a prism
    path: PathTable
    contact: ContactTable = ContactTable()
    motion: MotionTable | None = None
    mujoco: Annotated[SpatialSettings, known_keys(SpatialSettings)] = SpatialSettings()
    tolerances: Annotated[dict[str, Any], Field(default_factory=dict)]

    def case(self, folder: Path, name: str) -> SpatialCase:
        if isinstance(self.body, PrismTable) and self.profile is not None:
            body: Body = prism(self.profile.build(folder), self.body.axis, self.body.origin)
        elif isinstance(self.body, PrismTable) or self.profile is not None:
            given, remedy = "given", 'leave it out, or take kind = "prism"'
            if self.profile is None:
                given, remedy = "missing", "add it"
            allowed = "given for a prism, whose contour it is, and for nothing else"
            raise InputError("[profile]", given, allowed, remedy)
        else:
            body = self.body.build(folder)
        return SpatialCase(
            self.beam.build(),
            body=body,
            path=self.path.build(),
            friction=self.contact.friction,
            name=self.name or name,
        )


def job_in_space(file: TomlFile) -> SpaceJob:
    found = validated(SpaceFile, file.tables, file.place)
    with file.naming():
        case = found.case(file.path.parent, found.name or name_of(file.path))
    limits = tolerances_of(found.tolerances, file.place, SpatialTolerances)
    motion = None if found.motion is None else found.motion.build(case.beam)
    return SpaceJob(case, found.mujoco, limits, motion=motion)
