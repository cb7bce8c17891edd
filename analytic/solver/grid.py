"""Grids along contours that are fine enough to miss neither a phase limit nor a fold.

Between neighbours on one the slope angle and the height change little; the surplus of eq. 21, which
decides the phase, and the foot position change about as fast as their derivatives at both ends say;
and where either has an extremum that matters, or the surplus a zero, a point of the grid lies on
it. Where the contour is not smooth there are two points, the neighbouring numbers on either side.

The grids of many contours are made at once, one after the other in the same arrays: `owner` says
whose a point is. What is done to one grid does not depend on the others.
"""

from itertools import pairwise
from typing import NamedTuple, TypeVar

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.batches import take
from analytic.numerics.hermite import least_of_hermite
from analytic.numerics.roots import Surroundings, smooth_zeros, zeros
from analytic.problem.contours.contour import ContourPoint
from analytic.problem.contours.many import Contours
from analytic.solver.equilibria import equilibria_at, surplus_and_rate, within_reach

# Samples of the whole contour to begin with, as shares of the way along it. They are dense at both
# ends: x0 starts like a square root at first contact and folds before the last.
_COARSE = (1 - np.cos(np.linspace(0, np.pi, 65))) / 2
_TURN = 0.1  # rad; the largest change of the slope angle between neighbours
_RISE = 0.15  # the largest change of the height, relative
_TRUST = 0.05  # by how much a mean slope may lie outside those at the ends, of the larger one
_FLAT = 1e-12  # L; changes of the foot position and the surplus that are rounding, or nearly
_LEVELS = 40  # of halving: a cell is rounding then
_ASIDE = 1e-3  # of a cell: next to a fold x0 is higher by far more than rounding there
_AT_END = 2  # times points are put where the reach ends
_INSIDE = np.linspace(0, 1, 18)[1:-1]  # of a cell, where they are
_MOST = 2000  # points more: beyond, derivatives are lost in rounding, as next to an upright side

_Values = TypeVar("_Values", Floats, Booleans)


class Grid(NamedTuple):
    """Points along contours, shape (n,): contours ascending, on each of them t descending."""

    owner: Integers
    t: Floats

    def with_points(self, owner: Integers, t: Floats) -> "Grid":
        return _merged(self, (), Grid(owner, t), ())[0]

    @property
    def cells(self) -> Booleans:
        """Whether a point and the next one are of one contour, shape (n - 1,)."""
        same: Booleans = self.owner[1:] == self.owner[:-1]
        return same

    @property
    def begins(self) -> Integers:
        """The number of each contour's first point; every contour has one."""
        return self.owner.searchsorted(np.arange(self.owner[-1] + 1))

    def middles(self, chosen: Booleans) -> "Grid":
        """The middles of the chosen cells, but for those that have none."""
        t = self.t
        middle = t[1:] + (t[:-1] - t[1:]) / 2
        among = chosen & self.cells & (middle > t[1:]) & (middle < t[:-1])
        return Grid(self.owner[1:][among], middle[among])


def along(contours: Contours, first: Floats, last: Floats) -> Grid:
    """Contour parameters, descending from `first` to `last`, that show all changes of phase."""
    coarse = first[:, None] + (last - first)[:, None] * _COARSE
    coarse = np.clip(coarse, last[:, None], first[:, None])
    # Left of the lowest point the excess is counted from another rotation.
    lowest = contours.lowest
    every = np.column_stack([coarse, lowest, np.nextafter(lowest, -np.inf)])
    owner = np.repeat(np.arange(len(contours)), every.shape[1])
    grid = Grid(owner[:0], first[:0]).with_points(owner, every.ravel())
    for i, contour in enumerate(contours.contours):
        breaks = contour.breaks()
        breaks = breaks[(breaks > last[i]) & (breaks < first[i])]
        if breaks.size:
            beside = np.append(np.nextafter(breaks, last[i]), np.nextafter(breaks, first[i]))
            grid = grid.with_points(np.full(beside.size, i), beside)
    point = contours.at(*grid)
    for _ in range(_LEVELS):
        turn, rise = np.abs(_steps(point.alpha)), np.abs(_steps(point.eta))
        steep = (turn > _TURN) | (rise > _RISE * np.minimum(point.eta[1:], point.eta[:-1]))
        new = grid.middles(steep)
        if not new.t.size:
            break
        grid, values = _merged(grid, tuple(point), new, tuple(contours.at(*new)))
        point = ContourPoint(*values)
    return _with_phase_changes(contours, grid, point)


def doubtful(t: Floats, value: Floats, rate: Floats) -> Booleans:
    """Cells in which a function may do what its values and derivatives at the ends do not show."""
    change, width = _steps(value), _steps(t)
    with np.errstate(all="ignore"):  # between points that differ by a rounding only, or contours
        mean = change / width
    low, high = np.minimum(rate[1:], rate[:-1]), np.maximum(rate[1:], rate[:-1])
    slack = _TRUST * np.maximum(np.abs(low), np.abs(high))
    least = _FLAT * np.maximum(1, np.abs(value[1:]))
    large = np.maximum(np.abs(change), slack / _TRUST * np.abs(width)) > least
    return np.asarray(((mean < low - slack) | (mean > high + slack)) & large)


def _with_phase_changes(contours: Contours, grid: Grid, point: ContourPoint) -> Grid:
    value, rate = surplus_and_rate(point)
    most = np.bincount(grid.owner, minlength=len(contours)) + _MOST
    for _ in range(_LEVELS):
        # How near the surplus can come to zero, if it goes on as steeply as at either end.
        steepest = np.fmax(np.abs(rate[1:]), np.abs(rate[:-1])) * -_steps(grid.t)
        near = np.minimum(np.abs(value[1:]), np.abs(value[:-1])) < 2 * steepest
        new = _allowed(grid, grid.middles(doubtful(grid.t, value, rate) & near), most)
        if not new.t.size:
            break
        grid, (value, rate) = _merged(grid, (value, rate), new, surplus_and_rate(contours.at(*new)))
    new = _extrema(contours, grid, value, rate)
    if new.t.size:
        found = surplus_and_rate(contours.at(*new))[:1]
        grid, (value,) = _merged(grid, (value,), new, found)
    below = value < 0
    turns = (grid.cells & (below[1:] != below[:-1])).nonzero()[0]
    owner = grid.owner[turns]
    high, low = grid.t[turns], grid.t[turns + 1]

    def surplus(turn: Integers, t: Floats) -> Floats:
        return surplus_and_rate(contours.at(owner[turn], t))[0]

    likely = low + (high - low) * value[turns + 1] / (value[turns + 1] - value[turns])
    return grid.with_points(owner, smooth_zeros(surplus, low, high, likely))


def _extrema(contours: Contours, grid: Grid, value: Floats, rate: Floats) -> Grid:
    """Where the surplus comes nearest to zero, in cells at whose ends the tangents pass it."""
    side = np.where(value < 0, -1.0, 1.0)
    before, after = side[:-1] * value[:-1], side[:-1] * value[1:]
    rate_before, rate_after = side[:-1] * rate[:-1], side[:-1] * rate[1:]
    dips = grid.cells & (side[:-1] == side[1:]) & (rate_after < 0) & (rate_before > 0)
    with np.errstate(all="ignore"):
        width = grid.t[:-1] - grid.t[1:]
        ahead = (before - after - rate_before * width) / (rate_after - rate_before)
        crosses = after + rate_after * ahead < 0
    at = (dips & crosses).nonzero()[0]
    owner = grid.owner[at]

    def rates(dip: Integers, t: Floats) -> Floats:
        return surplus_and_rate(contours.at(owner[dip], t))[1]

    return Grid(owner, zeros(rates, grid.t[at + 1], grid.t[at]))


class Samples(NamedTuple):
    """States along grids, arrays of shape (n,); NaN out of reach."""

    foot_x: Floats  # [L]
    rate: Floats  # its derivative along the contour
    tip_rotation: Floats  # excess rotation of the tip [rad]
    tangent_rate: Floats  # derivative of the foot position in Phase B
    tip_rate: Floats  # derivative of the foot position in Phase A
    tip_rotation_rate: Floats  # derivative of the excess rotation in Phase A


def folded(contours: Contours, grid: Grid) -> tuple[Grid, Samples]:
    """Foot positions along the grids, with more points of them where it folds."""
    grid, point = _to_end_of_reach(contours, grid)
    samples = _sampled(point)
    most = np.bincount(grid.owner, minlength=len(contours)) + _MOST
    begins = grid.begins  # the first contact, without a load
    samples.foot_x[begins] = point.xi[begins]
    samples.rate[begins], samples.tip_rotation[begins] = np.nan, 0.0
    for _ in range(_LEVELS):
        chosen = grid.middles(doubtful(grid.t, samples.foot_x, samples.rate))
        new = _allowed(grid, chosen, most)
        if not new.t.size:
            break
        grid, values = _merged(grid, tuple(samples), new, tuple(_sample(contours, new)))
        samples = Samples(*values)
    beside, found = _folds(contours, grid, samples)
    if beside.t.size:
        grid, values = _merged(grid, tuple(samples), beside, tuple(found))
        samples = Samples(*values)
    reached = _before_first(grid, np.isnan(samples.foot_x))
    return take(grid, reached), take(samples, reached)


def _to_end_of_reach(contours: Contours, grid: Grid) -> tuple[Grid, ContourPoint]:
    """Up to the first point out of reach of each contour, with more points before that."""
    point = contours.at(*grid)
    gone = ~within_reach(point.alpha, point.eta)
    gone[grid.begins] = False
    reached = _before_first(grid, gone)
    first = (reached[:-1] & ~reached[1:] & grid.cells).nonzero()[0] + 1
    if not first.size:
        return grid, point
    owner, row = np.repeat(grid.owner[first], _INSIDE.size), np.arange(first.size)
    high, low = grid.t[first - 1], grid.t[first]
    for _ in range(_AT_END):
        t = high[:, None] + (low - high)[:, None] * _INSIDE
        new = Grid(owner, t.ravel())
        more = contours.at(*new)
        passed = ~within_reach(more.alpha, more.eta)
        point = ContourPoint(*_merged(grid, tuple(point), new, tuple(more))[1])
        grid, (gone,) = _merged(grid, (gone,), new, (passed,))
        edges = np.concatenate([high[:, None], t, low[:, None]], axis=1)
        end = np.argmax(np.append(passed.reshape(t.shape), np.ones((row.size, 1), bool), 1), axis=1)
        high, low = edges[row, end], edges[row, end + 1]
    reached = _before_first(grid, np.append(False, gone[:-1] & grid.cells))
    return take(grid, reached), take(point, reached)


def _before_first(grid: Grid, chosen: Booleans) -> Booleans:
    so_far: Integers = np.cumsum(chosen)
    begins = grid.begins
    before = so_far[begins] - chosen[begins]
    return np.asarray(so_far == before[grid.owner])


def _folds(contours: Contours, grid: Grid, samples: Samples) -> tuple[Grid, Samples]:
    """Where the foot position is least between neighbours, if it may be less than all before."""
    foot_x, rate = samples.foot_x, samples.rate
    before = np.where(np.isnan(rate[:-1]), 1.0, rate[:-1])
    after = np.where(np.isnan(rate[1:]), -1.0, rate[1:])
    reached = ~np.isnan(foot_x[:-1])
    least = _least_so_far(grid, foot_x)[:-1]
    lowest = foot_x[:-1] - before * (grid.t[:-1] - grid.t[1:])
    dips = grid.cells & reached & (before > 0) & (after < 0) & (lowest < least)
    turns = dips.nonzero()[0]
    owner, high, low = grid.owner[turns], grid.t[turns], grid.t[turns + 1]
    first = grid.t[grid.begins][owner]

    def rates(turn: Integers, at: Floats, found: Samples) -> Floats:
        return np.where(at == first[turn], 1.0, np.where(np.isnan(found.rate), -1.0, found.rate))

    width, after = high - low, turns + 1
    ends = (values for i in (after, turns) for values in (foot_x[i], width * rate[i]))
    likely = low + width * least_of_hermite(*ends)
    about = Surroundings.of(low, high, likely)
    # And one in the cell before, if there is one: near the end of reach cubics are poor.
    previous = np.maximum(turns - 1, 0)
    middle = (high + np.where(grid.owner[previous] == owner, grid.t[previous], high)) / 2
    places = np.column_stack([about.places, middle])
    turn, at = np.repeat(np.arange(turns.size), places.shape[1]), places.ravel()
    there = _sample(contours, Grid(owner[turn], at))
    sampled = np.stack(there).reshape(len(there), *places.shape)
    t, known = about.zeros(rates(turn, at, there).reshape(places.shape)[:, :-1])
    left = (~known).nonzero()[0]
    t[left] = zeros(
        lambda which, at: rates(left[which], at, _sample(contours, Grid(owner[left[which]], at))),
        low[left],
        high[left],
    )
    aside = _ASIDE * (high - t)
    every = np.stack([t, np.maximum(t - aside, low), np.minimum(t + aside, high)], axis=1)
    values = about.between(sampled[:, :, :-1], every)
    left = (~(known & np.isfinite(values[0]).all(axis=1))).nonzero()[0]
    if left.size:
        exact = _sample(contours, Grid(np.repeat(owner[left], 3), every[left].ravel()))
        values[:, left] = np.stack(exact).reshape(len(exact), *every[left].shape)
    every = np.concatenate([every, places[:, [0, -1]]], axis=1)
    values = np.concatenate([values, sampled[:, :, [0, -1]]], axis=2)
    beside = Grid(np.repeat(owner, every.shape[1]), every.ravel())
    return beside, Samples(*values.reshape(len(values), -1))


def _least_so_far(grid: Grid, foot_x: Floats) -> Floats:
    values = np.where(np.isnan(foot_x), np.inf, foot_x)
    bounds = pairwise([*grid.begins.tolist(), values.size])
    return np.concatenate([np.minimum.accumulate(values[begin:end]) for begin, end in bounds])


def _sample(contours: Contours, grid: Grid) -> Samples:
    return _sampled(contours.at(*grid))


def _sampled(point: ContourPoint) -> Samples:
    states = equilibria_at(point)
    with np.errstate(divide="ignore", invalid="ignore"):  # where the clamp's moment vanishes
        in_b, in_a = states.tangent_rate(), states.tip_rate()
        rate = np.where(states.tangent, in_b, in_a.foot_x)
        return Samples(states.foot_x, rate, states.tip_rotation, in_b, *in_a)


def _merged(
    grid: Grid, values: tuple[_Values, ...], new: Grid, found: tuple[_Values, ...]
) -> tuple[Grid, tuple[_Values, ...]]:
    """Two grids as one, with what is known of their points; of points in both, the first's."""
    owner, t = np.concatenate([grid.owner, new.owner]), np.concatenate([grid.t, new.t])
    order = _order(owner, t)
    both = zip(values, found, strict=True)
    merged = tuple(np.concatenate(pair)[order] for pair in both)
    return Grid(owner[order], t[order]), merged


def _steps(values: Floats) -> Floats:
    """From each value to the next, by less than NumPy's `diff` of any order and axis takes."""
    return values[1:] - values[:-1]


def _order(owner: Integers, t: Floats) -> Integers:
    """The order of a grid's points, each once; of equal ones the first."""
    order = np.lexsort((-t, owner))
    whose, where = owner[order], t[order]
    first = np.ones(order.size, dtype=bool)
    first[1:] = (whose[1:] != whose[:-1]) | (where[1:] != where[:-1])
    return np.asarray(order[first])


def _allowed(grid: Grid, new: Grid, most: Integers) -> Grid:
    """The new points of those contours that may have more."""
    count = np.bincount(grid.owner, minlength=most.size)
    more = np.bincount(new.owner, minlength=most.size)
    among = (count + more <= most)[new.owner]
    return Grid(new.owner[among], new.t[among])
