"""Solved columns as readings, with what is recorded of the sweep."""

from collections.abc import Mapping
from functools import cache, partial
from importlib.metadata import version

from analytic.problem.case import Case
from analytic.problem.readings import Readings, solved_readings
from analytic.solver.columns import ReadingColumns

Points = Mapping[str, float | None]
"""Parameters of the clamp's way of what happens, by name; foot positions [L] of a sweep."""


def as_readings(case: Case, columns: ReadingColumns, events: Points, finite: bool) -> Readings:
    """The readings of a case whose sweep to the left, or its mirror image's, is solved."""
    if case.direction == "right":
        from analytic.problem.table import mirrored_columns  # slow to load, and few sweeps need it

        columns = mirrored_columns(columns)
    places = {n: None if x is None else case.running_at(x) for n, x in events.items()}
    record = partial(_provenance, case, places)
    return solved_readings(columns, case.beam, "analytic", record, places["snap_off"], finite)


def _provenance(case: Case, events: Points) -> dict[str, object]:
    return {**case.provenance(), "engine": engine(), "events": dict(events)}


@cache
def engine() -> str:
    return f"vibrissa-testbed {version('vibrissa-testbed')}"
