"""Passes of one rig: many sweeps of one vibrissa, and whether they say the same."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaincc

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError, require
from analytic.problem.readings import Readings

_BY_CHANCE = 0.01  # probability of so much scatter; less is no chance


@dataclass(frozen=True)
class Consistency:
    """Whether passes say the same, each for itself."""

    numbers: Floats  # shape (passes, unknowns); what each alone says; NaN where it says nothing
    scatter: Floats  # shape (unknowns,); standard deviation of these
    stated: Floats  # shape (unknowns,); what the noise lets one expect of it
    chi_square: float  # squares of their distances from what all say, over their covariances
    degrees: int  # of freedom of that

    @property
    def probability(self) -> float:
        """Of so large a chi square, by chance, of passes that differ by noise alone."""
        return float(gammaincc(self.degrees / 2, self.chi_square / 2))

    @property
    def consistent(self) -> bool:
        """Whether the passes may differ by noise alone."""
        return self.probability > _BY_CHANCE

    @property
    def farthest(self) -> int:
        """The pass that is farthest from the middle of all, over what its noise makes of it."""
        known = self.stated > 0  # the others are as all passes say
        away = np.abs(self.numbers - np.median(self.numbers, axis=0))[:, known] / self.stated[known]
        return int(np.argmax(away.max(axis=1)))


def consistency(by_pass: Sequence[tuple[Floats, Floats]]) -> Consistency:
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
    )


def as_passes(readings: "Readings | Sequence[Readings]") -> list[Readings]:
    """Sweeps of one rig as a list, whatever their number."""
    passes = list(readings) if isinstance(readings, Sequence) else [readings]
    if not passes:
        raise InputError("readings", "none", "one pass or more", "name the files of the passes")
    for one in passes:
        require("readings", one, Readings, "as Readings(table, beam)")
        if one.beam != passes[0].beam:
            raise InputError(
                "vibrissa",
                f"another one in {one.source} than in {passes[0].source}",
                "one and the same in all passes",
                "passes of different rigs say nothing together: take each rig's own",
            )
    return passes
