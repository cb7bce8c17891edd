"""Where Newton's method starts: on cubics by the root of the way from first contact."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.many import Contours
from analytic.solver.branch import Branch
from analytic.solver.grid import Samples

_STEPS = 2  # of Newton's method on a cubic, from a parabola that is close to it
_DROP = 0.6  # of a hardly bent cantilever's tip, times its deflection squared [1/L]
_TURN = 1.5  # of its tip, by the deflection [rad/L]


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
