"""What `vibrissa run` has left in a folder: both sweeps, their limits, the budget."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd
from pydantic import TypeAdapter

from analytic import InputError, Readings
from analytic.problem.files import regular_file
from compare.explain.budget import Budget
from compare.judge.spatial import GENERAL_IN_SPACE, SpatialTolerances
from compare.judge.tolerances import GENERAL, Limit, Tolerances
from compare.read.sweep_files import sweep_files
from compare.validate.validation import Validation

AnyTolerances = TypeVar("AnyTolerances", Tolerances, SpatialTolerances)

_LARGEST = 64_000_000  # bytes of a JSON file
_REMEDY = "run it again, with --out DIR"


@dataclass(frozen=True)
class StoredRun:
    """A run as its folder has it."""

    reference: Readings  # the closed form's sweep and MuJoCo's
    candidate: Readings  # the closed form's sweep and MuJoCo's
    tolerances: Tolerances  # those that the run was judged by; the defaults if it was not
    budget: Budget | None  # of the same sweeps, if it was measured
    validation: Validation | None  # of the same sweeps, if uncertainties were stated


def read_run(folder: Path) -> StoredRun:
    """Read the folder of a run, or two sweeps of one case."""
    reference, candidate = sweep_files(folder)
    return StoredRun(
        Readings.read(reference),
        Readings.read(candidate),
        read_limits(folder / "comparison.json", Tolerances),
        read_budget(folder / "budget.json") if (folder / "budget.json").exists() else None,
        _validation(folder),
    )


def read_limits(file: Path, kind: type[AnyTolerances]) -> AnyTolerances:
    """The limits that a run was judged by."""
    if not file.exists():
        return kind()
    found = read_json(file)
    in_plane = kind is Tolerances
    try:
        reasons = found["tolerance_reasons"]
        limits = {
            str(name): Limit(float(value), str(reasons[name]))
            for name, value in found["tolerances"].items()
        }
        if in_plane:
            limits.setdefault("lateness", Limit(0.0, "not asked"))  # of older runs
        names = GENERAL if in_plane else GENERAL_IN_SPACE
        general = {name: limits.pop(name) for name in names}
        return kind(**general, special=limits)
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise damaged(file, error) from error


def read_budget(file: Path) -> Budget:
    """A budget, as `vibrissa run --budget` wrote it."""
    try:
        return TypeAdapter(Budget).validate_python(read_json(file))
    except ValueError as error:
        raise damaged(file, error) from error


def _validation(folder: Path) -> Validation | None:
    file, table = folder / "comparison.json", folder / "validation.csv"
    if not (file.exists() and table.exists()):
        return None
    found = read_json(file)
    if not isinstance(found, dict) or "validation" not in found:
        return None
    try:
        regular_file(table, "file", _LARGEST)
        return TypeAdapter(Validation).validate_python(
            {**found["validation"], "table": pd.read_csv(table)}
        )
    except (OSError, ValueError, TypeError) as error:
        raise damaged(table, error) from error


def read_json(file: Path) -> Any:  # noqa: ANN401  # whatever the file holds
    """The content of a JSON file."""
    regular_file(file, "file", _LARGEST)
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise damaged(file, error) from error


def damaged(file: Path, error: Exception) -> InputError:
    """What to say of a file that cannot be read."""
    reason = " ".join(f"{type(error).__name__}: {error}".split())[:160]
    return InputError(f"file {file}", f"damaged ({reason})", "as the run wrote it", _REMEDY)
