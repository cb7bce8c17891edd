"""The sweep on given foot positions: every station solved, checked and put into one table."""

from dataclasses import replace

import numpy as np

from analytic.checks.certificate import certify
from analytic.problem.case import Case
from analytic.problem.columns import STATUS_NUMBER
from analytic.problem.errors import require
from analytic.problem.readings import Readings, are_finite
from analytic.solver.columns import Units
from analytic.solver.general import sweep as general
from analytic.solver.general.states import Vibrissa
from analytic.solver.plain import solve_plain
from analytic.solver.recorded import as_readings
from analytic.solver.residuals import inexact, residuals

_CERTIFIED = 1e-9  # L and EI/L; the integration is good to 1e-12


def solve_sweep(case: Case, certified: bool = False) -> Readings:
    """The readings of `case` in closed form, at its stations.

    Parameters
    ----------
    case : Case
        The problem.
    certified : bool
        Whether each station is to be checked by integration from the clamp too (`certify`).

    Returns
    -------
    Readings
        In the units of the case's beam; source ``"analytic"``. The table has two more columns,
        dimensionless and zero where the vibrissa is free. ``residual_boundary`` is the largest miss
        of the contact's position, arc length, slope and direction of force, of the arc length
        beyond L and of the tip's angle below the contour's; ``residual_moment`` is that of the
        balance of moments. They come from the clamp readings by the closed form; if `certified`,
        they are the larger ones of that and of the integration. ``status`` is ``"diverged"`` where
        one exceeds 1e-11 by the closed form or 1e-9 by the integration, else ``"ok"``. Where a
        vibrissa that is curved at rest would touch the object in a second place, or one that has
        let go would lie in it, as a cone may that lets go early, it is ``"touches again"``, without
        readings. Where friction would not let it slide on as its foot moves, it
        is ``"sticks"``, with the readings of one that does: those depend on what was before.
    """
    require("case", case, Case, "named_case('catenary') makes one")
    readings = solve_plain([case])[0] if case.is_plain else _solve_general(case)
    return _with_certificate(readings) if certified else readings


def _solve_general(case: Case) -> Readings:
    leftward = case if case.direction == "left" else case.mirrored()
    columns, events = general.solve(leftward)[:2]
    columns |= leftward.way_columns
    checked = residuals(columns, Vibrissa.of_case(leftward), Units.of(case.beam))
    columns["status"][inexact(checked, columns["status"])] = STATUS_NUMBER["diverged"]
    columns |= checked
    return as_readings(case, columns, events, are_finite(columns))


def _with_certificate(readings: Readings) -> Readings:
    found = certify(readings)
    stated = readings.table["status"].isin(["ok", "sticks"])  # the others have no readings
    wrong = stated & ~(found.max(axis=1) <= _CERTIFIED)
    table = readings.table.assign(status=readings.table["status"].mask(wrong, "diverged"))
    for name in found:
        table[name] = np.fmax(table[name], found[name])
    return replace(readings, table=table)
