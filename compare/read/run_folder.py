"""What a run has left in its folder: sweeps, limits, budget, validation, body."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pandas as pd
from pydantic import TypeAdapter, ValidationError

from analytic import InputError, Readings
from analytic.problem.arrays import Floats
from analytic.problem.files import regular_file
from analytic.space import SpatialReadings
from compare.align.frames import Frame
from compare.explain.budget import Budget
from compare.explain.split_space import Parts
from compare.judge.spatial import GENERAL_IN_SPACE, SpatialTolerances
from compare.judge.tolerances import GENERAL, Limit, Tolerances
from compare.read.space_readings import is_spatial
from compare.read.sweep_files import sweep_files
from compare.validate.validation import Validation

AnyTolerances = TypeVar("AnyTolerances", Tolerances, SpatialTolerances)
_T = TypeVar("_T")

_LARGEST = 64_000_000  # bytes of a JSON file
_REMEDY = "run it again, or remove its folder"


@dataclass(frozen=True)
class StoredRun:
    """A run in the plane as its folder has it."""

    reference: Readings  # the closed form's sweep and MuJoCo's
    candidate: Readings  # the closed form's sweep and MuJoCo's
    tolerances: Tolerances  # those that the run was judged by; the defaults if it was not
    budget: Budget | None  # of the same sweeps, if it was measured
    validation: Validation | None  # of the same sweeps, if uncertainties were stated


@dataclass(frozen=True)
class StoredSpatialRun:
    """A run in space as its folder has it."""

    reference: SpatialReadings  # the closed form's sweep and MuJoCo's
    candidate: SpatialReadings  # the closed form's sweep and MuJoCo's
    tolerances: SpatialTolerances  # those that the run was judged by; the defaults if it was not
    frame: Frame  # that the components were compared in
    parts: Parts | None  # of the same sweeps, if they were measured
    body: Floats | None  # shape (triangles, 3, 3); what the run's pictures showed of the body


def read_run(folder: Path) -> StoredRun | StoredSpatialRun:
    """Read the folder of a run, or of the two sweeps of one case that nobody compared yet."""
    reference, candidate = sweep_files(folder)
    judged = folder / "comparison.json"
    if is_spatial(reference):
        return StoredSpatialRun(
            SpatialReadings.read(reference),
            SpatialReadings.read(candidate),
            _limits(judged, SpatialTolerances),
            _frame(judged),
            read_stored_if_there(folder / "budget.json", Parts),
            _body(folder / "body.ply"),
        )
    return StoredRun(
        Readings.read(reference),
        Readings.read(candidate),
        _limits(judged, Tolerances),
        read_stored_if_there(folder / "budget.json", Budget),
        _validation(folder),
    )


def read_stored(file: Path, kind: type[_T]) -> _T:
    """What a JSON file of a run holds, as what it was written from."""
    content = _json(file)
    try:
        return TypeAdapter(kind).validate_python(content)
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "the whole"
        raise _damaged(file, f"{where}: {first['msg']}") from error


def read_stored_if_there(file: Path, kind: type[_T]) -> _T | None:
    """The same; None if there is no such file."""
    return read_stored(file, kind) if file.exists() else None


def _limits(file: Path, kind: type[AnyTolerances]) -> AnyTolerances:
    """The limits that a run was judged by."""
    if not file.exists():
        return kind()
    found = _json(file)
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
        raise _damaged(file, error) from error


def _validation(folder: Path) -> Validation | None:
    file, table = folder / "comparison.json", folder / "validation.csv"
    if not (file.exists() and table.exists()):
        return None
    found = _json(file)
    if not isinstance(found, dict) or "validation" not in found:
        return None
    try:
        regular_file(table, "file", _LARGEST)
        return TypeAdapter(Validation).validate_python(
            {**found["validation"], "table": pd.read_csv(table)}
        )
    except (OSError, ValueError, TypeError) as error:
        raise _damaged(table, error) from error


def _frame(file: Path) -> Frame:
    content = _json(file) if file.exists() else {"frame": "world"}
    found = content.get("frame") if isinstance(content, dict) else None
    if found not in ("world", "clamp"):
        raise _damaged(file, "frame is neither world nor clamp")
    return "clamp" if found == "clamp" else "world"


def _body(file: Path) -> Floats | None:
    if not file.exists():
        return None
    from trimesh import load_mesh  # slow to load

    try:
        found = load_mesh(file, process=False)
        faces = np.asarray(found.vertices, dtype=float)[found.faces]
    except Exception as error:  # a parser of foreign bytes may raise anything
        raise _damaged(file, error) from error
    if faces.shape[1:] != (3, 3) or not np.isfinite(faces).all():
        raise _damaged(file, "no triangles")
    return faces


def _json(file: Path) -> Any:  # noqa: ANN401  # whatever the file holds
    regular_file(file, "file", _LARGEST)
    try:
        return json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError, RecursionError) as error:
        raise _damaged(file, error) from error


def _damaged(file: Path, fault: Exception | str) -> InputError:
    said = fault if isinstance(fault, str) else f"{type(fault).__name__}: {fault}"
    reason = " ".join(said.split())[:160]
    return InputError(f"file {file}", f"damaged ({reason})", "as a run wrote it", _REMEDY)
