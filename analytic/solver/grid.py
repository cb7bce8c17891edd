"""A grid along the contour that is fine enough to miss neither a phase limit nor a fold.

Between neighbours on it the slope angle and the height change little; the surplus of eq. 21, which
decides the phase, and the foot position change about as fast as their derivatives at both ends say;
and where either has an extremum that matters, or the surplus a zero, a point of the grid lies on
it. Where the contour is not smooth there are two points, the neighbouring numbers on either side.
"""

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.contours.contour import Contour
from analytic.problem.roots import zeros
from analytic.solver.contact_length import surplus, surplus_and_rate
from analytic.solver.equilibria import equilibria

_COARSE = 65  # samples of the whole contour to begin with
_TURN = 0.1  # rad; the largest change of the slope angle between neighbours
_RISE = 0.15  # the largest change of the height, relative
_TRUST = 0.05  # by how much a mean slope may lie outside those at the ends, of the larger one
_FLAT = 1e-12  # L; changes of the foot position and the surplus that are rounding, or nearly
_LEVELS = 40  # of halving: a cell is rounding then
_AT_END, _INSIDE = 2, 16  # times that so many points are put where the reach ends
_MOST = 2000  # points more: beyond, derivatives are lost in rounding, as next to an upright side


def along(centreline: Contour, first: float, last: float) -> Floats:
    """Contour parameters, descending from `first` to `last`, that show all changes of phase.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    first, last : float
        Contour parameters between which it lies within reach.

    Returns
    -------
    array, shape (n,)
        With the zeros of the surplus and the points next to each break of the contour.
    """
    # Dense at both ends: x0 starts like a square root at first contact and folds before the last.
    fraction = (1 - np.cos(np.linspace(0, np.pi, _COARSE))) / 2
    breaks = centreline.breaks()
    breaks = breaks[(breaks > last) & (breaks < first)]
    grid = _descending(
        np.clip(first + (last - first) * fraction, last, first),
        np.nextafter(breaks, last),
        np.nextafter(breaks, first),
    )
    for _ in range(_LEVELS):
        point = centreline.at(grid)
        turn, rise = np.abs(np.diff(point.alpha)), np.abs(np.diff(point.eta))
        steep = (turn > _TURN) | (rise > _RISE * np.minimum(point.eta[1:], point.eta[:-1]))
        if not steep.any():
            break
        grid = _descending(grid, middles(grid, steep))
    return _with_phase_changes(centreline, grid)


def middles(grid: Floats, chosen: Booleans) -> Floats:
    """The middles of the chosen cells, but for those that have none.

    Parameters
    ----------
    grid : array, shape (n,)
        Descending.
    chosen : array of bool, shape (n - 1,)
        Which cells.

    Returns
    -------
    array, shape (m,)
        Those that lie between two numbers; m is at most how many cells are chosen.
    """
    middle = grid[1:] + (grid[:-1] - grid[1:]) / 2
    return np.asarray(middle[chosen & (middle > grid[1:]) & (middle < grid[:-1])])


def doubtful(t: Floats, value: Floats, rate: Floats) -> Booleans:
    """Cells in which a function may do what its values and derivatives at the ends do not show.

    Parameters
    ----------
    t, value, rate : array, shape (n,)
        Contour parameters, descending; values, and derivatives, NaN where unknown.

    Returns
    -------
    array of bool, shape (n - 1,)
        Where the mean slope does not lie between those at the ends.
    """
    change, width = np.diff(value), np.diff(t)
    with np.errstate(over="ignore"):  # between points that differ by a rounding only
        mean = change / width
    low, high = np.minimum(rate[1:], rate[:-1]), np.maximum(rate[1:], rate[:-1])
    slack = _TRUST * np.maximum(np.abs(low), np.abs(high))
    least = _FLAT * np.maximum(1, np.abs(value[1:]))
    large = np.maximum(np.abs(change), slack / _TRUST * np.abs(width)) > least
    return np.asarray(((mean < low - slack) | (mean > high + slack)) & large)


def _with_phase_changes(centreline: Contour, grid: Floats) -> Floats:
    most = _MOST + len(grid)
    for _ in range(_LEVELS):
        value, rate = surplus_and_rate(centreline, grid)
        # How near the surplus can come to zero, if it goes on as steeply as at either end.
        steepest = np.fmax(np.abs(rate[1:]), np.abs(rate[:-1])) * -np.diff(grid)
        near = np.minimum(np.abs(value[1:]), np.abs(value[:-1])) < 2 * steepest
        new = middles(grid, doubtful(grid, value, rate) & near)
        if not 0 < new.size <= most - len(grid):
            break
        grid = _descending(grid, new)
    grid = _descending(grid, _extrema(centreline, grid))
    below = surplus(centreline, grid) < 0
    turns = np.flatnonzero(below[1:] != below[:-1])
    return _descending(grid, zeros(lambda t: surplus(centreline, t), grid[turns + 1], grid[turns]))


def _extrema(centreline: Contour, grid: Floats) -> Floats:
    """Where the surplus comes nearest to zero, in cells at whose ends the tangents pass it."""
    value, rate = surplus_and_rate(centreline, grid)
    side = np.where(value < 0, -1.0, 1.0)
    before, after = side[:-1] * value[:-1], side[:-1] * value[1:]
    rate_before, rate_after = side[:-1] * rate[:-1], side[:-1] * rate[1:]
    dips = (side[:-1] == side[1:]) & (rate_after < 0) & (rate_before > 0)
    with np.errstate(all="ignore"):
        width = grid[:-1] - grid[1:]
        ahead = (before - after - rate_before * width) / (rate_after - rate_before)
        crosses = after + rate_after * ahead < 0
    at = np.flatnonzero(dips & crosses)
    return zeros(lambda t: surplus_and_rate(centreline, t)[1], grid[at + 1], grid[at])


def _descending(*grids: Floats) -> Floats:
    return np.unique(np.concatenate(grids))[::-1]


def folded(centreline: Contour, grid: Floats) -> Floats:
    """Foot position along the grid, with more points of the grid where it folds.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    grid : array, shape (n,)
        From `along`.

    Returns
    -------
    array, shape (3, m)
        Contour parameters, descending; foot position [L] and excess rotation of the tip [rad], up
        to where the vibrissa cannot reach any more.
    """
    first = centreline.at(grid[:1])
    begin = np.array([[grid[0]], first.xi, [np.nan], [0.0]])
    samples = np.hstack([begin, _sample(centreline, grid[1:])])
    for _ in range(_AT_END):
        samples = _merged(samples, _sample(centreline, _end_of_reach(samples)))
    for _ in range(_LEVELS):
        t, foot_x, rate, _ = samples
        new = middles(t, doubtful(t, foot_x, rate))
        if not 0 < new.size <= _MOST + len(grid) - t.size:
            break
        samples = _merged(samples, _sample(centreline, new))
    samples = _merged(samples, _sample(centreline, _folds(centreline, samples)))
    unreachable = np.flatnonzero(np.isnan(samples[1]))
    end = unreachable[0] if unreachable.size else samples.shape[1]
    return np.asarray(samples[[0, 1, 3], :end])


def _end_of_reach(samples: Floats) -> Floats:
    """Places between the last sample within reach and the next one; none if all are within reach.

    Past a nearly sharp edge x0 may dip a last time there, within a small part of a cell.
    """
    gone = np.flatnonzero(np.isnan(samples[1]))
    if gone.size == 0:
        return np.zeros(0)
    return np.linspace(samples[0, gone[0] - 1], samples[0, gone[0]], _INSIDE + 2)[1:-1]


def _folds(centreline: Contour, samples: Floats) -> Floats:
    """Where the foot position is least between neighbours, if it may be less than all before."""
    t, foot_x, rate, _ = samples
    before = np.where(np.isnan(rate[:-1]), 1.0, rate[:-1])
    after = np.where(np.isnan(rate[1:]), -1.0, rate[1:])
    reached = ~np.isnan(foot_x[:-1])
    least = np.minimum.accumulate(np.where(reached, foot_x[:-1], np.inf))
    lowest = foot_x[:-1] - before * (t[:-1] - t[1:])
    turns = np.flatnonzero(reached & (before > 0) & (after < 0) & (lowest < least))

    def rates(at: Floats) -> Floats:
        found = _sample(centreline, at)[2]
        return np.where(at == t[0], 1.0, np.where(np.isnan(found), -1.0, found))

    return zeros(rates, t[turns + 1], t[turns])


def _sample(centreline: Contour, t: Floats) -> Floats:
    """Contour parameter, foot position, its rate and excess rotation; NaN out of reach."""
    states = equilibria(centreline, t)
    with np.errstate(divide="ignore", invalid="ignore"):  # where the clamp's moment vanishes
        return np.stack([t, states.foot_x, states.foot_x_rate, states.excess])


def _merged(samples: Floats, more: Floats) -> Floats:
    both = np.hstack([samples, more])
    return both[:, np.unique(both[0], return_index=True)[1][::-1]]
