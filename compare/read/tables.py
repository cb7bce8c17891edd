"""The tables of a case file: what each of them may hold, and what is built from it."""

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, NamedTuple

from pydantic import AfterValidator, Field

from analytic import Beam, Case, Contour, Direction, InputError, Sweep, Whisk
from analytic.problem.support import Support, check_support, support_record
from compare.judge.tolerances import Tolerances
from compare.read.complaints import name_of
from compare.read.job import Job, engines_beside_exact
from compare.read.limits import tolerances_of
from compare.read.motion import MotionTable
from compare.read.profiles import Drawn, MeshTable
from compare.read.quantities import (
    Angle,
    CurvatureAlong,
    FileName,
    ForceByLength,
    InSI,
    Length,
    RigidityAlong,
    RotationalStiffness,
    Table,
    known_keys,
    validated,
)
from compare.read.toml import TomlFile
from compare.read.uncertainty import UncertaintyTable, uncertainties_of
from mujoco_models.motion import Motion
from mujoco_models.settings import Settings
from mujoco_models.user_model.names import ContactKind, OwnModel
from mujoco_models.user_model.shipped import find_model

PLACES = {
    "flexural_rigidity": ("beam", "flexural_rigidity"),
    "natural_curvature": ("beam", "natural_curvature"),
    "tip_radius": ("beam", "tip_radius"),
    "length": ("beam", "length"),
    "clamp_stiffness": ("support", "rotational_stiffness"),
    "clamp_angle": ("support", "angle"),
    "friction": ("contact", "friction"),
    "engine": ("engine", "name"),
}
"""Where a case file has what is called otherwise elsewhere, as by a calibration."""


class BeamTable(Table):
    length: Length = 1.0
    flexural_rigidity: RigidityAlong = 1.0
    radius: Length | None = None
    tip_radius: Length | None = None
    natural_curvature: CurvatureAlong = 0.0

    def build(self) -> Beam:
        """The vibrissa; its radius is by default the same share of its length as in `Beam()`."""
        radius = Beam().radius * self.length if self.radius is None else self.radius
        stated = self.model_dump() | {"radius": radius}
        return Beam(**stated, si=isinstance(self.length, InSI))


class SupportTable(Table):
    """How the vibrissa is held; rigidly, if nothing is said."""

    rotational_stiffness: (
        Annotated[RotationalStiffness, Field(gt=0, allow_inf_nan=False)] | None
    ) = None
    angle: Angle = 0.0


class ContactTable(Table):
    friction: Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)] = 0.0


class WeightTable(Table):
    """What the vibrissa weighs along x and y; nothing, if nothing is said."""

    x: ForceByLength = 0.0
    y: ForceByLength = 0.0


class StationsTable(Table):
    stations: int = Sweep().stations
    start: Length | None = None
    stop: Length | None = None
    direction: Direction = Sweep().direction

    def build(self) -> Sweep:
        return Sweep(**self.model_dump())


class WhiskTable(Table):
    """The angles of a clamp whose foot stands."""

    foot_x: Length = 0.0
    start: Angle
    stop: Angle
    stations: int = Whisk.stations

    def build(self) -> Whisk:
        return Whisk(**self.model_dump())


class Physics(NamedTuple):
    """A problem without a sweep, in the units of the file, or SI."""

    beam: Beam
    profile: Contour
    support: Support


class ModelTable(Table):
    """A MuJoCo model of the user's own; see `mujoco_models.OwnModel`."""

    file: str
    foot: str | None = None
    force: str | None = None
    torque: str | None = None
    geoms: str | None = None
    site: str | None = None
    contact: ContactKind = "own"

    def build(self, folder: Path) -> OwnModel:
        names = self.model_dump(exclude={"file"})
        path = folder / self.file
        return OwnModel(path if path.exists() else find_model(self.file), **names)


def _of_known_engines(names: str) -> str:
    engines_beside_exact(names)
    return names


class EngineTable(Table):
    """Which engines sweep the case, and how long each may take [s]."""

    name: Annotated[str, AfterValidator(_of_known_engines)] = "mujoco"
    timeout: Annotated[float, Field(gt=0, le=86_400)] = 600.0


class CaseFile(Table):
    """What a case file holds; dimensions in one system of units, SI if units are given.

    A whisk stands for the sweep, a model of the user's own for ours; without a motion MuJoCo's beam
    is at rest at every station.
    """

    name: FileName | None = None  # what files and reports call the case
    beam: BeamTable = BeamTable()
    support: SupportTable = SupportTable()
    contact: ContactTable = ContactTable()
    weight: WeightTable = WeightTable()
    profile: Annotated[Drawn | MeshTable, Field(discriminator="kind")]
    sweep: StationsTable = StationsTable()
    whisk: WhiskTable | None = None
    mujoco: Annotated[Settings, known_keys(Settings), Field(default_factory=Settings)]
    model: ModelTable | None = None
    motion: MotionTable | None = None
    engine: EngineTable = EngineTable()
    tolerances: Annotated[dict[str, Any], Field(default_factory=dict)]
    uncertainty: UncertaintyTable = UncertaintyTable()

    def physics(self, folder: Path) -> Physics:
        """The vibrissa, how it is held and rubs, and the object, without a sweep."""
        held = _support(self.support, self.contact, self.weight)
        found = Physics(self.beam.build(), self.profile.build(folder), held)
        check_support(found.support, found.beam)
        return found

    def way(self) -> Sweep | Whisk:
        if self.whisk is None:
            return self.sweep.build()
        if "sweep" in self.model_fields_set:
            raise InputError("[sweep] beside [whisk]", "both", "one of them", "leave one out")
        return self.whisk.build()

    def case(self, folder: Path, name: str, others: Sequence[Contour] = ()) -> Case:
        """The whole problem, with more objects."""
        beam, contour, held = self.physics(folder)
        try:
            return Case(
                beam, contour, self.way(), self.name or name, others=tuple(others), **held._asdict()
            )
        except InputError as error:
            is_mesh = isinstance(self.profile, MeshTable)
            if not is_mesh or not beam.si or "scale" in self.profile.model_fields_set:
                raise
            what = "missing, so the mesh file's numbers are taken for metres"
            allowed = 'the size of their unit, scale = "1 mm" for millimetres'
            raise InputError("profile.scale", what, allowed, f"add it ({error})") from error


def _support(clamp: SupportTable, contact: ContactTable, weight: WeightTable) -> Support:
    stiffness = clamp.rotational_stiffness or math.inf
    return Support(stiffness, contact.friction, clamp.angle, (weight.x, weight.y))


class BeamFile(Table):
    """A file of which only the vibrissa counts, how it is held, how it rubs and what it weighs."""

    beam: BeamTable
    support: SupportTable = SupportTable()
    contact: ContactTable = ContactTable()
    weight: WeightTable = WeightTable()


def job_in_the_plane(file: TomlFile) -> Job:
    folder, each = file.path.parent, file.each("profile")  # several objects, [[profile]]
    found, *more = (validated(CaseFile, one.tables, one.place) for one in each)
    others = []
    for one, other in zip(each[1:], more, strict=True):
        with one.naming():
            others.append(other.profile.build(folder))
    with each[0].naming():
        case = found.case(folder, found.name or name_of(file.path), others)
    moved, own = found.motion, found.model
    motion = None if moved is None else moved.build(case.beam)
    if own is not None:
        motion = Motion() if moved is None else moved.of_a_model(case.beam, file.place)
    return Job(
        case,
        found.mujoco,
        tolerances_of(found.tolerances, file.place, Tolerances),
        motion,
        uncertainties_of(found.uncertainty, case, file.place),
        None if own is None else own.build(folder),
        engines_beside_exact(found.engine.name),
        found.engine.timeout,
    )


def read_beam(path: Path) -> tuple[Beam, dict[str, Any]]:
    """The vibrissa of a file, and what provenance says of its clamp, contact and weight.

    Other tables do not matter.
    """
    file = TomlFile.read(path, "beam file")
    known = {name: file.tables[name] for name in BeamFile.model_fields if name in file.tables}
    found = validated(BeamFile, {"beam": file.table("beam"), **known}, file.place)
    beam = found.beam.build()
    if len(known) == 1:
        return beam, {}
    held = _support(found.support, found.contact, found.weight)
    check_support(held, beam)
    return beam, {"support": {}} | support_record(held)
