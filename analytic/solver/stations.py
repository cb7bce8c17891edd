"""The states at given foot positions, by Newton's method on both phases' closed forms."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from analytic.numerics.batches import put, take
from analytic.numerics.roots import zeros
from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.many import Contours
from analytic.solver.branch import Branch
from analytic.solver.equilibria import Equilibria, contact, contact_beside, equilibria_at, tip_rates
from analytic.solver.starts import Stations, located

_EPS = float(np.finfo(float).eps)
_ITERATIONS = 25  # of Newton's method; 2 or 3 are usual, some 20 close to a fold
_CLOSE = 1e-6  # of a step, relative; after it the misses are seen, not only what they should be
_LAST = 1e-8  # of the last step: what is of second order in it is rounding
_LAST_TURN = 1e-7  # of its rotation, relative
_MOST_TURNED = np.pi / 2  # rad of excess; from there the end would point back at the clamp
_FINEST = 4 * _EPS  # of the misses: another step would only try other roundings
_EXACT = 64 * _EPS  # of the misses, in units of the extent: some roundings of the closed forms


class _Iterate(NamedTuple):
    """Stations, shape (n,), as far as they are solved."""

    t: Floats
    missed: Floats
    states: Equilibria


def solve_stations(
    contours: Contours, branches: Sequence[Branch], foot_x: Sequence[Floats]
) -> Equilibria:
    """The states at foot positions on branches, by Newton's method, else enclosed."""
    stations, (tangent, t, tip_rotation, behind) = located(contours, branches, foot_x)
    found = _newton(contours, stations, tangent, (t, tip_rotation))
    poor = (~(_admissible(found.states) & (found.missed <= _EXACT))).nonzero()[0]
    if poor.size:
        few = take(stations, poor)
        enclosed = _enclose(contours, few, behind[poor])
        start = enclosed.t.copy(), enclosed.states.tip_rotation
        refined = _newton(contours, few, enclosed.states.tangent, start)
        better = _admissible(refined.states) & (refined.missed < enclosed.missed)
        put(found, poor, enclosed)
        put(found, poor[better], take(refined, better))
    return found.states


@np.errstate(all="ignore")  # folds and first contacts: what is not finite is no step
def _newton(
    contours: Contours, stations: Stations, tangent: Booleans, start: tuple[Floats, Floats]
) -> _Iterate:
    """The iterate that misses least, of each station."""
    t, tip_rotation = start
    best: _Iterate | None = None
    step = np.full_like(t, np.inf)
    going = np.arange(t.size)
    for _ in range(_ITERATIONS):
        owner, foot_x, low, high = stations
        states = contact(contours.at(owner, t), tip_rotation, tangent)
        now, too_high, too_far = _seen(t, states, foot_x)
        less = now.missed < np.inf if best is None else now.missed <= best.missed[going]
        best = now if best is None else _improved(best, going, now, less)
        enough = (now.missed <= _FINEST) | (~less & (now.missed <= _EXACT))
        done = (enough & (step <= _CLOSE)) | (now.missed == 0)
        if done.all():
            break
        step_t, step_w = _steps(states, too_high, too_far)
        step_t = np.where(np.isfinite(step_t), step_t, 0.0)
        step_w = np.where(np.isfinite(step_w), step_w, 0.0)
        new_t = np.minimum(np.maximum(t - step_t, low), high)
        new_excess = np.minimum(np.maximum(tip_rotation - step_w, tip_rotation / 10), _MOST_TURNED)
        moved = np.abs(new_t - t)
        # As much as the rotation itself, or more, is no last step.
        turned = np.where(step_w == 0, 0.0, np.abs(step_w) / tip_rotation)
        t, tip_rotation = new_t, new_excess
        small = (moved <= _LAST) & (turned <= _LAST_TURN) & np.isfinite(step)
        last = small.nonzero()[0]
        if last.size:
            point = contours.at(owner[last], t[last])
            near = contact_beside(take(states, last), point, tip_rotation[last])
            beside = _seen(t[last], near, foot_x[last])[0]
            best = _improved(best, going[last], beside, beside.missed <= best.missed[going[last]])
        more = (~(done | small)).nonzero()[0]
        if not more.size:
            break
        t, tip_rotation, step = t[more], tip_rotation[more], np.maximum(moved, turned)[more]
        going, stations, tangent = going[more], take(stations, more), tangent[more]
    assert best is not None
    return best


def _improved(best: _Iterate, where: Integers, new: _Iterate, better: Booleans) -> _Iterate:
    """The best iterates, with others in the place of some where those are better."""
    if better.all() and where.size == best.t.size:
        return new
    put(best, where[better], take(new, better))
    return best


def _seen(t: Floats, states: Equilibria, foot_x: Floats) -> tuple[_Iterate, Floats, Floats]:
    """Iterates, and by how much each contact lies above and behind the contour's point [L]."""
    point = states.point
    height = states.frame.up / states.root_f
    too_high, too_far = height - point.eta, foot_x - states.foot_x
    # A rounding of the parameter moves the point by the stretch times that.
    extent = np.maximum(np.maximum(1.0, np.abs(point.xi)), point.stretch * np.abs(t))
    missed = np.fmax(np.abs(too_high), np.abs(too_far)) / extent
    return _Iterate(t, np.where(np.isnan(missed), np.inf, missed), states), too_high, too_far


def _steps(states: Equilibria, too_high: Floats, too_far: Floats) -> tuple[Floats, Floats]:
    """Newton's step of the contour parameter and of the excess rotation."""
    alpha, _, _, turning, stretch = states.point
    height, reach = tip_rates(states.tip_rotation, states.span, alpha, states.frame)
    height_t = turning * height.by_alpha - stretch * np.sin(alpha)
    reach_t = turning * reach.by_alpha - stretch * np.cos(alpha)
    determinant = height_t * reach.by_excess - reach_t * height.by_excess
    step_t = (too_high * reach.by_excess - too_far * height.by_excess) / determinant
    step_w = (height_t * too_far - reach_t * too_high) / determinant
    return (
        np.where(states.tangent, -too_far / states.tangent_rate(), step_t),
        np.where(states.tangent, 0.0, step_w),
    )


def _admissible(states: Equilibria) -> Booleans:
    """Whether contacts are of the phase that they should be of."""
    fits = (states.root_f > 0) & (states.span.q <= states.root_f * (1 + _EXACT))
    above = states.tip_rotation <= np.pi / 2 - np.abs(states.point.alpha) + _EXACT
    return np.asarray(np.where(states.tangent, fits, above))


def _enclose(contours: Contours, stations: Stations, behind: Floats) -> _Iterate:
    """Stations enclosed along the contour, in whichever phase; cells end at `behind`."""
    owner, foot_x, low, high = stations

    def ahead(station: Integers, t: Floats) -> Floats:
        found = equilibria_at(contours.at(owner[station], t)).foot_x - foot_x[station]
        return np.where(np.isnan(found), 1.0, found)  # the first contact itself

    every = np.arange(owner.size)
    at_low, at_high = ahead(every, low), ahead(every, high)
    t = zeros(ahead, low, high)
    t = np.where(at_low >= 0, low, np.where(at_high <= 0, high, t))
    states = equilibria_at(contours.at(owner, t))
    first = np.isnan(states.tip_rotation)
    tip_rotation = np.where(first, behind * 1e-3, states.tip_rotation)
    states = contact(contours.at(owner, t), tip_rotation, states.tangent)
    return _seen(t, states, foot_x)[0]
