"""The tables of a study file: their keys, types and limits, and what is wrong with a file."""

import difflib
from collections.abc import Sequence
from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from analytic import InputError
from compare.read.toml import Place
from compare.study.grid.axes import Range, Sample
from compare.study.grid.sensor import SensorNoise
from compare.study.grid.study import Record

CASE_TABLES = ("beam", "profile", "sweep", "mujoco")
# A day: no sweep of this project takes so long, and the alarm that ends a run must not overflow.
_LONGEST = 86_400.0


class StudyTable(BaseModel):
    """The table ``[study]``."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    # A name is the name of a folder too, and must not lead out of the one where results go.
    name: Annotated[str, Field(pattern=r"^[^./\\\x00-\x1f][^/\\\x00-\x1f]{0,99}$")] | None = None
    case: str | None = None
    beams: list[str] | None = None
    record: Annotated[list[Record], Field(min_length=1)] | None = None
    keep_readings: bool = False
    timeout: Annotated[float, Field(gt=0, le=_LONGEST)] = 600.0
    zip: list[list[str]] = []


class StudyFile(BaseModel):
    """A whole study file; the tables of the case are checked as those of a case file are."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)

    study: StudyTable = StudyTable()
    axes: Annotated[dict[str, Any], Field(min_length=1)] | None = None
    sample: Sample | None = None
    noise: SensorNoise = SensorNoise()
    beam: dict[str, Any] = {}
    profile: dict[str, Any] = {}
    sweep: dict[str, Any] = {}
    mujoco: dict[str, Any] = {}


_TABLES: dict[str, type[BaseModel]] = {
    "": StudyFile,
    "study": StudyTable,
    "sample": Sample,
    "noise": SensorNoise,
    "axes": Range,
}


def complaint(error: ValidationError, place: Place, outer: Sequence[str] = ()) -> InputError:
    """Put a validation error of the study's own tables into one line.

    Parameters
    ----------
    error : ValidationError
        What pydantic found.
    place : callable
        What an error calls a key.
    outer : sequence of str, optional
        The key whose value was checked, if it was not the whole file.

    Returns
    -------
    InputError
        The first error, with its line.
    """
    # A misspelt key also leaves one missing: the misspelling is the cause.
    first = min(error.errors(), key=lambda found: found["type"] != "extra_forbidden")
    where = list(outer) or [str(part) for part in first["loc"]]
    name, value = place(where), repr(first["input"])
    match first["type"]:
        case "extra_forbidden":
            wrong = str(first["loc"][-1])
            table = _TABLES["" if len(where) == 1 else where[0]]
            allowed = [field.alias or key for key, field in table.model_fields.items()]
            near = difflib.get_close_matches(wrong, allowed, n=1)
            remedy = f"did you mean {near[0]}?" if near else f"remove {wrong}"
            return InputError(name, value, f"one of the keys {', '.join(allowed)}", remedy)
        case "missing":
            return InputError(name, "without " + str(first["loc"][-1]), "complete", "add it")
        case "string_pattern_mismatch":
            return InputError(
                name, value, "up to 100 characters without / and \\, not a dot first",
                "it is the name of a folder too",
            )  # fmt: skip
    return InputError(name, value, first["msg"].removeprefix("Input should be "), "correct it")
