"""Tolerances as data: a ``[tolerances]`` table of a TOML file, every limit with its reason."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Annotated, Any, TypeVar

from pydantic import Field, StringConstraints, ValidationError

from analytic import InputError
from analytic.problem.errors import near
from compare.judge.tolerances import Limit, SpatialTolerances, Tolerances
from compare.read.complaints import complaint
from compare.read.quantities import Table
from compare.read.toml import KeyPlace, TomlFile

_Limits = TypeVar("_Limits", Tolerances, SpatialTolerances)


class LimitTable(Table):
    limit: Annotated[float, Field(ge=0)]
    reason: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1)]


def read_tolerances(path: Path, kind: type[_Limits]) -> _Limits:
    """The ``[tolerances]`` table of a TOML file; other tables do not matter."""
    file = TomlFile.read(path, "tolerance file")
    return tolerances_of(file.table("tolerances"), file.place, kind)


def tolerances_of(table: Mapping[str, Any], place: KeyPlace, kind: type[_Limits]) -> _Limits:
    """What a ``[tolerances]`` table says; what it leaves out keeps its default."""
    general: dict[str, Limit] = {}
    special: dict[str, Limit] = {}
    keys: tuple[str, ...]
    for keys, said in _limits(table):
        where = ("tolerances", *keys)
        if len(keys) == 1 and keys[0] not in kind.general():
            allowed = f"one of {', '.join(kind.general())}"
            raise InputError(place(where), "unknown", allowed, near(keys[0], kind.general()))
        if not isinstance(said, dict):
            allowed = 'a limit with its reason, { limit = 1e-3, reason = "..." }'
            raise InputError(place(where), repr(said), allowed, "say why it is as large as it is")
        try:
            found = LimitTable.model_validate(said)
        except ValidationError as error:
            raise complaint(error, place, where) from error
        limits = general if len(keys) == 1 else special
        limits[".".join(keys)] = Limit(found.limit, found.reason)
    return kind(**general, special=special)


def _limits(table: Mapping[str, Any], *outer: str) -> Iterator[tuple[tuple[str, ...], object]]:
    """What stands for a limit in a table, and in the tables in it."""
    for key, value in table.items():
        if isinstance(value, dict) and "limit" not in value:
            yield from _limits(value, *outer, key)
        else:
            yield (*outer, key), value
