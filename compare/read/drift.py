"""The zero of clamp readings over a pass: a line between free stretches, and how it bends.

What the sensor reads at either end says where the zero is there, and by its slope where it goes.
One stretch shows little of a slope; all passes of a rig together show whether zeros drift along a
curve, and that of each pass is then between its own slopes and what all of them have in the mean
(empirical Bayes). A zero that does not drift is not taken to bend, either.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from scipy.special import gammaincc

from analytic import InputError
from analytic.from_clamp.correlated import estimate
from analytic.from_clamp.noise import rounding
from analytic.numerics.arrays import Booleans, Floats

FEWEST = 5  # rows of a stretch whose mean is a zero, and of a pass
# Standard deviations of a slope of which nothing is taken off; 0.4 % are more by noise alone.
_CLEARLY = 3.0
_SHOWN = 30  # rows of all stretches: what fewer are off their lines is no measure of the noise
_BY_CHANCE = 0.01  # probability of slopes that differ so much; less is a drift that bends
# Times the drift is what bends are like before any slope is seen: a warming sensor's, exp(-4 u)
# over the pass, has 2.3 and 0.9, a parabola that goes up and half of the way down again has 4.
_AS_BENT = 3.0


class Stretch(NamedTuple):
    """The rows of a pass in which the vibrissa is free."""

    foot_x: Floats  # shape (rows,)
    values: Floats  # shape (3, rows)


class Zero(NamedTuple):
    """Of the clamp readings before the contact, and how it drifts until after it."""

    before: Floats  # shape (3,)
    drift: Floats  # shape (3,)
    uncertainty: Floats  # shape (3,); NaN of one stretch, which shows no drift
    line: Floats  # shape (3, rows); from the one stretch to the other
    share: Floats  # shape (rows,); of the way from the one stretch to the other
    stretches: tuple[Stretch, ...]  # that it is from
    # Shape (3,); of one stretch, by how much it would drift over the pass if it went on as there; 0
    # where that is within noise.
    ahead: Floats


def no_zero(values: Floats) -> Zero:
    """Where no stretch is known to be free."""
    unknown, nowhere = np.full(len(values), np.nan), np.zeros(values.shape[1])
    line = np.full_like(values, np.nan)
    return Zero(unknown, unknown, unknown, line, nowhere, (), np.zeros(len(values)))


def zero_of(foot_x: Floats, values: Floats, free: dict[str, Booleans], name: str) -> Zero:
    """The zero that the free stretches of a pass show, as a line through their means."""
    stretches = []
    for which, here in free.items():
        sound = here & np.isfinite(values).all(axis=0)
        if sound.sum() < FEWEST:
            what = f"a stretch with {sound.sum()} rows of {name}, which spans {np.ptp(foot_x):.3g}"
            remedy = "take a longer one, leave it out, or check the unit and the gain of foot_x"
            raise InputError(f"passes.{which}", what, f"one with {FEWEST} or more", remedy)
        stretches.append(Stretch(foot_x[sound], values[:, sound]))
    means = [one.values.mean(axis=1) for one in stretches]
    uncertain = [_of_mean(one.values) for one in stretches]
    places = [one.foot_x.mean() for one in stretches]
    with np.errstate(over="ignore", invalid="ignore"):  # such numbers are refused later
        slopes, variances = _slopes(stretches)
    drift, way = means[-1] - means[0], places[-1] - places[0]
    share = (foot_x - places[0]) / way if way != 0 else np.zeros_like(foot_x)
    line = means[0][:, None] + drift[:, None] * share
    if len(stretches) < 2 or way == 0:
        shown = np.abs(slopes[0]) > _CLEARLY * np.sqrt(variances[0])
        ahead = np.where(shown, slopes[0] * (foot_x[-1] - foot_x[0]), 0.0)
        return no_zero(values)._replace(before=means[0], line=line, ahead=ahead)
    rounded = np.array([rounding(row) for row in values])
    known = np.max([*uncertain, rounded], axis=0)
    return Zero(means[0], drift, known, line, share, tuple(stretches), np.zeros_like(drift))


def _of_mean(values: Floats) -> Floats:
    """Standard deviation of means: of blocks, which noise that remembers makes scatter more."""
    blocks = [one.mean(axis=1) for one in np.array_split(values, FEWEST, axis=1)]
    with np.errstate(over="ignore", invalid="ignore"):  # such numbers are refused later
        between = np.std(blocks, axis=0, ddof=1) / np.sqrt(FEWEST)
        white = values.std(axis=1, ddof=1) / np.sqrt(values.shape[1])
    return np.asarray(np.maximum(between, white))


def _slopes(stretches: Sequence[Stretch]) -> tuple[Floats, Floats]:
    """Slopes of the readings of each stretch, and their variances, each shape (stretches, 3).

    By the noise of all stretches, whatever it remembers: it may seem to drift along a curve.
    """
    away = [one.foot_x - one.foot_x.mean() for one in stretches]
    widths = [float(np.ptp(x)) or 1.0 for x in away]
    lines = np.concatenate([x / width for x, width in zip(away, widths, strict=True)])
    columns = np.stack([np.ones_like(lines), lines], axis=1)[:, None, :]
    rows = [len(x) for x in away]
    slopes, variances = np.zeros((2, len(rows), 3))
    for i in range(3):
        seen = [one.values[i] for one in stretches]
        size = max(float(np.std(np.concatenate([np.diff(x) for x in seen]))), *map(rounding, seen))
        if size == 0:
            continue  # a channel that stands still, and is refused for that where others do not
        readings = np.concatenate([x - x.mean() for x in seen])[:, None] / size
        none = np.zeros((len(readings), 1, 0)), np.zeros(0)
        found = estimate(readings, columns, *none, rows=rows).by_pass
        for k, ((_, slope), covariance) in enumerate(found):
            slopes[k, i] = size * slope / widths[k]
            variances[k, i] = size**2 * covariance[1, 1] / widths[k] ** 2
    return slopes, variances


class Bent(NamedTuple):
    """By how much the zero of a pass is off its line."""

    away: Floats  # shape (3, rows)
    uncertainty: Floats  # shape (3,); root mean square over the way
    shows: bool  # whether that is more than noise would seem to bend


def bent(zeros: Sequence[Zero]) -> list[Bent]:
    """What the drift of all passes of a rig has besides lines."""
    # Noise is of one kind in all passes, which show more of it than two short stretches.
    stretches = [stretch for one in zeros for stretch in one.stretches]
    slopes, variances = _slopes(stretches)
    slopes, variances = slopes.reshape(-1, 2, 3), variances.reshape(-1, 2, 3)
    means = np.array([one.uncertainty for one in zeros])
    ways = np.array([np.diff([x.foot_x.mean() for x in one.stretches]) for one in zeros])
    # By how much a zero would miss the other stretch if it went on as in either.
    bends = ways[:, :, None] * slopes - np.array([one.drift for one in zeros])[:, None]
    squares = ways[:, :, None] ** 2 * variances + 2 * means[:, None] ** 2
    sizes = np.sqrt(np.maximum(squares, np.finfo(float).tiny))
    mean, of_mean = _weighted(bends, sizes**2)
    alike = _no_chance(mean / np.sqrt(of_mean), mean.size)  # what all passes have shows first
    shows = sum(len(one.foot_x) for one in stretches) >= _SHOWN
    shows = shows and (alike or _no_chance(bends / sizes, bends.size))
    excess = np.zeros_like(mean)
    freedom = bends.size - mean.size
    if freedom and _no_chance((bends - mean) / sizes, freedom):  # each pass bends by its own
        excess = np.sum((bends - mean) ** 2 - sizes**2, axis=0) / (len(zeros) - 1)
        excess = np.maximum(excess + of_mean, 0.0)
        mean, of_mean = _weighted(bends, sizes**2 + excess)
    drifts = np.array([one.drift**2 - 2 * one.uncertainty**2 for one in zeros]).mean(axis=0)
    expected = _AS_BENT**2 * np.maximum(drifts, 0.0)
    expected = np.maximum(expected, mean**2 - of_mean if shows else 0.0)
    shrunk = expected / (expected + of_mean)
    middle, of_middle = shrunk * mean, shrunk * of_mean
    own = excess / (excess + sizes**2)
    best = middle + own * (bends - middle)
    known = own * sizes**2 + (1 - own) ** 2 * of_middle
    if not shows:  # the line stays, as uncertain as what is not seen of a bend
        best, known = np.zeros_like(best), known + best**2
    return [
        Bent(_hermite(zero.share, ends), np.sqrt(_SQUARES @ variance), shows)
        for zero, ends, variance in zip(zeros, best, known, strict=True)
    ]


def _no_chance(over_noise: Floats, freedom: int) -> bool:
    """Whether numbers over their standard deviations are more than noise makes of them."""
    return bool(gammaincc(freedom / 2, float(np.sum(over_noise**2)) / 2) < _BY_CHANCE)


def _weighted(values: Floats, variances: Floats) -> tuple[Floats, Floats]:
    """The mean over passes, and its variance."""
    weights = 1 / variances
    return np.sum(weights * values, axis=0) / weights.sum(axis=0), 1 / weights.sum(axis=0)


def _hermite(share: Floats, bends: Floats) -> Floats:
    """The cubic that vanishes at both stretches and has these slopes there, (3, rows)."""
    inside = np.clip(share, 0.0, 1.0)
    ends = np.array([inside * (1 - inside) ** 2, -(inside**2) * (1 - inside)])
    ends += np.where(share < 0, [share, 0 * share], np.where(share > 1, [0 * share, share - 1], 0))
    return np.asarray(bends.T @ ends)


_WAY = np.linspace(0, 1, 101)
_SQUARES = np.mean(_hermite(_WAY, np.eye(2)) ** 2, axis=1)
