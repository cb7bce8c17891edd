"""The sweep on given foot positions, by Newton's method on both phases' closed forms."""

from importlib.metadata import version

import numpy as np
import pandas as pd

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.beam import Beam
from analytic.problem.case import Case
from analytic.problem.contour import Contour
from analytic.problem.readings import COLUMNS, Readings
from analytic.solver.equilibria import (
    Equilibria,
    equilibria,
    tangent_contact,
    tip_contact,
    tip_rates,
    to_table,
)
from analytic.solver.events import Limits, find_limits

_GRID = 257  # samples of the branch between which Newton's start is interpolated
_CLOSE = 1e-9  # of a Newton step; the next one would change round-off only
_MAX_ITERATIONS = 50


def solve_sweep(case: Case) -> Readings:
    """The readings of `case` in closed form, at its stations.

    Right of the first contact and left of the snap-off the vibrissa is free. Between them the foot
    position falls steadily along the contour, so that each station has one state. Where the
    contour ends before the vibrissa snaps off, the stations beyond are ``"unreachable"``.

    Parameters
    ----------
    case : Case
        The problem.

    Returns
    -------
    Readings
        In the units of the case's beam; source ``"analytic"``.
    """
    centreline, beam = case.centreline, case.beam
    foot_x = case.foot_x / beam.length
    limits = find_limits(centreline)
    branch = _Branch(centreline, limits)
    table = _free(case.foot_x, beam)
    if limits.snap_off is None:
        beyond = foot_x < branch.foot_x[-1]
        table.loc[beyond, ["force_x", "force_y", "moment_z", "tip_angle"]] = np.nan
        table.loc[beyond, "status"] = "unreachable"
    touching = (foot_x < branch.foot_x[0]) & (foot_x >= branch.foot_x[-1])
    tangent = touching & branch.is_tangent(foot_x)
    for phase, solve in ((touching & ~tangent, branch.tip), (tangent, branch.tangent)):
        if phase.any():
            solved = to_table(solve(foot_x[phase]), beam)
            table.loc[phase, COLUMNS[1:]] = solved[list(COLUMNS[1:])].set_axis(
                np.flatnonzero(phase)
            )
    provenance = {
        **case.provenance(),
        "engine": f"vibrissa-testbed {version('vibrissa-testbed')}",
        "snap_off": None if limits.snap_off is None else float(branch.foot_x[-1]) * beam.length,
    }
    return Readings(table, beam, "analytic", provenance)


class _Branch:
    """The equilibria from first contact to snap-off, as a function of the foot position."""

    def __init__(self, centreline: Contour, limits: Limits) -> None:
        self._centreline = centreline
        self._limits = (limits.last, limits.first_contact)
        # Dense at both ends: x0 starts like a square root at first contact and folds at snap-off.
        fraction = (1 - np.cos(np.linspace(0, np.pi, _GRID))) / 2
        self._t = limits.first_contact + (limits.last - limits.first_contact) * fraction
        sampled = equilibria(centreline, self._t[1:])
        start = centreline.at(self._t[:1])
        self.foot_x = np.append(start.xi, sampled.foot_x)
        self._excess = np.append(0.0, sampled.excess)
        changes = equilibria(centreline, np.array(limits.changes)).foot_x
        self._changes = np.sort(changes)
        self._starts_tangent = limits.starts_tangent

    def is_tangent(self, foot_x: Floats) -> Booleans:
        """Whether the contact at these foot positions is in Phase B."""
        passed = len(self._changes) - np.searchsorted(self._changes, foot_x)
        return np.asarray((passed % 2 == 1) != self._starts_tangent)

    def tangent(self, foot_x: Floats) -> Equilibria:
        """Phase B at the given foot positions: Newton's method on x0(t)."""
        t = self._guess(foot_x, self._t)
        for _ in range(_MAX_ITERATIONS):
            states = tangent_contact(self._centreline.at(t))
            new = self._inside(t - (states.foot_x - foot_x) / states.foot_x_rate)
            step, t = np.abs(new - t), new
            if step.max() <= _CLOSE:
                return tangent_contact(self._centreline.at(t))
        raise self._failure(foot_x, step)

    def tip(self, foot_x: Floats) -> Equilibria:
        """Phase A at the given foot positions: Newton's method on height and reach together.

        Solving for the excess rotation with the foot position, not from the height alone, keeps all
        digits at first contact, where the height says next to nothing about the force.
        """
        t, excess = self._guess(foot_x, self._t), self._guess(foot_x, self._excess)
        for _ in range(_MAX_ITERATIONS):
            states = tip_contact(self._centreline.at(t), excess)
            alpha, _, eta, turning, stretch = states.point
            up, _ = states.frame
            height, reach = tip_rates(excess, states.span, alpha)
            too_high = up / states.span.q - eta
            too_far = foot_x - states.foot_x
            height_t = turning * height.by_alpha - stretch * np.sin(alpha)
            reach_t = turning * reach.by_alpha - stretch * np.cos(alpha)
            determinant = height_t * reach.by_excess - reach_t * height.by_excess
            step_t = (too_high * reach.by_excess - too_far * height.by_excess) / determinant
            step_w = (height_t * too_far - reach_t * too_high) / determinant
            t = self._inside(t - step_t)
            excess = np.maximum(excess - step_w, excess / 10)
            step = np.maximum(np.abs(step_t), np.abs(step_w) / excess)
            if step.max() <= _CLOSE:
                return tip_contact(self._centreline.at(t), excess)
        raise self._failure(foot_x, step)

    def _guess(self, foot_x: Floats, values: Floats) -> Floats:
        return np.interp(foot_x, self.foot_x[::-1], values[::-1])

    def _inside(self, t: Floats) -> Floats:
        return np.clip(t, *self._limits)

    def _failure(self, foot_x: Floats, step: Floats) -> ArithmeticError:
        worst = foot_x[np.argmax(step)]
        return ArithmeticError(f"no state found at foot_x = {worst:.16g} L; please report the case")


def _free(foot_x: Floats, beam: Beam) -> pd.DataFrame:
    """The readings of a vibrissa that touches nothing."""
    table = pd.DataFrame(index=range(len(foot_x)), columns=list(COLUMNS), dtype=float)
    table["foot_x"] = foot_x
    table[["force_x", "force_y", "moment_z"]] = 0.0
    table["phase"] = "free"
    table["tip_angle"] = np.pi / 2
    table["status"] = "ok"
    return table
