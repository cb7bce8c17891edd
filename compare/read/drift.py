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
from analytic.from_clamp.noise import rounding
from analytic.problem.arrays import Booleans, Floats

FEWEST = 5  # rows of a stretch whose mean is a zero, and of a pass
_CLEARLY = 5.0  # standard deviations of a slope of which nothing is taken off
_ALIKE = 0.95  # of what blocks may show of a memory; more looks as a drift does
_BY_CHANCE = 0.01  # probability of slopes that differ so much; less is a drift that bends
# Times the drift is what bends are like before any slope is seen: a warming sensor's, exp(-4 u)
# over the pass, has 2.3 and 0.9, a parabola that goes up and half of the way down again has 4.
_AS_BENT = 3.0


class Zero(NamedTuple):
    """Of the clamp readings before the contact, and how it drifts until after it."""

    before: Floats  # shape (3,)
    drift: Floats  # shape (3,)
    uncertainty: Floats  # shape (3,); NaN of one stretch, which shows no drift
    line: Floats  # shape (3, rows); from the one stretch to the other
    share: Floats  # shape (rows,); of the way from the one stretch to the other
    # Shape (2, 3); by how much the zero would miss the other stretch if it went on as in either,
    # and how well that is known. NaN of one stretch.
    bend: Floats
    bend_uncertainty: Floats  # of white noise
    # Shape (2, 3); times its variance is that of means of blocks, 1 of white noise; and the rows of
    # a block, times which it is of noise that remembers longer.
    memory: Floats
    most: Floats
    # Shape (3,); of one stretch, by how much it would drift over the pass if it went on as there; 0
    # where that is within noise.
    ahead: Floats


def no_zero(values: Floats) -> Zero:
    """Where no stretch is known to be free."""
    unknown, each = np.full(len(values), np.nan), np.full((2, len(values)), np.nan)
    line = np.full_like(values, np.nan)
    nowhere, none = np.zeros(values.shape[1]), np.zeros(len(values))
    return Zero(unknown, unknown, unknown, line, nowhere, each, each, each, each, none)


def zero_of(foot_x: Floats, values: Floats, free: dict[str, Booleans], name: str) -> Zero:
    """The zero that the free stretches of a pass show, as a line through their means."""
    means, places, uncertain, most = [], [], [], []
    slopes, slope_uncertain, remembered = [], [], []
    rounded = np.array([rounding(row) for row in values])
    for which, here in free.items():
        sound = here & np.isfinite(values).all(axis=0)
        if sound.sum() < FEWEST:
            raise InputError(
                f"passes.{which}",
                f"a stretch with {sound.sum()} rows of {name}",
                f"one with {FEWEST} or more",
                "take a longer one, or leave it out",
            )
        means.append(values[:, sound].mean(axis=1))
        places.append(foot_x[sound].mean())
        # Noise that remembers makes the means of blocks scatter more than white noise would.
        blocks = np.array_split(values[:, sound], FEWEST, axis=1)
        levels = np.array([x.mean(axis=1) for x in blocks])
        with np.errstate(over="ignore", invalid="ignore"):  # such numbers are refused later
            between = np.std(levels, axis=0, ddof=1) / np.sqrt(FEWEST)
            white = values[:, sound].std(axis=1, ddof=1) / np.sqrt(sound.sum())
            slope, known, memory = _slope(foot_x[sound], values[:, sound], levels)
        uncertain.append(np.max([between, white, rounded], axis=0))
        slopes.append(slope)
        slope_uncertain.append(known)
        remembered.append(memory)
        most.append(np.full_like(memory, sound.sum() / FEWEST))
    drift, way = means[-1] - means[0], places[-1] - places[0]
    share = (foot_x - places[0]) / way if way != 0 else np.zeros_like(foot_x)
    line = means[0][:, None] + drift[:, None] * share
    if len(free) < 2 or way == 0:
        shown = np.abs(slopes[0]) > _CLEARLY * slope_uncertain[0]
        ahead = np.where(shown, slopes[0] * (foot_x[-1] - foot_x[0]), 0.0)
        return no_zero(values)._replace(before=means[0], line=line, ahead=ahead)
    bend = way * np.array(slopes) - drift
    of_bend = np.hypot(abs(way) * np.array(slope_uncertain), np.hypot(*uncertain))
    known, none = np.max(uncertain, axis=0), np.zeros_like(drift)
    more = np.array(remembered), np.array(most)
    return Zero(means[0], drift, known, line, share, bend, of_bend, *more, none)


def _slope(x: Floats, values: Floats, levels: Floats) -> tuple[Floats, Floats, Floats]:
    """Slopes of a stretch, their standard deviations by white noise, and what memory adds."""
    away = x - x.mean()
    square = max(float(away @ away), np.finfo(float).tiny)
    slope = values @ away / square
    left = values - values.mean(axis=1, keepdims=True) - slope[:, None] * away
    white = np.sum(left**2, axis=1) / max(len(x) - 2, 1)
    blocks = np.array([part.mean(axis=1) for part in np.array_split(left, len(levels), axis=1)])
    scatter = np.sum(blocks**2, axis=0) / (len(levels) - 2) * (len(x) / len(levels))
    memory = np.divide(scatter, white, out=np.ones_like(white), where=white > 0)
    return slope, np.sqrt(white / square), memory


class Bent(NamedTuple):
    """By how much the zero of a pass is off its line."""

    away: Floats  # shape (3, rows)
    uncertainty: Floats  # shape (3,); root mean square over the way
    shows: bool  # whether that is more than noise would seem to bend


def bent(zeros: Sequence[Zero]) -> list[Bent]:
    """What the drift of all passes of a rig has besides lines."""
    bends = np.array([one.bend for one in zeros])
    # Three degrees of freedom of a stretch are few: those of all passes say how noise remembers.
    memory, most = np.mean([(one.memory, one.most) for one in zeros], axis=(0, 2))
    memory = np.maximum(memory, memory.mean())  # some passes of one reading say little of it
    # Noise that remembers from one block to the next makes them alike: they show less of it. So far
    # as here slopes of AR(0.5) to AR(0.97) scatter, to 10 %.
    memory = np.maximum(1.0, memory / (1 - np.minimum(memory / most, _ALIKE)))
    sizes = np.array([one.bend_uncertainty for one in zeros]) * np.sqrt(memory)
    sizes = np.maximum(sizes, np.finfo(float).tiny)
    mean, of_mean = _weighted(bends, sizes**2)
    alike = _no_chance(mean / np.sqrt(of_mean), mean.size)  # what all passes have shows first
    shows = alike or _no_chance(bends / sizes, bends.size)
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
