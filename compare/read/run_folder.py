"""What a run has left in its folder: sweeps, limits, budget, validation, body."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
import pandas as pd
from pydantic import BaseModel, TypeAdapter, ValidationError

from analytic import InputError, Readings
from analytic.numerics.arrays import Floats
from analytic.problem.files import regular_file
from analytic.space import SpatialReadings
from compare.align.frames import Frame
from compare.explain.budget import Budget
from compare.explain.parts import Parted
from compare.judge.tolerances import Limit, SpatialTolerances, Tolerances
from compare.read.space_readings import is_spatial
from compare.validate.validation import Validation

AnyTolerances = TypeVar("AnyTolerances", Tolerances, SpatialTolerances)
_T = TypeVar("_T")

_LARGEST = 64_000_000  # bytes of a JSON file
_REMEDY = "run it again, or remove its folder"


@dataclass(frozen=True)
class StoredRun:
    reference: Readings | SpatialReadings  # the closed form's sweep and MuJoCo's
    candidate: Readings | SpatialReadings
    # Those that the run was judged by; the defaults if it was not.
    tolerances: Tolerances | SpatialTolerances
    frame: Frame  # that the components were compared in
    budget: Parted | None  # of the same sweeps, if it was measured
    validation: Validation | None  # of the same sweeps, if uncertainties were stated
    body: Floats | None  # shape (triangles, 3, 3); what the run's pictures showed of the body


def read_run(folder: Path) -> StoredRun:
    """Read the folder of a run, or of the two sweeps of one case that nobody compared yet."""
    reference, candidate = _sweeps(folder)
    judged = read_stored_if_there(folder / "comparison.json", _Judged) or _NOT_JUDGED
    in_space = is_spatial(reference)
    sweep = SpatialReadings if in_space else Readings
    return StoredRun(
        sweep.read(reference),
        sweep.read(candidate),
        judged.limits(SpatialTolerances) if in_space else judged.limits(Tolerances),
        judged.frame,
        read_stored_if_there(folder / "budget.json", Parted if in_space else Budget),
        _validation(folder, judged),
        _body(folder / "body.ply"),
    )


def _sweeps(folder: Path) -> tuple[Path, Path]:
    found = [*folder.glob("mujoco-*.parquet")]
    whole = [path for path in found if not path.name.endswith(".partial.parquet")]
    if not (folder / "analytic.parquet").is_file() or len(whole) != 1:
        sweeps = sorted(path.name for path in folder.glob("*.parquet"))
        there = ", ".join(sweeps) or "no sweep"
        allowed = "the folder of one run, with analytic.parquet and one mujoco-BEAM.parquet"
        remedy = "make one: vibrissa run CASE --out DIR"
        if len(sweeps) > 1:
            remedy += "; of other engines' sweeps, vibrissa compare A.parquet B.parquet"
        raise InputError("DIR", f"{folder} ({there[:200]})", allowed, remedy)
    return folder / "analytic.parquet", whole[0]


def read_stored(file: Path, kind: type[_T]) -> _T:
    """What a JSON file of a run holds, as what it was written from."""
    regular_file(file, "file", _LARGEST)
    try:
        return TypeAdapter(kind).validate_python(json.loads(file.read_text(encoding="utf-8")))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(map(str, first["loc"])) or "the whole"
        raise _damaged(file, f"{where}: {first['msg']}") from error
    except (OSError, ValueError, RecursionError) as error:
        raise _damaged(file, error) from error


def read_stored_if_there(file: Path, kind: type[_T]) -> _T | None:
    return read_stored(file, kind) if file.exists() else None


class PassesRecord(BaseModel):
    """What is looked at of a ``passes.json``."""

    passes: list[dict[str, Any]]


class _Judged(BaseModel):
    """What is looked at of a ``comparison.json``."""

    tolerances: dict[str, float]
    tolerance_reasons: dict[str, str]
    frame: Frame = "world"
    validation: dict[str, Any] | None = None

    def limits(self, kind: type[AnyTolerances]) -> AnyTolerances:
        limits = {n: Limit(x, self.tolerance_reasons[n]) for n, x in self.tolerances.items()}
        general = {name: limits.pop(name) for name in kind.general() if name in limits}
        return kind(**general, special=limits)


_NOT_JUDGED = _Judged(tolerances={}, tolerance_reasons={})


def _validation(folder: Path, judged: _Judged) -> Validation | None:
    table = folder / "validation.csv"
    if judged.validation is None or not table.exists():
        return None
    try:
        regular_file(table, "file", _LARGEST)
        stored = {**judged.validation, "table": pd.read_csv(table)}
        return TypeAdapter(Validation).validate_python(stored)
    except (OSError, ValueError, TypeError) as error:
        raise _damaged(table, error) from error


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


def _damaged(file: Path, fault: Exception | str) -> InputError:
    said = fault if isinstance(fault, str) else f"{type(fault).__name__}: {fault}"
    reason = " ".join(said.split())[:160]
    return InputError(f"file {file}", f"damaged ({reason})", "as a run wrote it", _REMEDY)
