"""The sweep on given foot positions, by Newton's method on both phases' closed forms."""

from dataclasses import replace
from functools import partial
from importlib.metadata import version

import numpy as np
import pandas as pd

from analytic.checks.certificate import certify
from analytic.problem.arrays import Floats, Integers
from analytic.problem.case import Case
from analytic.problem.columns import CLAMP_READINGS, COLUMNS
from analytic.problem.mirror import solve_either_way
from analytic.problem.readings import Readings
from analytic.solver.branch import Branch, trace
from analytic.solver.equilibria import (
    Column,
    Equilibria,
    tangent_contact,
    tip_contact,
    tip_rates,
    to_columns,
)

_CLOSE = 1e-9  # of a Newton step; the next one would change round-off only
_MAX_ITERATIONS = 50
_CERTIFIED = 1e-9  # L and EI/L; the check itself is good to 1e-12


def solve_sweep(case: Case, certified: bool = False) -> Readings:
    """The readings of `case` in closed form, at its stations.

    Parameters
    ----------
    case : Case
        The problem.
    certified : bool
        Whether each station is to be checked by integration from the clamp (`certify`). The
        readings then have its columns, and a station that misses by more than 1e-9 is
        ``"diverged"``.

    Returns
    -------
    Readings
        In the units of the case's beam; source ``"analytic"``.
    """
    return solve_either_way(case, partial(_solve_leftward, certified=certified))


def _solve_leftward(case: Case, certified: bool) -> Readings:
    """Solve a sweep to the left.

    Right of the first contact and left of the snap-off the vibrissa is free. Between them the foot
    position falls along the contour, so that each station has one state.
    """
    beam = case.beam
    foot_x = case.foot_x / beam.length
    branch = trace(case.centreline, case.reach[1])
    columns = _free(case.foot_x)
    touching = (foot_x < branch.foot_x[0]) & (foot_x >= branch.foot_x[-1])
    cells = branch.cells(foot_x)
    for tangent, solve in ((False, _tip), (True, _tangent)):
        here = touching & (branch.tangent[cells] == tangent)
        if here.any():
            solved = to_columns(solve(branch, foot_x[here], cells[here]), beam)
            for name in COLUMNS[1:]:
                columns[name][here] = solved[name]
    provenance = {
        **case.provenance(),
        "engine": f"vibrissa-testbed {version('vibrissa-testbed')}",
        "events": {
            name: None if x is None else x * beam.length for name, x in branch.events().items()
        },
    }
    readings = Readings(pd.DataFrame(columns), beam, "analytic", provenance)
    return _with_certificate(readings) if certified else readings


def _with_certificate(readings: Readings) -> Readings:
    residuals = certify(readings)
    wrong = ~(residuals.max(axis=1) <= _CERTIFIED)
    table = readings.table.assign(status=readings.table["status"].mask(wrong, "diverged"))
    return replace(readings, table=pd.concat([table, residuals], axis=1))


def _tangent(branch: Branch, foot_x: Floats, cells: Integers) -> Equilibria:
    """Phase B at the given foot positions: Newton's method on x0(t)."""
    centreline = branch.centreline
    t, low, high = _start(branch, foot_x, cells)
    for _ in range(_MAX_ITERATIONS):
        states = tangent_contact(centreline.at(t))
        new = np.clip(t - (states.foot_x - foot_x) / states.foot_x_rate, low, high)
        step, t = np.abs(new - t), new
        if step.max() <= _CLOSE:
            return tangent_contact(centreline.at(t))
    raise _failure(foot_x, step)


def _tip(branch: Branch, foot_x: Floats, cells: Integers) -> Equilibria:
    """Phase A at the given foot positions: Newton's method on height and reach together.

    Solving for the excess rotation with the foot position, not from the height alone, keeps all
    digits at first contact, where the height says next to nothing about the force.
    """
    centreline = branch.centreline
    t, low, high = _start(branch, foot_x, cells)
    excess = _between(branch.excess, branch.foot_x, foot_x, cells)
    for _ in range(_MAX_ITERATIONS):
        states = tip_contact(centreline.at(t), excess)
        alpha, _, eta, turning, stretch = states.point
        height, reach = tip_rates(excess, states.span, alpha)
        too_high = states.frame.up / states.span.q - eta
        too_far = foot_x - states.foot_x
        height_t = turning * height.by_alpha - stretch * np.sin(alpha)
        reach_t = turning * reach.by_alpha - stretch * np.cos(alpha)
        determinant = height_t * reach.by_excess - reach_t * height.by_excess
        step_t = (too_high * reach.by_excess - too_far * height.by_excess) / determinant
        step_w = (height_t * too_far - reach_t * too_high) / determinant
        new = np.clip(t - step_t, low, high)
        excess = np.maximum(excess - step_w, excess / 10)
        step, t = np.maximum(np.abs(new - t), np.abs(step_w) / excess), new
        if step.max() <= _CLOSE:
            return tip_contact(centreline.at(t), excess)
    raise _failure(foot_x, step)


def _start(branch: Branch, foot_x: Floats, cells: Integers) -> tuple[Floats, Floats, Floats]:
    """Where to start in each cell, and the cell's ends, a rounding inside it."""
    inside = 8 * np.finfo(float).eps * np.abs(branch.t).max()
    low, high = branch.t[cells + 1] + inside, branch.t[cells] - inside
    return np.clip(_between(branch.t, branch.foot_x, foot_x, cells), low, high), low, high


def _between(values: Floats, at: Floats, foot_x: Floats, cells: Integers) -> Floats:
    """`values` on the branch's grid, interpolated linearly within each cell."""
    ahead = (at[cells] - foot_x) / (at[cells] - at[cells + 1])
    return values[cells] + ahead * (values[cells + 1] - values[cells])


def _failure(foot_x: Floats, step: Floats) -> ArithmeticError:
    worst = foot_x[np.argmax(step)]
    return ArithmeticError(f"no state found at foot_x = {worst:.16g} L; please report the case")


def _free(foot_x: Floats) -> dict[str, Column]:
    """The readings of a vibrissa that touches nothing."""
    count = len(foot_x)
    columns: dict[str, Column] = {name: np.full(count, np.nan) for name in COLUMNS}
    columns["foot_x"] = foot_x
    for name in CLAMP_READINGS:
        columns[name] = np.zeros(count)
    columns["phase"] = np.full(count, "free", dtype="<U11")
    columns["tip_angle"] = np.full(count, np.pi / 2)
    columns["status"] = np.full(count, "ok", dtype="<U11")
    return columns
