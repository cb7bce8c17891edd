"""Solved columns as readings, with what is recorded of the sweep."""

from collections.abc import Mapping
from functools import cache, partial
from importlib.metadata import version

import numpy as np

from analytic.problem.case import Case
from analytic.problem.readings import Readings, solved_readings
from analytic.problem.table import as_table, mirrored_columns
from analytic.solver.columns import ReadingColumns

Points = Mapping[str, float | None]
"""Parameters of the clamp's way of what happens, by name; foot positions [L] of a sweep."""


def are_finite(columns: ReadingColumns) -> bool:
    """Whether no number is beyond the largest one, as it may be in the case's units."""
    return not any(np.isinf(x).any() for x in columns.values())


def as_readings(case: Case, columns: ReadingColumns, events: Points, finite: bool) -> Readings:
    """The readings of a case whose sweep to the left, or its mirror image's, is solved."""
    own = columns if case.direction == "left" else mirrored_columns(columns)
    places = {n: None if x is None else case.running_at(x) for n, x in events.items()}
    record = partial(_provenance, case, places)
    if finite:
        return solved_readings(own, case.beam, "analytic", record, places["snap_off"])
    return Readings(as_table(own), case.beam, "analytic", record())


def _provenance(case: Case, events: Points) -> dict[str, object]:
    return {**case.provenance(), "engine": _engine(), "events": dict(events)}


@cache
def _engine() -> str:
    return f"vibrissa-testbed {version('vibrissa-testbed')}"
