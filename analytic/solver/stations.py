"""The states at given foot positions, by Newton's method on both phases' closed forms."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.batches import put, take
from analytic.numerics.roots import zeros
from analytic.problem.contours.many import Contours
from analytic.solver.branch import Branch
from analytic.solver.equilibria import Equilibria, contact, contact_beside, equilibria_at, tip_rates
from analytic.solver.grid import Samples

_STEPS = 2  # of Newton's method on a cubic, from a parabola that is close to it
_DROP = 0.6  # of a hardly bent cantilever's tip, times its deflection squared [1/L]
_TURN = 1.5  # of its tip, by the deflection [rad/L]
_EPS = float(np.finfo(float).eps)
_ITERATIONS = 25  # of Newton's method; 2 or 3 are usual, some 20 close to a fold
_CLOSE = 1e-6  # of a step, relative; after it the misses are seen, not only what they should be
_LAST = 1e-8  # of the last step: what is of second order in it is rounding
_LAST_TURN = 1e-7  # of its rotation, relative
_MOST_TURNED = np.pi / 2  # rad of excess; from there the end would point back at the clamp
_FINEST = 4 * _EPS  # of the misses: another step would only try other roundings
_EXACT = 64 * _EPS  # of the misses, in units of the extent: some roundings of the closed forms


class Stations(NamedTuple):
    """Stations of many branches, shape (n,): whose, where, and between which contour parameters."""

    owner: Integers
    foot_x: Floats
    low: Floats
    high: Floats


class Starts(NamedTuple):
    """What is known of stations before any is solved, shape (n,)."""

    tangent: Booleans  # Phase B
    t: Floats  # contour parameter, nearly
    tip_rotation: Floats  # excess rotation of the tip [rad], nearly
    behind: Floats  # excess rotation where the station's cell ends [rad]


def located(
    contours: Contours, branches: Sequence[Branch], foot_x: Sequence[Floats]
) -> tuple[Stations, Starts]:
    """The cells that hold foot positions on branches, and the states there, nearly."""
    sizes = np.array([len(branch.t) for branch in branches])
    begins = np.cumsum(sizes) - sizes
    owner = np.repeat(np.arange(len(branches)), [len(places) for places in foot_x])
    cells = [branch.cells(places) for branch, places in zip(branches, foot_x, strict=True)]
    cell = np.concatenate(cells) + begins[owner]
    t = np.concatenate([branch.t for branch in branches])
    samples = Samples(*map(np.concatenate, zip(*(b.samples for b in branches), strict=True)))
    # A branch has one cell less than it has points; the one that follows its last is none.
    tangent = np.concatenate([np.append(branch.tangent, False) for branch in branches])[cell]
    stations = Stations(owner, np.concatenate(foot_x), t[cell + 1], t[cell])

    tau = np.sqrt(np.repeat(t[begins], sizes) - t)
    by_tau = -2 * tau
    with np.errstate(invalid="ignore"):
        in_b, in_a = by_tau * samples.tangent_rate, by_tau * samples.tip_rate
        turn = by_tau * samples.tip_rotation_rate
    first = contours.at(np.arange(len(branches)), t[begins])
    deflection = np.sqrt(np.maximum(first.stretch * np.sin(first.alpha), 0.0) / _DROP)
    in_b[begins], in_a[begins], turn[begins] = 0.0, -deflection, _TURN * deflection

    width = tau[cell + 1] - tau[cell]
    ends = tuple(samples.foot_x[cell + i] for i in (0, 1))
    slopes = tuple(np.where(tangent, in_b[cell + i], in_a[cell + i]) * width for i in (0, 1))
    share = _share(_cubic(ends, slopes), stations.foot_x)
    low, high = (samples.tip_rotation[cell + i] for i in (0, 1))
    rotation = _cubic((low, high), tuple(turn[cell + i] * width for i in (0, 1)))
    return stations, Starts(
        tangent,
        np.clip(t[begins][owner] - (tau[cell] + share * width) ** 2, stations.low, stations.high),
        np.clip(_value(rotation, share), np.minimum(low, high), np.maximum(low, high)),
        high,
    )


def _cubic(ends: tuple[Floats, Floats], slopes: tuple[Floats, ...]) -> tuple[Floats, ...]:
    """Coefficients of cubics by values and rates at 0 and 1; a chord where no rate is known."""
    before, after = ends
    rise = after - before
    with np.errstate(invalid="ignore"):
        known = np.isfinite(slopes[0]) & np.isfinite(slopes[1])
    first, last = (np.where(known, slope, rise) for slope in slopes)
    return before, first, 3 * rise - 2 * first - last, first + last - 2 * rise


def _value(cubic: tuple[Floats, ...], share: Floats) -> Floats:
    constant, first, second, third = cubic
    return constant + share * (first + share * (second + share * third))


def _share(cubic: tuple[Floats, ...], value: Floats) -> Floats:
    """Where between 0 and 1 cubics have a value that lies between those at their ends."""
    constant, first, second, third = cubic
    with np.errstate(all="ignore"):
        rise = first + second + third
        last = first + 2 * second + 3 * third
        way, slope = (value - constant) / rise, 2 - last / rise
        root = np.sqrt(np.maximum(slope * slope + 4 * (1 - slope) * way, 0.0))
        share = np.clip(np.nan_to_num(2 * way / (slope + root), nan=0.5), 0.0, 1.0)
        for _ in range(_STEPS):
            step = (_value(cubic, share) - value) / (
                first + share * (2 * second + share * 3 * third)
            )
            share = np.clip(share - np.where(np.isfinite(step), step, 0.0), 0.0, 1.0)
    return share


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
