"""Passes of one rig: many sweeps of one vibrissa, and whether they say the same."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from scipy.special import fdtrc, gammaincc

from analytic.from_clamp.correlated import NoiseFound
from analytic.numerics.arrays import Floats, Integers
from analytic.problem.errors import InputError
from analytic.problem.readings import Readings, require_readings

_One = TypeVar("_One")
_BY_CHANCE = 0.01  # probability of so much scatter, or of so little; less is no chance
_HARDLY = 1e-3  # the same of passes that leave the same; of few the test is right to a factor of 6
_FEWEST = 3  # passes; two do not show over how many places noise remembers
ROUNDING = 1e-2  # of the noise; what is left is less only of readings without any
_PLACES = 20  # along the way, at which passes are held against each other


@dataclass(frozen=True)
class Consistency:
    """Whether passes say the same, each for itself."""

    numbers: Floats  # shape (passes, unknowns); what each alone says; NaN where it says nothing
    scatter: Floats  # shape (unknowns,); standard deviation of these
    stated: Floats  # shape (unknowns,); what the noise lets one expect of it
    chi_square: float  # squares of their distances from what all say, over their covariances
    degrees: int  # of freedom of that
    # Probability that what they leave at the same places is alike by chance; None of less than
    # three to one side.
    alike: float | None

    @property
    def probability(self) -> float:
        """Of so large a chi square, by chance, of passes that differ by noise alone."""
        return float(gammaincc(self.degrees / 2, self.chi_square / 2))

    @property
    def consistent(self) -> bool:
        return self.probability > _BY_CHANCE

    @property
    def too_alike(self) -> bool:
        """Whether they differ by less than what was taken for noise makes them."""
        return self.probability > 1 - _BY_CHANCE

    @property
    def leave_alike(self) -> bool:
        """Whether they leave the same at the same places, which is no noise."""
        return self.alike is not None and self.alike <= _HARDLY

    @property
    def farthest(self) -> int:
        """The pass that is farthest from the middle of all, over what its noise makes of it."""
        known = self.stated > 0  # the others are as all passes say
        away = np.abs(self.numbers - np.median(self.numbers, axis=0))[:, known] / self.stated[known]
        return int(np.argmax(away.max(axis=1)))


def left_by_noise(noise: NoiseFound, passes: Consistency | None, misfit: float) -> bool:
    """Whether what is left, `misfit` times the noise, differs between passes, or is soon forgotten.

    What is wrong in all passes does neither; rounding counts as noise.
    """
    if passes is not None and passes.alike is not None:
        return not passes.leave_alike
    return misfit < ROUNDING or not noise.lasts.any()


def consistency(
    by_pass: Sequence[tuple[Floats, Floats]], alike: float | None = None
) -> Consistency:
    """Hold the numbers of each pass, with their covariances, against what all passes say."""
    numbers = np.array([found for found, _ in by_pass])
    covariances = np.array([covariance for _, covariance in by_pass])
    weights = np.linalg.pinv(covariances, hermitian=True)
    mean = np.linalg.pinv(weights.sum(axis=0)) @ np.einsum("pij,pj->i", weights, numbers)
    away = numbers - mean
    stated = np.sqrt(np.einsum("pii->pi", covariances).mean(axis=0))
    own = int(np.sum(stated > 0))
    return Consistency(
        numbers,
        numbers.std(axis=0, ddof=1),
        stated,
        float(np.einsum("pi,pij,pj->", away, weights, away)),
        (len(numbers) - 1) * own,
        alike,
    )


def alike_by_chance(
    left: Floats, by_number: Floats, drift: Floats, foot_x: Floats, rows: Sequence[int]
) -> float | None:
    """Probability that passes leave by chance so much alike at the same places.

    What is wrong in all passes to one side is left by all at the same places; noise is not, however
    long it remembers. `left`, `by_number` and `rows` are those of `correlated.estimate`, `drift` is
    what a reading's zero and its slope do; what a change of the numbers explains does not count.
    There is none of less than three passes to one side.
    """
    each = np.split(foot_x, np.cumsum(rows)[:-1])
    to_right = np.array([x[-1] > x[0] for x in each])
    found: list[float] = []
    for some in (np.flatnonzero(to_right), np.flatnonzero(~to_right)):
        if len(some) < _FEWEST:
            continue
        first, last = max(each[i].min() for i in some), min(each[i].max() for i in some)
        number = np.full(len(rows), len(some))
        number[some] = np.arange(len(some))
        number = np.where((foot_x < first) | (foot_x > last), len(some), np.repeat(number, rows))
        along = np.clip((foot_x - first) / (last - first) * _PLACES, 0, _PLACES - 1)
        cell = _PLACES * number + along.astype(int)  # behind all passes what does not count
        means = np.concatenate(
            [_means(one, cell, len(some)) for one in (left[:, :, None], by_number, drift)]
        )
        means = means[:, :, np.isfinite(means).all(axis=(0, 1))]
        shapes = np.linalg.qr(means[1:].mean(axis=1).T)[0]
        # Each pass has a zero of its own, so of its drift more than of the rest is chance.
        by_drift = means[0] @ shapes[:, by_number.shape[2] :]
        rest = means[0] - means[0] @ shapes @ shapes.T
        freedom = len(shapes) - len(shapes.T)
        found += [_by_chance(by_drift, drift.shape[2]), _by_chance(rest, freedom)]
    return min(1.0, len(found) * min(found)) if found else None


def _means(columns: Floats, cell: Integers, passes: int) -> Floats:
    """Means of columns (n, readings, m) at places of passes, shape (m, passes, ...)."""
    cells, (n, readings, m) = passes * _PLACES, columns.shape
    counts = np.bincount(cell, minlength=cells)[:cells]
    sums = [np.bincount(cell, one, cells)[:cells] for one in columns.reshape(n, -1).T]
    with np.errstate(invalid="ignore"):  # of no stations there is no mean
        means = np.reshape(sums / counts, (readings, m, passes, _PLACES))
    return means.transpose(1, 2, 0, 3).reshape(m, passes, -1)


def _by_chance(curves: Floats, most: int) -> float:
    """Probability that curves of noise, shape (passes, places), have so large a mean.

    An F test of curves, with Box's degrees of freedom, `most` or less (Shen and Faraway 2004).
    """
    passes, mean = len(curves), curves.mean(axis=0)
    n = passes - 1
    products = (curves - mean) @ (curves - mean).T / n
    trace, square = np.trace(products), np.sum(products**2)
    # Both without bias, for curves of a normal distribution: (tr S)^2 and tr S^2 of few are not.
    of_squares = (n + 1) * (trace**2 - 2 * square / (n + 1)) / n
    freedom = of_squares / max(square - trace**2 / n, of_squares / most)
    return float(fdtrc(freedom, n * freedom, passes * (mean @ mean) / trace))


def listed(readings: _One | Sequence[_One]) -> list[_One]:
    """One sweep or several."""
    passes = list(readings) if isinstance(readings, Sequence) else [readings]
    if not passes:
        raise InputError("readings", "none", "one pass or more", "name the files of the passes")
    return passes


def as_passes(readings: "Readings | Sequence[Readings]") -> list[Readings]:
    """Sweeps of one rig as a list, whatever their number."""
    passes = listed(readings)
    for one in passes:
        require_readings(one)
        if one.beam != passes[0].beam:
            different = (
                f"L = {x.beam.length:g}, EI = {x.beam.base_rigidity:g}, r = {x.beam.radius:g} "
                f"({x.source})"
                for x in (passes[0], one)
            )
            raise InputError(
                "vibrissae",
                " and ".join(different),
                "one and the same in all passes",
                "passes of different rigs say nothing together: take each rig's own",
            )
    return passes
