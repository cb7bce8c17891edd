"""The states at given foot positions, by Newton's method on both phases' closed forms."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.many import Contours
from analytic.problem.roots import zeros
from analytic.solver.branch import Branch
from analytic.solver.equilibria import Equilibria, contact, equilibria_at, tip_rates

_EPS = float(np.finfo(float).eps)
_ITERATIONS = 25  # of Newton's method; 4 to 8 are usual, some 20 close to a fold
_CLOSE = 1e-9  # of a step, relative; the next one would change rounding only
_MOST_TURNED = np.pi / 2  # rad of excess; from there the end would point back at the clamp
_FINEST = 4 * _EPS  # of the misses: another step would only try other roundings
_EXACT = 64 * _EPS  # of the misses, in units of the extent: some roundings of the closed forms


class _Iterate(NamedTuple):
    """Unknowns of all stations, shape (n,), and by how much they miss."""

    t: Floats
    excess: Floats
    missed: Floats


class _Stations(NamedTuple):
    """Stations of many branches, shape (n,): whose, where, and between which contour parameters."""

    owner: Integers
    foot_x: Floats
    low: Floats
    high: Floats

    def part(self, chosen: Booleans | Integers) -> "_Stations":
        owner, foot_x, low, high = self
        return _Stations(owner[chosen], foot_x[chosen], low[chosen], high[chosen])


def solve_stations(
    centrelines: Contours, branches: Sequence[Branch], foot_x: Sequence[Floats]
) -> Equilibria:
    """The states at foot positions on branches.

    Newton's method starts from the branch's grid and may not leave the station's cell. What it
    leaves with a miss, or in the wrong phase, is enclosed instead: the foot position of the
    equilibrium at a contour point changes steadily along the cell, whatever its phase.

    Parameters
    ----------
    centrelines : Contours
        What the centrelines feel, in units of the vibrissae's lengths.
    branches : sequence of Branch
        Of each, from first contact to snap-off.
    foot_x : sequence of array
        Foot positions on each of them [L].

    Returns
    -------
    Equilibria
        Of all, one branch after the other, as exact as rounding allows; whether that is exact
        enough, `residuals` says.
    """
    cells = [branch.cells(places) for branch, places in zip(branches, foot_x, strict=True)]

    def of_cells(name: str, ahead: int) -> Floats:
        parts = zip(branches, cells, strict=True)
        return np.concatenate(
            [getattr(branch, name)[np.maximum(cell + ahead, 0)] for branch, cell in parts]
        )

    stations = _Stations(
        np.repeat(np.arange(len(branches)), [len(places) for places in foot_x]),
        np.concatenate(foot_x),
        of_cells("t", 1),
        of_cells("t", 0),
    )
    tangent = of_cells("tangent", 0).astype(bool)
    places = [of_cells("foot_x", i) for i in (-1, 0, 1)]
    smooth = tangent == of_cells("tangent", -1)
    t = _interpolated(places, [of_cells("t", i) for i in (-1, 0, 1)], stations.foot_x, smooth)
    rotations = [of_cells("excess", i) for i in (-1, 0, 1)]
    excess, behind = _interpolated(places, rotations, stations.foot_x, smooth), rotations[-1]
    found = _newton(centrelines, stations, tangent, (t, excess))
    states = contact(centrelines.at(stations.owner, found.t), found.excess, tangent)
    poor = ~(_admissible(states) & (found.missed <= _EXACT))
    if poor.any():
        few = stations.part(poor)
        enclosed, tangent[poor] = _enclose(centrelines, few, behind[poor])
        start = enclosed.t, enclosed.excess
        refined = _newton(centrelines, few, tangent[poor], start)
        closer = contact(centrelines.at(few.owner, refined.t), refined.excess, tangent[poor])
        better = _admissible(closer) & (refined.missed < enclosed.missed)
        for values, one, other in zip(found, refined, enclosed, strict=True):
            values[poor] = np.where(better, one, other)
        states = contact(centrelines.at(stations.owner, found.t), found.excess, tangent)
    return states


def _interpolated(x: list[Floats], y: list[Floats], at: Floats, smooth: Booleans) -> Floats:
    """Between the last two of three points, by a parabola through all where `y` is smooth."""
    slope = (y[2] - y[1]) / (x[2] - x[1])
    with np.errstate(all="ignore"):  # the first cell has none before it
        curved = (slope - (y[1] - y[0]) / (x[1] - x[0])) / (x[2] - x[0])
    curved = np.where(smooth & np.isfinite(curved), curved, 0.0)
    value = y[1] + (at - x[1]) * (slope + curved * (at - x[2]))
    return np.clip(value, np.minimum(y[1], y[2]), np.maximum(y[1], y[2]))


def _newton(
    centrelines: Contours,
    stations: _Stations,
    tangent: Booleans,
    start: tuple[Floats, Floats],
) -> _Iterate:
    """The iterate that misses least, of each station.

    Phase A is solved for the excess rotation together with the contour parameter: from the height
    alone the rotation would lose its digits at first contact, where the height hardly depends on
    the force.
    """
    t, excess = start
    best = _Iterate(t.copy(), excess.copy(), np.full_like(t, np.inf))
    step = np.full_like(t, np.inf)
    going = np.arange(t.size)
    for _ in range(_ITERATIONS):
        owner, foot_x, low, high = stations.part(going)
        with np.errstate(all="ignore"):  # folds and first contacts: what is not finite is no step
            states = contact(centrelines.at(owner, t), excess, tangent[going])
            too_high, too_far, extent = _misses(states, foot_x, t)
            missed = np.fmax(np.abs(too_high), np.abs(too_far)) / extent
            step_t, step_w = _steps(states, too_high, too_far)
        less = missed <= best.missed[going]
        for values, new in zip(best, (t, excess, missed), strict=True):
            values[going[less]] = new[less]
        enough = (missed <= _FINEST) | (~less & (missed <= _EXACT))
        more = ~((enough & (step <= _CLOSE)) | (missed == 0))
        if not more.any():
            break
        step_t = np.where(np.isfinite(step_t), step_t, 0.0)
        step_w = np.where(np.isfinite(step_w), step_w, 0.0)
        new_t = np.clip(t - step_t, low, high)
        step = np.maximum(np.abs(new_t - t), np.abs(step_w) / excess)[more]
        excess = np.clip(excess - step_w, excess / 10, _MOST_TURNED)[more]
        t, going = new_t[more], going[more]
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


def _admissible(states: Equilibria) -> Booleans:
    """Whether contacts are of the phase that they should be of."""
    fits = (states.root_f > 0) & (states.span.q <= states.root_f * (1 + _EXACT))
    above = states.excess <= np.pi / 2 - np.abs(states.point.alpha) + _EXACT
    return np.asarray(np.where(states.tangent, fits, above))


def _enclose(
    centrelines: Contours, stations: _Stations, behind: Floats
) -> tuple[_Iterate, Booleans]:
    """Stations enclosed along the contour, and whether they are in Phase B.

    `behind` is the excess rotation where each one's cell ends.
    """
    owner, foot_x, low, high = stations

    def ahead(station: Integers, t: Floats) -> Floats:
        found = equilibria_at(centrelines.at(owner[station], t)).foot_x - foot_x[station]
        return np.where(np.isnan(found), 1.0, found)  # the first contact itself

    every = np.arange(owner.size)
    at_low, at_high = ahead(every, low), ahead(every, high)
    t = zeros(ahead, low, high)
    t = np.where(at_low >= 0, low, np.where(at_high <= 0, high, t))
    states = equilibria_at(centrelines.at(owner, t))
    first = np.isnan(states.excess)
    excess = np.where(first, behind * 1e-3, states.excess)
    states = contact(centrelines.at(owner, t), excess, states.tangent)
    too_high, too_far, extent = _misses(states, foot_x, t)
    missed = np.fmax(np.abs(too_high), np.abs(too_far)) / extent
    return _Iterate(t, excess, missed), states.tangent
