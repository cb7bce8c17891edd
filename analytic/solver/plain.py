"""Sweeps of the paper's vibrissa, many at once: the accelerator of `analytic.solver.general`."""

from collections.abc import Sequence
from itertools import accumulate, pairwise

import numpy as np

from analytic.problem.case import Case
from analytic.problem.columns import COLUMNS, STATUS_NUMBER
from analytic.problem.contours.many import Contours
from analytic.problem.readings import Readings, are_finite
from analytic.solver.branch import trace
from analytic.solver.columns import Units, to_columns, unloaded_columns
from analytic.solver.general.path import located
from analytic.solver.general.states import Vibrissa
from analytic.solver.recorded import as_readings
from analytic.solver.residuals import inexact, residuals
from analytic.solver.stations import solve_stations

_ROUNDING = 4 * float(np.finfo(float).eps)  # of a foot position that stands on the snap-off


def solve_plain(given: Sequence[Case]) -> list[Readings]:
    """Solve sweeps, those to the right as their mirror images."""
    cases = [case if case.sweep.direction == "left" else case.mirrored() for case in given]
    counts = [case.sweep.stations for case in cases]
    whose = np.repeat(np.arange(len(cases)), counts)
    units = Units.of_each([case.beam for case in cases], whose)
    radius = np.array([case.radius for case in cases])[whose]
    foot_x = np.concatenate([case.foot_x for case in cases])
    contours = Contours([case.centreline for case in cases])
    branches = trace(contours, [case.reach for case in cases])
    places = foot_x / units.length
    first = np.array([branch.foot_x[0] for branch in branches])
    last = np.array([branch.foot_x[-1] for branch in branches])
    last -= _ROUNDING * np.maximum(1.0, np.abs(last))
    touching = (places < first[whose]) & (places >= last[whose])
    columns = unloaded_columns(foot_x)
    bounds = [*pairwise([0, *accumulate(counts)])]
    if touching.any():
        held = [places[begin:end][touching[begin:end]] for begin, end in bounds]
        found = solve_stations(contours, branches, held).states(Vibrissa(radius=radius[touching]))
        solved = to_columns(found, units.part(touching))
        for name in COLUMNS[1:]:
            columns[name][touching] = solved[name]
    checked = residuals(columns, Vibrissa(radius=radius), units)
    columns["status"][inexact(checked, columns["status"])] = STATUS_NUMBER["diverged"]
    columns |= checked
    finite = are_finite(columns)
    readings = []
    for case, (begin, end), branch in zip(given, bounds, branches, strict=True):
        # Copies: readings that are kept do not keep those of all.
        own = {name: x[begin:end].copy() for name, x in columns.items()}
        events = located(branch.events(), branch.foot_x)
        readings.append(as_readings(case, own, events, finite))
    return readings
