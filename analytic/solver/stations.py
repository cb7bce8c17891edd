"""The states at given foot positions, by Newton's method on both phases' closed forms."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.contour import Contour
from analytic.problem.roots import zeros
from analytic.solver.branch import Branch
from analytic.solver.equilibria import Equilibria, contact, equilibria, tip_rates

_EPS = float(np.finfo(float).eps)
_ITERATIONS = 25  # of Newton's method; 4 to 8 are usual, some 20 close to a fold
_CLOSE = 1e-9  # of a step, relative; the next one would change rounding only
_EXACT = 64 * _EPS  # of the misses, in units of the extent: some roundings of the closed forms


class _Iterate(NamedTuple):
    """Unknowns of all stations, shape (n,), and by how much they miss."""

    t: Floats
    excess: Floats
    missed: Floats


def solve_stations(branch: Branch, foot_x: Floats) -> Equilibria:
    """The state at each foot position on the branch.

    Newton's method starts from the branch's grid and may not leave the station's cell. What it
    leaves with a miss, or in the wrong phase, is enclosed instead: the foot position of the
    equilibrium at a contour point changes steadily along the cell, whatever its phase.

    Parameters
    ----------
    branch : Branch
        From first contact to snap-off.
    foot_x : array, shape (n,)
        Foot positions on it [L].

    Returns
    -------
    Equilibria
        As exact as rounding allows; whether that is exact enough, `residuals` says.
    """
    cells = branch.cells(foot_x)
    low, high = branch.t[cells + 1], branch.t[cells]
    tangent = branch.tangent[cells]
    ahead = (branch.foot_x[cells] - foot_x) / (branch.foot_x[cells] - branch.foot_x[cells + 1])
    t = high + ahead * (low - high)
    excess = branch.excess[cells] + ahead * (branch.excess[cells + 1] - branch.excess[cells])
    found = _newton(branch.centreline, foot_x, tangent, (low, high), (t, excess))
    poor = ~(_admissible(branch.centreline, found, tangent) & (found.missed <= _EXACT))
    if poor.any():
        bounds = low[poor], high[poor]
        enclosed, tangent[poor] = _enclose(branch, foot_x[poor], bounds, cells[poor])
        start = enclosed.t, enclosed.excess
        refined = _newton(branch.centreline, foot_x[poor], tangent[poor], bounds, start)
        better = _admissible(branch.centreline, refined, tangent[poor])
        better &= refined.missed < enclosed.missed
        for values, one, other in zip(found, refined, enclosed, strict=True):
            values[poor] = np.where(better, one, other)
    return contact(branch.centreline.at(found.t), found.excess, tangent)


def _newton(
    centreline: Contour,
    foot_x: Floats,
    tangent: Booleans,
    bounds: tuple[Floats, Floats],
    start: tuple[Floats, Floats],
) -> _Iterate:
    """The iterate that misses least, of each station.

    Phase A is solved for the excess rotation together with the contour parameter: from the height
    alone the rotation would lose its digits at first contact, where the height hardly depends on
    the force.
    """
    low, high = bounds
    t, excess = start
    best = _Iterate(t.copy(), excess.copy(), np.full_like(t, np.inf))
    step = np.full_like(t, np.inf)
    for _ in range(_ITERATIONS):
        with np.errstate(all="ignore"):  # folds and first contacts: what is not finite is no step
            states = contact(centreline.at(t), excess, tangent)
            too_high, too_far, extent = _misses(states, foot_x, t)
            missed = np.fmax(np.abs(too_high), np.abs(too_far)) / extent
            step_t, step_w = _steps(states, too_high, too_far)
        less = missed <= best.missed
        for values, new in zip(best, (t, excess, missed), strict=True):
            values[less] = new[less]
        if (((step <= _CLOSE) & (missed <= _EXACT)) | (missed == 0)).all():
            break
        step_t = np.where(np.isfinite(step_t), step_t, 0.0)
        step_w = np.where(np.isfinite(step_w), step_w, 0.0)
        new = np.clip(t - step_t, low, high)
        step = np.maximum(np.abs(new - t), np.abs(step_w) / excess)
        t, excess = new, np.maximum(excess - step_w, excess / 10)
    return best


def _misses(states: Equilibria, foot_x: Floats, at: Floats) -> tuple[Floats, Floats, Floats]:
    """By how much the contact lies above and behind the contour's point [L]; unit of roundings."""
    height = states.frame.up / states.root_f
    point = states.point
    # A rounding of the parameter moves the point by the stretch times that.
    return (
        height - point.eta,
        foot_x - states.foot_x,
        np.maximum.reduce([np.ones_like(height), np.abs(point.xi), point.stretch * np.abs(at)]),
    )


def _steps(states: Equilibria, too_high: Floats, too_far: Floats) -> tuple[Floats, Floats]:
    """Newton's step of the contour parameter and of the excess rotation."""
    alpha, _, _, turning, stretch = states.point
    height, reach = tip_rates(states.excess, states.span, alpha)
    height_t = turning * height.by_alpha - stretch * np.sin(alpha)
    reach_t = turning * reach.by_alpha - stretch * np.cos(alpha)
    determinant = height_t * reach.by_excess - reach_t * height.by_excess
    step_t = (too_high * reach.by_excess - too_far * height.by_excess) / determinant
    step_w = (height_t * too_far - reach_t * too_high) / determinant
    along = -too_far / states.foot_x_rate
    return (
        np.where(states.tangent, along, step_t),
        np.where(states.tangent, 0.0, step_w),
    )


def _admissible(centreline: Contour, found: _Iterate, tangent: Booleans) -> Booleans:
    """Whether contacts are of the phase that they should be of."""
    point = centreline.at(found.t)
    states = contact(point, found.excess, tangent)
    fits = (states.root_f > 0) & (states.span.q <= states.root_f * (1 + _EXACT))
    above = states.excess <= np.pi / 2 - np.abs(point.alpha) + _EXACT
    return np.asarray(np.where(tangent, fits, above))


def _enclose(
    branch: Branch, foot_x: Floats, bounds: tuple[Floats, Floats], cells: Integers
) -> tuple[_Iterate, Booleans]:
    """Stations enclosed along the contour, and whether they are in Phase B."""
    centreline = branch.centreline

    def ahead(t: Floats) -> Floats:
        found = equilibria(centreline, t).foot_x - foot_x
        return np.where(np.isnan(found), 1.0, found)  # the first contact itself

    low, high = bounds
    at_low, at_high = ahead(low), ahead(high)
    t = zeros(ahead, low, high)
    t = np.where(at_low >= 0, low, np.where(at_high <= 0, high, t))
    states = equilibria(centreline, t)
    first = np.isnan(states.excess)
    excess = np.where(first, branch.excess[cells + 1] * 1e-3, states.excess)
    states = contact(centreline.at(t), excess, states.tangent)
    too_high, too_far, extent = _misses(states, foot_x, t)
    missed = np.fmax(np.abs(too_high), np.abs(too_far)) / extent
    return _Iterate(t, excess, missed), states.tangent
