"""Tolerances as data: a ``[tolerances]`` table of a TOML file, every limit with its reason."""

import difflib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from analytic import InputError
from compare.judge.spatial import SpatialTolerances
from compare.judge.tolerances import Limit, Tolerances
from compare.read.toml import Place, TomlFile

_Limits = TypeVar("_Limits", Tolerances, SpatialTolerances)


def read_tolerances(path: Path, kind: type[_Limits]) -> _Limits:
    """The ``[tolerances]`` table of a TOML file; other tables do not matter."""
    file = TomlFile.read(path, "tolerance file")
    if "tolerances" not in file.tables:
        raise InputError(f"{path}: [tolerances]", "missing", "given", "add the table")
    return tolerances_of(file.tables["tolerances"], file.place, kind)


def tolerances_of(table: Mapping[str, Any], place: Place, kind: type[_Limits]) -> _Limits:
    """What a ``[tolerances]`` table says; what it leaves out keeps its default."""
    names = [one.name for one in fields(kind) if one.name != "special"]
    general: dict[str, Limit] = {}
    special: dict[str, Limit] = {}
    for keys, limit in _limits(table, (), place):
        name = ".".join(keys)
        if len(keys) > 1:
            special[name] = limit
        elif name in names:
            general[name] = limit
        else:
            near = difflib.get_close_matches(name, names, n=1)
            raise InputError(
                place(["tolerances", name]),
                "unknown",
                f"one of {', '.join(names)}",
                f"did you mean {near[0]}?" if near else "remove it",
            )
    return kind(**general, special=special)


def _limits(
    table: Mapping[str, Any], keys: tuple[str, ...], place: Place
) -> Iterator[tuple[tuple[str, ...], Limit]]:
    for key, value in table.items():
        here: Sequence[str] = ("tolerances", *keys, key)
        if not isinstance(value, dict):
            raise InputError(
                place(here),
                repr(value),
                'a limit with its reason, { limit = 1e-3, reason = "..." }',
                "say why it is as large as it is",
            )
        if "limit" not in value:
            yield from _limits(value, (*keys, key), place)
            continue
        reason = value.get("reason")
        if set(value) - {"limit", "reason"} or not (isinstance(reason, str) and reason.strip()):
            raise InputError(
                place(here), repr(value), "a limit and a reason", "say why it is as large as it is"
            )
        number = value["limit"]
        if isinstance(number, bool) or not isinstance(number, int | float) or not number >= 0:
            raise InputError(place([*here, "limit"]), repr(number), "0 or more", "correct it")
        yield (*keys, key), Limit(float(number), reason)
