"""Values of a file: numbers, and texts with a unit; and tables of them, checked."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, fields
from functools import reduce
from inspect import Parameter, signature
from operator import or_
from typing import Annotated, Any, Literal, TypeVar

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PlainSerializer,
    PlainValidator,
    ValidationError,
    create_model,
    model_validator,
)
from pydantic_core import PydanticCustomError

from analytic import InputError
from compare.read.complaints import complaint, plain_name, require_known
from compare.read.toml import KeyPlace
from compare.read.units import in_si

_WITH_UNITS = ("beam", "support", "weight", "profile", "sweep", "whisk", "body", "path")

EXAMPLES = {
    "N": ("force", "0.2 mN"),
    "N m": ("moment", "1 N mm"),
    "m": ("length", "50 mm"),
    "1/m": ("inverse length", "0.5 1/mm"),
    "N m^2": ("force times length squared", "2 N mm^2"),
    "N/m": ("force by length", "2 mN/m"),
    "N m/rad": ("moment by angle", "0.3 mN m/rad"),
    "rad": ("angle", "2 deg"),
    "m/s": ("speed", "10 mm/s"),
    "s": ("time", "1 ms"),
    "1/s": ("rate", "500 Hz"),
    "kg/m^3": ("density", "7850 kg/m^3"),
}


class InSI(float):
    """A number that was given with a unit."""


class Bare(float):
    """A number that could have been given with a unit."""


@dataclass(frozen=True)
class Dimension:
    """A validator: a number, or a text with a unit of `unit`, which becomes SI."""

    unit: str

    def __call__(self, value: object) -> float:
        try:
            if isinstance(value, int | float) and not isinstance(value, bool):
                return Bare(value)
            if isinstance(value, str):
                return InSI(in_si(value, self.unit))
        except (InputError, OverflowError):
            pass
        what, example = EXAMPLES[self.unit]
        raise _refused(f"a number, or a text with a known unit of {what}, as '{example}'")


@dataclass(frozen=True)
class VaryingDimension(Dimension):
    """The same, or a table of it: pairs of an arc length from the clamp and the value there."""

    def __call__(self, value: object) -> Any:  # noqa: ANN401  # a number, or pairs of them
        if not isinstance(value, list | tuple):
            return super().__call__(value)
        if not all(isinstance(pair, list | tuple) and len(pair) == 2 for pair in value):
            what = EXAMPLES[self.unit][0]
            raise _refused(f"a number, or a list of pairs [arc length from the clamp, {what}]")
        number, length = super().__call__, Dimension("m")
        return tuple((length(s), number(x)) for s, x in value)


def _refused(allowed: str) -> PydanticCustomError:
    return PydanticCustomError("quantity", "{allowed}", {"allowed": allowed})


def _plain(value: Any) -> Any:  # noqa: ANN401  # a quantity, or pairs of them
    """The same as numbers that do not remember how they were given."""
    return tuple(map(_plain, value)) if isinstance(value, tuple) else float(value)


PLAIN = PlainSerializer(_plain, when_used="unless-none")
Length = Annotated[float, PlainValidator(Dimension("m")), PLAIN]
PerLength = Annotated[float, PlainValidator(Dimension("1/m")), PLAIN]
Pairs = tuple[tuple[float, float], ...]
RigidityAlong = Annotated[float | Pairs, PlainValidator(VaryingDimension("N m^2")), PLAIN]
CurvatureAlong = Annotated[float | Pairs, PlainValidator(VaryingDimension("1/m")), PLAIN]
ForceByLength = Annotated[float, PlainValidator(Dimension("N/m")), PLAIN]
RotationalStiffness = Annotated[float, PlainValidator(Dimension("N m/rad")), PLAIN]
# A plain number of radians goes with either kind of file.
Angle = Annotated[float, PlainValidator(lambda value: float(Dimension("rad")(value))), PLAIN]
Point = Annotated[tuple[Length, Length], Field(strict=False)]
Points = list[Point]


def known_keys(kind: type) -> BeforeValidator:
    """A validator: a table whose keys are fields of a dataclass."""

    def check(given: object) -> object:
        require_known(given, [field.name for field in fields(kind)])
        return given

    return BeforeValidator(check)


FileName = Annotated[str, AfterValidator(plain_name)]


class Table(BaseModel):
    """A table without unknown keys, whose numbers are numbers: no text, no boolean."""

    model_config = ConfigDict(
        extra="forbid", frozen=True, strict=True, defer_build=True, validate_default=True
    )

    @model_validator(mode="before")
    @classmethod
    def _require_known_keys(cls, given: object) -> object:
        require_known(given, cls.keys())
        return given

    @classmethod
    def keys(cls) -> list[str]:
        return [field.alias or name for name, field in cls.model_fields.items()]


def one_of_kinds(
    base: type[Table],
    made: Callable[[str], Callable[..., Any]],
    keys: Mapping[str, Mapping[str, Any]],
) -> Any:  # noqa: ANN401  # a union of tables
    """What a table may be that has one of several kinds: beside that what makes the kind takes."""
    kinds: list[Any] = []
    for kind, own in keys.items():
        takes = signature(made(kind)).parameters
        fields: dict[str, Any] = {"kind": (Literal[kind], ...)}
        for name, one in own.items():
            default = takes[name].default
            fields[name] = one, ... if default is Parameter.empty else default
        kinds.append(create_model(kind, __base__=base, **fields))
    return reduce(or_, kinds)


_Schema = TypeVar("_Schema", bound=Table)


def validated(schema: type[_Schema], tables: Mapping[str, Any], place: KeyPlace) -> _Schema:
    try:
        file = schema.model_validate(tables)
    except ValidationError as error:
        raise complaint(error, place) from error
    _require_units(file, place)
    return file


def _require_units(file: Table, place: KeyPlace) -> None:
    """Refuse dimensions with and without units side by side, also those left to a default."""
    found = [*_dimensions(file)]
    united = [key for (_, key), number, _ in found if isinstance(number, InSI)]
    bare = [(keys, stated) for keys, number, stated in found if isinstance(number, Bare)]
    if united and bare:
        keys, stated = max(bare, key=lambda one: one[1])  # the first that the file states
        given, remedy = "missing", "add it: its default is a number without a unit"
        if stated:
            given, remedy = "without a unit", "write all dimensions with units, or none"
        allowed = f"given with a unit, as {united[0]} is"
        raise InputError(place(keys), given, allowed, remedy)


def _dimensions(file: Table) -> Iterator[tuple[tuple[str, str], float, bool]]:
    """Each number but 0 that has a unit or should, with its keys and whether the file states it."""
    for name in _WITH_UNITS:
        table: Any = getattr(file, name, None)
        # A shape whose scale has a unit is itself in units of the scale, but for a mesh's offset.
        relative = name == "profile" and isinstance(getattr(table, "scale", None), InSI)
        for key, value in table or ():
            stated = key in table.model_fields_set
            for number in _numbers(value):
                factor = not stated if key == "scale" else relative and key != "offset"
                if isinstance(number, InSI) or (isinstance(number, Bare) and number and not factor):
                    yield (name, key), number, stated


def _numbers(value: object) -> Iterator[object]:
    """The numbers of a quantity, a pair of them, or a list of pairs."""
    if isinstance(value, list | tuple):
        for part in value:
            yield from _numbers(part)
    else:
        yield value
