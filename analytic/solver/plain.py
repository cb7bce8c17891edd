"""Sweeps of the paper's vibrissa, many at once."""

from collections.abc import Sequence
from functools import cache, partial
from importlib.metadata import version
from itertools import accumulate, pairwise

import numpy as np

from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS, COLUMNS, PHASES, STATUSES
from analytic.problem.contours.many import Contours
from analytic.problem.readings import Readings
from analytic.problem.table import as_table, mirrored_columns
from analytic.solver.branch import trace
from analytic.solver.equilibria import Numbers, Units, to_columns
from analytic.solver.general.residuals import SOLVED
from analytic.solver.residuals import residuals
from analytic.solver.stations import solve_stations

_ROUNDING = 4 * float(np.finfo(float).eps)  # of a foot position that stands on the snap-off


def solve_plain(given: Sequence[Case]) -> list[Readings]:
    """Solve sweeps, those to the right as their mirror images.

    In a sweep to the left the vibrissa is free right of the first contact and left of the
    snap-off. Between them the foot position falls along the equilibria, so that each station has
    one state.
    """
    cases = [case if case.sweep.direction == "left" else case.mirrored() for case in given]
    counts = [case.sweep.stations for case in cases]
    whose = np.repeat(np.arange(len(cases)), counts)
    units = np.array([Units.of(case.beam) for case in cases]).T[:, whose]
    foot_x = np.concatenate([case.foot_x for case in cases])
    centrelines = Contours([case.centreline for case in cases])
    branches = trace(centrelines, [case.reach for case in cases])
    places = foot_x / Units(*units).length
    first = np.array([branch.foot_x[0] for branch in branches])
    last = np.array([branch.foot_x[-1] for branch in branches])
    last -= _ROUNDING * np.maximum(1.0, np.abs(last))
    touching = (places < first[whose]) & (places >= last[whose])
    columns = _free(foot_x)
    if touching.any():
        bounds = pairwise([0, *accumulate(counts)])
        held = [places[begin:end][touching[begin:end]] for begin, end in bounds]
        states = solve_stations(centrelines, branches, held)
        solved = to_columns(states, Units(*units[:, touching]))
        for name in COLUMNS[1:]:
            columns[name][touching] = solved[name]
    checked = residuals(columns, ~touching, Units(*units))
    wrong = ~(np.maximum(*checked.values()) <= SOLVED)
    columns["status"][wrong] = STATUSES.index("diverged")
    columns |= checked
    # Beyond the largest number in the case's units: an error says so.
    finite = not any(np.isinf(x).any() for x in columns.values())
    found, begin = [], 0
    for case, count, branch in zip(given, counts, branches, strict=True):
        # Copies: readings that are kept do not keep those of all.
        own = {name: x[begin : begin + count].copy() for name, x in columns.items()}
        way = 1.0 if case.sweep.direction == "left" else -1.0
        events = {name: None if x is None else way * x for name, x in branch.events().items()}
        own = own if way > 0 else mirrored_columns(own)
        record = partial(provenance, case, events)
        if finite:
            snap_off = way * float(branch.foot_x[-1]) * case.beam.length
            found.append(Readings.solved(own, case.beam, "analytic", record, snap_off))
        else:
            found.append(Readings(as_table(own), case.beam, "analytic", record()))
        begin += count
    return found


def provenance(case: Case, events: dict[str, float | None]) -> dict[str, object]:
    """What the closed form records of a sweep."""
    length = case.beam.length
    return {
        **case.provenance(),
        "engine": _engine(),
        "events": {name: None if x is None else x * length for name, x in events.items()},
    }


@cache
def _engine() -> str:
    return f"vibrissa-testbed {version('vibrissa-testbed')}"


def _free(foot_x: Numbers) -> dict[str, Numbers]:
    """The readings of vibrissae that touch nothing."""
    empty = np.full((len(COLUMNS), foot_x.size), np.nan)
    columns: dict[str, Numbers] = dict(zip(COLUMNS, empty, strict=True))
    columns["foot_x"] = foot_x
    for name in CLAMP_READINGS:
        columns[name].fill(0.0)
    columns["phase"] = np.full(foot_x.size, PHASES.index("free"))
    columns["tip_angle"] = np.full(foot_x.size, np.pi / 2)
    columns["status"] = np.full(foot_x.size, STATUSES.index("ok"))
    return columns
