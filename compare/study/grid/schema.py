"""The tables of a study file: their keys, types and limits."""

from typing import Annotated, Any

from pydantic import Field

from compare.read.quantities import FileName, Table
from compare.study.grid.axes import Sample
from compare.study.grid.study import Record

# A day: no sweep of this project takes so long, and the alarm that ends a run must not overflow.
_LONGEST = 86_400.0


class StudyTable(Table):
    """The table ``[study]``."""

    name: FileName | None = None
    case: str | None = None
    beams: list[str] | None = None
    record: Annotated[list[Record], Field(min_length=1)] | None = None
    keep_readings: bool = False
    timeout: Annotated[float, Field(gt=0, le=_LONGEST)] = 600.0
    zip: list[list[str]] = Field(default_factory=list)


class StudyFile(Table):
    """A whole study file; those of a run are checked as those of a case file are."""

    study: StudyTable = StudyTable()
    axes: Annotated[dict[str, Any], Field(min_length=1)] | None = None
    sample: Sample | None = None
    beam: dict[str, Any] = Field(default_factory=dict)
    support: dict[str, Any] = Field(default_factory=dict)
    contact: dict[str, Any] = Field(default_factory=dict)
    profile: dict[str, Any] = Field(default_factory=dict)
    sweep: dict[str, Any] = Field(default_factory=dict)
    mujoco: dict[str, Any] = Field(default_factory=dict)
    motion: dict[str, Any] = Field(default_factory=dict)
    engine: dict[str, Any] = Field(default_factory=dict)
    body: dict[str, Any] = Field(default_factory=dict)
    path: dict[str, Any] = Field(default_factory=dict)
    noise: dict[str, Any] = Field(default_factory=dict)
    reconstruction: dict[str, Any] = Field(default_factory=dict)


RUN_TABLES = (*StudyFile.model_fields,)[3:]
"""Those of a run."""
