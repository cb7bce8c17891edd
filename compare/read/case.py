"""Cases from names and TOML files, with units and with errors that a person can act on."""

import difflib
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar, cast

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, TypeAdapter, ValidationError
from pydantic_core import ErrorDetails, PydanticCustomError
from pydantic_core.core_schema import ValidationInfo

from analytic import (
    CASE_NAMES,
    Beam,
    Case,
    Contour,
    Direction,
    InputError,
    Sweep,
    catenary,
    circle,
    ellipse,
    mesh_section,
    named_case,
    parabola,
    polygon,
    through_points,
    two_circles,
)
from compare.judge.tolerances import Tolerances
from compare.read.limits import tolerances_of
from compare.read.toml import Place, TomlFile
from compare.read.units import in_si
from mujoco_models.settings import Settings


def _quantity(dimension: str) -> Callable[[Any, ValidationInfo], float]:
    """A validator for a number, or a text with a unit of `dimension`, which becomes SI."""

    def convert(value: object, info: ValidationInfo) -> float:
        seen = cast("dict[str, list[str]]", info.context)
        if isinstance(value, int | float) and not isinstance(value, bool):
            if value != 0:
                seen["bare"].append(str(info.field_name))
            return float(value)
        try:
            number = in_si(cast("str", value), dimension)
        except InputError as error:
            raise PydanticCustomError(
                "quantity",
                "a number, or a text with a unit, as '50 {dimension}'",
                {"dimension": dimension},
            ) from error
        seen["united"].append(str(info.field_name))
        return number

    return convert


Length = Annotated[float, BeforeValidator(_quantity("m"))]
PerLength = Annotated[float, BeforeValidator(_quantity("1/m"))]
Rigidity = Annotated[float, BeforeValidator(_quantity("N m^2"))]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class _BeamTable(_Table):
    length: Length = 1.0
    flexural_rigidity: Rigidity = 1.0
    radius: Length | None = None

    def build(self) -> Beam:
        radius = Beam().radius * self.length if self.radius is None else self.radius
        return Beam(self.length, self.flexural_rigidity, radius)


class _ProfileTable(_Table):
    scale: Length = Field(default=1.0, gt=0)

    def build(self, folder: Path) -> Contour:
        """The contour; a file's path is relative to `folder`."""
        numbers = self.model_dump(exclude={"kind", "scale"})
        if "file" in numbers:
            numbers["file"] = folder / numbers["file"]
            return mesh_section(scale=self.scale, **numbers)
        return _FACTORIES[self.model_dump()["kind"]](**numbers).scaled(self.scale)


class _Catenary(_ProfileTable):
    kind: Literal["catenary"]
    a: PerLength
    c: Length


class _Parabola(_ProfileTable):
    kind: Literal["parabola"]
    a: PerLength
    c: Length


class _Circle(_ProfileTable):
    kind: Literal["circle"]
    radius: Length
    lowest: tuple[Length, Length]


class _Ellipse(_ProfileTable):
    kind: Literal["ellipse"]
    semi_axes: tuple[Length, Length]
    lowest: tuple[Length, Length]


class _TwoCircles(_ProfileTable):
    kind: Literal["two-circles"]
    right_radius: Length = 2.0
    left_radius: Length = 0.5
    lowest: tuple[Length, Length] = (0.0, 0.5)


class _Polygon(_ProfileTable):
    kind: Literal["polygon"]
    points: list[tuple[Length, Length]]


class _Points(_ProfileTable):
    kind: Literal["points"]
    points: list[tuple[Length, Length]]


class _Mesh(_ProfileTable):
    kind: Literal["mesh"]
    file: str
    offset: tuple[Length, Length] = (0.0, 0.0)
    height: float = 0.0
    axes: str = "xy"


_FACTORIES: dict[str, Callable[..., Contour]] = {
    "catenary": catenary,
    "parabola": parabola,
    "circle": circle,
    "ellipse": ellipse,
    "two-circles": two_circles,
    "polygon": polygon,
    "points": through_points,
}
_TABLES: dict[str, type[_ProfileTable]] = {
    "catenary": _Catenary,
    "parabola": _Parabola,
    "circle": _Circle,
    "ellipse": _Ellipse,
    "two-circles": _TwoCircles,
    "polygon": _Polygon,
    "points": _Points,
    "mesh": _Mesh,
}


class _SweepTable(_Table):
    stations: int = Sweep().stations
    start: Length | None = None
    stop: Length | None = None
    direction: Direction = Sweep().direction

    def build(self) -> Sweep:
        return Sweep(self.stations, self.start, self.stop, self.direction)


class CaseFile(_Table):
    """What a case file holds; dimensions in one system of units, SI if units are given.

    Parameters
    ----------
    name : str, optional
        What files and reports call the case.
    beam, profile, sweep : table
        The physics.
    mujoco : Settings
        The numerics of the simulation.
    tolerances : table
        How far two sweeps of the case may disagree (`compare.read.limits`).
    """

    name: str | None = None
    beam: _BeamTable = _BeamTable()
    profile: Annotated[
        _Catenary | _Parabola | _Circle | _Ellipse | _TwoCircles | _Polygon | _Points | _Mesh,
        Field(discriminator="kind"),
    ]
    sweep: _SweepTable = _SweepTable()
    mujoco: Annotated[Settings, Field(default_factory=Settings)]
    tolerances: dict[str, Any] = {}

    def physics(self, folder: Path) -> tuple[Beam, Contour]:
        """The vibrissa and the object, without a sweep; file paths are relative to `folder`."""
        return self.beam.build(), self.profile.build(folder)

    def case(self, folder: Path, name: str) -> Case:
        """The whole problem, called `name` if the file does not say otherwise."""
        return Case(*self.physics(folder), self.sweep.build(), self.name or name)


class _BeamFile(_Table):
    beam: _BeamTable


_Schema = TypeVar("_Schema", bound=_Table)


@dataclass(frozen=True)
class Job:
    """A case, how MuJoCo is to simulate it, and how far the two models may disagree."""

    case: Case
    settings: Settings
    tolerances: Tolerances = field(default_factory=Tolerances)


def load_job(name_or_path: str) -> Job:
    """The case of that name, or from that TOML file.

    Raises
    ------
    InputError
        If there is neither, or the file has unknown keys, wrong types, unknown units, numbers with
        and without units mixed, or states no solvable problem.
    """
    if name_or_path in CASE_NAMES:
        return Job(named_case(name_or_path), Settings())
    path = Path(name_or_path)
    if path.suffix != ".toml":
        near = difflib.get_close_matches(name_or_path, CASE_NAMES, n=1)
        raise InputError(
            "case",
            repr(name_or_path),
            f"one of {', '.join(CASE_NAMES)}, or the path of a .toml file",
            f"did you mean {near[0]}?" if near else "`vibrissa cases` lists them",
        )
    file = TomlFile.read(path, "case file")
    case_file = validate(file.tables, file.place)
    return Job(
        case_file.case(path.parent, path.stem),
        case_file.mujoco,
        tolerances_of(case_file.tolerances, file.place),
    )


def validate(tables: dict[str, Any], place: Place) -> CaseFile:
    """What a case file's tables say.

    Parameters
    ----------
    tables : dict
        As parsed.
    place : callable
        What an error calls a key.

    Raises
    ------
    InputError
        If there are unknown keys, wrong types, unknown units, or numbers with and without units
        mixed.
    """
    seen: dict[str, list[str]] = {"bare": [], "united": []}
    file = _validated(CaseFile, tables, place, seen)
    scale = tables["profile"].get("scale")
    if isinstance(scale, str):  # the shape's own numbers are then in units of the scale
        seen["bare"] = [name for name in seen["bare"] if name not in tables["profile"]]
    if seen["bare"] and seen["united"]:
        bare = seen["bare"][0]
        table = next(t for t in ("beam", "profile", "sweep") if bare in tables.get(t, {}))
        raise InputError(
            place([table, bare]),
            "without a unit",
            f"given with a unit, as {seen['united'][0]} is",
            "write all dimensions with units, or none",
        )
    return file


def read_beam(raw: dict[str, Any], path: Path) -> Beam:
    """The vibrissa of a file's ``[beam]`` table; other tables do not matter.

    Raises
    ------
    InputError
        If there is no such table or it cannot be used.
    """
    if "beam" not in raw:
        raise InputError(f"{path}: [beam]", "missing", "given", "add the table")
    seen: dict[str, list[str]] = {"bare": [], "united": []}
    tables = {"beam": raw["beam"]}
    file = _validated(_BeamFile, tables, lambda keys: f"{path}: {'.'.join(keys)}", seen)
    return file.beam.build()


def _validated(
    schema: type[_Schema], raw: dict[str, Any], place: Place, seen: dict[str, list[str]]
) -> _Schema:
    try:
        return TypeAdapter(schema).validate_python(raw, context=seen)
    except ValidationError as error:
        raise _told(error.errors()[0], place) from error


def _told(error: ErrorDetails, place: Place) -> InputError:
    """A validation error in one line."""
    where = [str(part) for part in error["loc"]]
    if len(where) > 1 and where[0] == "profile":  # drop the union's tag
        where = [where[0], *where[2:]]
    name = place(where)
    value = error["input"]
    match error["type"]:
        case "extra_forbidden" | "unexpected_keyword_argument":
            allowed = _keys(where[:-1], error)
            near = difflib.get_close_matches(where[-1], allowed, n=1)
            return InputError(
                name,
                repr(value),
                f"one of the keys {', '.join(allowed)}",
                f"did you mean {near[0]}?" if near else "remove it",
            )
        case "missing":
            return InputError(name, "missing", "given", "add it")
        case "union_tag_invalid":
            context = error["ctx"]
            return InputError(
                f"{name}.kind",
                repr(context["tag"]),
                f"one of {context['expected_tags']}",
                "mend it",
            )
        case "union_tag_not_found":
            return InputError(f"{name}.kind", "missing", "given", "say what the profile is")
        case "literal_error":
            return InputError(name, repr(value), f"one of {error['ctx']['expected']}", "choose one")
        case "bool_parsing" | "bool_type":
            return InputError(name, repr(value), "true or false", "write it without quotes")
        case "value_error":
            return InputError(name, repr(value), "usable", str(error["ctx"]["error"]))
    return InputError(name, repr(value), error["msg"], "mend it")


def _keys(where: list[str], error: ErrorDetails) -> list[str]:
    """The keys that the table at `where` may have."""
    match where:
        case []:
            return list(CaseFile.model_fields)
        case ["beam"]:
            return list(_BeamTable.model_fields)
        case ["sweep"]:
            return list(_SweepTable.model_fields)
        case ["mujoco"]:
            return list(Settings.__dataclass_fields__)
    return list(_TABLES[str(error["loc"][1])].model_fields)
