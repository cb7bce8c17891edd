"""The numbers that fit readings best, for the noise that these show."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.special import softmax

from analytic.from_clamp.calibration.fit import LeastSquaresFit
from analytic.from_clamp.calibration.measured import Measured
from analytic.from_clamp.calibration.unknowns import LAG, OFFSET
from analytic.from_clamp.correlated import Estimated, estimate
from analytic.from_clamp.noise import MEDIAN_OF_NORMAL
from analytic.from_clamp.passes import ROUNDING, alike_by_chance
from analytic.numerics.arrays import Floats
from analytic.problem.columns import CLAMP_READINGS
from analytic.problem.errors import InputError

_CLEARLY = 4.0  # standard deviations; by chance once in 10^4 sweeps
_TRIED = 60  # sizes of a jitter
_INDEPENDENT = 2 / 3


_NOT_EXPLAINED = 0.1  # share of the stations that may be of no such vibrissa
_ROUNDS = 4  # of fits, as stations that are of no such vibrissa are left out
_NOISE_KNOWN_TO = 1.1  # times what is stated
_CHANCE = 3.0  # standard deviations of a misfit, which is 1 +- 1/sqrt(2 n)
_SATISFIED = 1.5  # times the noise; a fit that leaves more is tried from elsewhere too
_STARTS = 3
_ENOUGH = 4000  # stations of which a fit is sought
_REFINED = 2  # steps from plain least squares to those that know the noise
_NO_BEND = 1e-3  # of the zero's uncertainty: that of a bend which there is not


def foot_jitter(
    left: Floats, slopes: Floats, rows: Sequence[int] | None = None
) -> tuple[float, Floats, bool]:
    """Standard deviation of the foot's place, what each reading has of its own, whether it shows.

    By differences between neighbouring stations, in which what is smooth cancels. The first is the
    root of its mean square over all that these allow: one that hides may be there. It shows where
    the products of two readings' differences do not scatter about zero. Of what a fit
    leaves over some sizes, and the slopes over the foot position over the same, each shape (n,
    readings); `rows` by pass, by default of one.
    """
    between = np.cumsum([len(left)] if rows is None else rows)[:-1] - 1  # passes: no steps
    steps = np.delete(np.diff(left, axis=0) / np.sqrt(2), between, axis=0)
    ways = np.delete((slopes[1:] + slopes[:-1]) / 2, between, axis=0)
    own = (np.median(np.abs(steps), axis=0) / MEDIAN_OF_NORMAL) ** 2
    one, other = np.triu_indices(len(own), 1)
    sizes = np.sqrt(own)
    if not sizes.all():
        return 0.0, sizes, False
    together = ways[:, one] * ways[:, other] / (sizes[one] * sizes[other])
    products = steps[:, one] * steps[:, other] / (sizes[one] * sizes[other])
    weight = np.sum(together**2)
    if not weight:
        return 0.0, sizes, False
    variance, scatter = max(np.sum(together * products), 0.0) / weight, 1 / np.sqrt(weight)
    most = 2 * np.sqrt(variance) + np.sqrt(_CLEARLY * scatter)
    tried, likely, each = most * np.linspace(0, 1, _TRIED + 1)[1:], [], []
    for deviation in tried:
        for _ in range(_ROUNDS):
            own = _own(steps, ways, own, deviation**2)
        # Of two neighbours' steps the station between is in both: they count as fewer.
        likely.append(_INDEPENDENT * _likelihood(steps, ways, own, deviation**2))
        each.append(own)
    share = softmax(likely)
    shows = bool(variance > _CLEARLY * scatter)
    return float(np.sqrt(share @ tried**2)), np.sqrt(share @ np.array(each)), shows


def _own(steps: Floats, ways: Floats, own: Floats, variance: float) -> Floats:
    """One step of expectation and maximum (EM): the variance of each reading beside the foot's."""
    spread = 1 / (1 / variance + np.sum(ways**2 / own, axis=1))
    along = ways * (spread * np.sum(ways * steps / own, axis=1))[:, None]
    return np.asarray(np.mean((steps - along) ** 2 + ways**2 * spread[:, None], axis=0))


def _likelihood(steps: Floats, ways: Floats, own: Floats, variance: float) -> float:
    """Logarithm of the steps' probability, but for a constant."""
    shown = 1 + variance * np.sum(ways**2 / own, axis=1)
    along = variance * np.sum(ways * steps / own, axis=1) ** 2 / shown
    return -float(np.sum(np.log(shown) + np.sum(steps**2 / own + np.log(own), axis=1) - along)) / 2


def fitted_to_noise(
    fit: LeastSquaresFit, stated: bool
) -> tuple[LeastSquaresFit, Floats, float, Estimated]:
    """The fit, its best numbers, what it leaves over the noise, and what that makes of them."""
    fit, numbers, cost = _fitted(fit)
    noisy = cost > ROUNDING**2 * fit.freedom
    jittered = _with_jitter(fit, numbers, stated) if noisy else None
    if jittered is not None:
        fit = fit.of(jittered)
    first = numbers
    numbers, known, relief = _knowing_the_noise(
        fit, numbers, 1.0 if stated and not jittered else 0.0
    )
    if relief and jittered is not None:
        cost = float(np.sum(fit.misses(first) ** 2))  # over that noise of which the relief is
    return fit, numbers, float(np.sqrt(max(cost - relief, 0.0) / fit.freedom)), known


def as_likely_by(spread: Floats, fit: LeastSquaresFit, numbers: Floats) -> Floats:
    """`Estimated.by_noise` of a fit that is found, over another noise and jitter."""
    over = fit.of(replace(fit.measured, spread=spread))
    return _knowing_the_noise(over, numbers, 0.0)[1].by_noise


def explained_by_noise(misfit: float, freedom: int, vague: float = 0.0) -> bool:
    """Whether what is left is no more than chance and the noise, known to a tenth, make of it.

    And not much more than the noise, however vaguely that is known: `Measured.vague`.
    """
    chance = _CHANCE * np.sqrt(1 / freedom / 2)
    more = _CHANCE * np.sqrt((1 / freedom + vague) / 2)
    return bool(misfit <= _NOISE_KNOWN_TO + max(chance, min(more, _SATISFIED - _NOISE_KNOWN_TO)))


def below_the_noise(misfit: float, freedom: int) -> bool:
    """Whether what is left is less than the noise, known to a tenth, and chance would leave."""
    return bool(misfit < 1 / _NOISE_KNOWN_TO - _CHANCE * np.sqrt(1 / freedom / 2))


def _fitted(fit: LeastSquaresFit) -> tuple[LeastSquaresFit, Floats, float]:
    """The fit, without the stations that are of no such vibrissa; its numbers, its squares."""
    every = len(fit.measured.foot_x)
    thinned = np.arange(every) % (every // _ENOUGH + 1) == 0  # to search where all would take long
    coarse = fit if thinned.all() else fit.of(fit.measured.at(thinned))
    numbers, cost = _best(coarse)
    if coarse is not fit:  # the steps that know the noise go on from here
        cost = float(np.sum(fit.misses(numbers) ** 2))
    for _ in range(_ROUNDS):
        expected = fit.expected(numbers)
        there = np.asarray(np.isfinite(expected).all(axis=0))
        touching = int(np.any(expected[:, there] != 0, axis=0).sum())
        if touching < (1 - _NOT_EXPLAINED) * every:
            untouched = f"at {every - touching} of which the best fit does not touch"
            what = f"loaded at {every} stations, {untouched}"
            allowed = "of the case's vibrissa and object, but for the unknowns"
            remedy = "check foot_x, units and object"
            if all(kind.name != OFFSET for kind in fit.kinds):
                remedy += ", or fit offset too"
            if turned := fit.measured.turned:
                remedy = (
                    f"the moment of {turned} is that of a sweep to the other side than foot_x "
                    "goes: reverse the rows, or change a sign"
                )
            raise InputError("readings", what, allowed, remedy)
        if there.all():
            break
        fit = fit.of(fit.measured.at(there))
        numbers, cost = fit.best_from(_inside(fit, numbers))
    return fit, numbers, cost


def _best(fit: LeastSquaresFit) -> tuple[Floats, float]:
    """The best numbers from the case's own, or from elsewhere if those leave too much."""
    starts, costs = fit.starts(), []
    for i, start in enumerate(starts):
        starts[i] = fit.scaled_rigidity(_inside(fit, start))
        costs.append(float(np.sum(fit.misses(starts[i]) ** 2)))
    enough = _SATISFIED**2 * fit.measured.readings.size
    best, least = starts[0], np.inf
    for at in np.argsort(costs)[:_STARTS].tolist():
        numbers, cost = fit.best_from(starts[at])
        if cost < least:
            best, least = numbers, cost
        if least < enough:
            break
    return best, least


def _inside(fit: LeastSquaresFit, numbers: Floats) -> Floats:
    return np.clip(numbers, fit.lowest, fit.highest)


def _with_jitter(fit: LeastSquaresFit, numbers: Floats, stated: bool) -> Measured | None:
    """The stations with the jitter of the foot that what is left shows, or may hide.

    None if it shows none and the noise is stated, which would have it.
    """
    measured = fit.measured
    foot, *sizes = measured.spread
    if foot > 0:
        return None
    expected = fit.expected(numbers)
    over = np.array(sizes)
    left, slopes = expected - measured.readings, measured.slopes(expected)
    jitter, own, shows = foot_jitter(left.T / over, slopes.T / over, measured.rows)
    if not jitter or (stated and not shows):
        return None
    spread = np.array([jitter, *np.maximum(own * over, measured.free)])
    return replace(measured, spread=spread, jitter=jitter if shows else 0.0)


def _knowing_the_noise(
    fit: LeastSquaresFit, numbers: Floats, least: float
) -> tuple[Floats, Estimated, float]:
    """The numbers that are best for the noise that the readings show.

    And by how much zeros and their drift, and hum beside a stated noise, lessen the sum of squares
    that there was.
    """
    measured = fit.measured
    curved = (measured.bend >= measured.zero).any()  # less of a curve than of a zero is none
    shapes, uncertain = [np.ones(sum(measured.rows))], [measured.zero]
    along = measured.along
    if len(measured.rows) > 1 or measured.bend.any():
        shapes, uncertain = [*shapes, along], [measured.zero, measured.zero]
    if measured.bend.any():
        bent = 1 - along**2  # a curve of any shape: a wrong one is wrong in all passes alike
        shapes += [bent, bent * along, bent**2, bent**2 * along]
        uncertain += 4 * [np.maximum(measured.bend, _NO_BEND * measured.zero)]
    nuisances = np.concatenate([x[:, None, None] * fit.whitening for x in shapes], axis=2)
    shared = [i for i, kind in enumerate(fit.kinds) if kind.name == LAG]  # one pass shows none
    known, relieved = np.concatenate(uncertain), []
    for _ in range(_REFINED):
        jacobian = fit.jacobian(numbers)
        for kind, column in zip(fit.kinds, jacobian.T, strict=True):
            if not column.any():
                allowed = "something that the readings depend on"
                raise InputError("unknowns", kind.called, allowed, "leave it out")
        by_number = jacobian.reshape(-1, len(CLAMP_READINGS), len(numbers))
        left = -fit.misses(numbers).reshape(-1, len(CLAMP_READINGS))
        found = estimate(
            left,
            by_number,
            nuisances,
            known,
            least,
            rows=measured.rows,
            shared=shared,
            since=measured.since,
        )
        relieved.append(found.relief + least * found.of_hum)
        by_pass = tuple((numbers + one, covariance) for one, covariance in found.by_pass)
        moved = _inside(fit, numbers + found.numbers)
        if not np.isfinite(fit.expected(moved)).any():  # too far, of what is hardly determined
            break
        numbers = moved
    straight, bent = np.split(nuisances, [2 * len(CLAMP_READINGS)], axis=2)
    explained = np.concatenate([by_number, bent], axis=2) if curved else by_number
    alike = alike_by_chance(left, explained, straight, measured.foot_x, measured.rows)
    # Of fits that find jitter and such that do not, the noise is not the same.
    whitened = found.stations * float(np.linalg.slogdet(fit.whitening)[1].mean())
    by_noise = found.by_noise + whitened / len(CLAMP_READINGS)
    found = replace(found, by_pass=by_pass, alike=alike, by_noise=by_noise)
    return numbers, found, relieved[0]
