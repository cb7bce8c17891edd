"""A case file with what a calibration has found, to be used where the case was."""

import json
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from analytic import Beam, Calibration
from analytic.from_clamp.noise import DOUBLE_SIDED_95
from analytic.problem.quantities import QUANTITIES
from compare.read.tables import PLACES
from compare.read.units import in_si
from compare.validate.stated import INPUTS

CASE_MARK = "# Written by `vibrissa calibrate`"
"""The first line of a case file that is not a user's own."""

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def calibrated_case(
    tables: Mapping[str, Any], folder: Path, found: Calibration, before: Beam
) -> str:
    """The file of a case, from its tables: with the numbers found, and how well they are known.

    `folder` is where the files that it names are, `before` the vibrissa as it was.
    """
    filled: dict[str, Any] = {name: _with_place(table, folder) for name, table in tables.items()}
    if "length" in found.found:
        filled["beam"] = _stretched(filled.get("beam", {}), found.case.beam, before)
    for name, one in found.found.items():
        if name not in PLACES:
            continue
        table, key = PLACES[name]
        changed = filled[table] = {**filled.get(table, {})}
        if one.value == float("inf"):  # a rigid clamp is stated by no stiffness
            changed.pop(key, None)
            continue
        unit = QUANTITIES[name].dimension if found.case.beam.si else ""
        if isinstance(changed.get(key), list):  # it varies along the vibrissa
            changed[key] = [
                [s, _scaled(x, one.value / before.base_rigidity, unit)] for s, x in changed[key]
            ]
        else:
            changed[key] = _quantity(one.value, unit)
        half = (one.highest - one.lowest) / 2 / DOUBLE_SIDED_95
        if name in INPUTS and half < float("inf") and filled.get("uncertainty"):
            stated = {name: {"standard": _quantity(half, unit)}}
            filled["uncertainty"] = {**filled["uncertainty"], **stated}
    head = f"{CASE_MARK}: {found.case.name} with {', '.join(found.found)} from {found.stations}"
    return f"{head} stations\n{as_toml(filled)}"


def as_toml(tables: Mapping[str, Any]) -> str:
    lines = [f"{_key(k)} = {_value(x)}" for k, x in tables.items() if not isinstance(x, Mapping)]
    for name, table in tables.items():
        if isinstance(table, Mapping):
            lines += ["", f"[{_key(name)}]"]
            lines += [f"{_key(k)} = {_value(x)}" for k, x in table.items()]
    return "\n".join(lines) + "\n"


def _with_place(table: object, folder: Path) -> object:
    """A table whose file is found from elsewhere, too."""
    if isinstance(table, list):
        return [_with_place(one, folder) for one in table]
    if isinstance(table, Mapping) and isinstance(file := table.get("file"), str):
        path = (folder / file).absolute()
        return {**table, "file": str(path)} if path.exists() else table
    return table


def _quantity(value: float, unit: str) -> float | str:
    return f"{value:.9g} {unit}" if unit else float(f"{value:.9g}")


def _scaled(value: float | str, factor: float, unit: str) -> float | str:
    return _quantity((in_si(value, unit) if isinstance(value, str) else value) * factor, unit)


def _stretched(table: Mapping[str, Any], beam: Beam, before: Beam) -> dict[str, Any]:
    """What varies along the vibrissa is stretched with it; a radius that was not stated is not."""
    unit, factor = "m" if beam.si else "", beam.length / before.length
    varying = {
        name: [[_scaled(s, factor, unit), x] for s, x in value]
        for name, value in table.items()
        if isinstance(value, list)
    }
    return {"radius": _quantity(beam.radius, unit), **table, **varying}


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else json.dumps(name, ensure_ascii=False)


def _value(value: Any) -> str:  # noqa: ANN401  # whatever TOML has
    match value:
        case str():
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case bool():
            return str(value).lower()
        case list() | tuple():
            return f"[{', '.join(map(_value, value))}]"
        case Mapping():
            return f"{{ {', '.join(f'{_key(k)} = {_value(x)}' for k, x in value.items())} }}"
    return repr(value)
