"""The sweep on given foot positions: every station solved, checked and put into one table."""

from dataclasses import replace

import numpy as np
import pandas as pd

from analytic.checks.certificate import certify
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS, COLUMNS
from analytic.problem.errors import require
from analytic.problem.mirror import solve_either_way
from analytic.problem.readings import Readings
from analytic.solver.equilibria import Column
from analytic.solver.general import sweep as general
from analytic.solver.general.residuals import SOLVED, residuals
from analytic.solver.general.states import Vibrissa
from analytic.solver.plain import provenance, solve_plain

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
    plain = case.is_plain
    readings = solve_plain([case])[0] if plain else solve_either_way(case, _solve_general)
    return _with_certificate(readings) if certified else readings


def _solve_general(case: Case) -> Readings:
    """With friction, an elastic clamp, a natural curvature, or what varies along the vibrissa."""
    columns = _free(case)
    solved = general.solve(case)
    for name in COLUMNS[1:]:
        columns[name][solved.where] = solved.columns[name]
    vibrissa = Vibrissa.of(case.beam, case.clamp_stiffness, case.friction)
    checked = residuals(columns, case.beam, vibrissa)
    inexact = np.maximum(*checked.values()) > SOLVED
    columns["status"][inexact] = "diverged"
    table = pd.DataFrame({**columns, **checked})
    return Readings(table, case.beam, "analytic", provenance(case, solved.events))


def _with_certificate(readings: Readings) -> Readings:
    found = certify(readings)
    stated = readings.table["status"].isin(["ok", "sticks"])  # the others have no readings
    wrong = stated & ~(found.max(axis=1) <= _CERTIFIED)
    table = readings.table.assign(status=readings.table["status"].mask(wrong, "diverged"))
    for name in found:
        table[name] = np.fmax(table[name], found[name])
    return replace(readings, table=table)


def _free(case: Case) -> dict[str, Column]:
    """The readings of a vibrissa that touches nothing."""
    count = len(case.foot_x)
    columns: dict[str, Column] = {name: np.full(count, np.nan) for name in COLUMNS}
    columns["foot_x"] = case.foot_x
    for name in CLAMP_READINGS:
        columns[name] = np.zeros(count)
    columns["phase"] = np.full(count, "free", dtype="<U11")
    columns["tip_angle"] = np.full(count, case.beam.unloaded.at(np.array(1.0))[2])
    columns["status"] = np.full(count, "ok", dtype="<U13")
    return columns
