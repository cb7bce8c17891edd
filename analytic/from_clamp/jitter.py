"""Jitter of the foot: it moves all readings of a station along their slopes at once."""

from collections.abc import Sequence

import numpy as np

from analytic.from_clamp.noise import MEDIAN_OF_NORMAL
from analytic.problem.arrays import Floats

_CLEARLY = 4.0  # standard deviations; by chance once in 10^4 sweeps
_ROUNDS = 100  # of expectation and maximum: 1e-3 of the sizes


def foot_jitter(
    left: Floats, slopes: Floats, rows: Sequence[int] | None = None
) -> tuple[float, Floats]:
    """Standard deviation of the foot's place, and what each reading has of its own.

    The first is 0 if it does not stand out. By the EM algorithm on differences between neighbouring
    stations, in which what is smooth cancels. Without jitter the products of two readings'
    differences scatter about zero. Of what a fit leaves over some sizes, and the slopes over the
    foot position over the same, each shape (n, readings); `rows` by pass, by default of one.
    """
    between = np.cumsum([len(left)] if rows is None else rows)[:-1] - 1  # passes: no steps
    steps = np.delete(np.diff(left, axis=0) / np.sqrt(2), between, axis=0)
    ways = np.delete((slopes[1:] + slopes[:-1]) / 2, between, axis=0)
    own = (np.median(np.abs(steps), axis=0) / MEDIAN_OF_NORMAL) ** 2
    one, other = np.triu_indices(len(own), 1)
    sizes = np.sqrt(own)
    if not sizes.all():
        return 0.0, sizes
    together = ways[:, one] * ways[:, other] / (sizes[one] * sizes[other])
    products = steps[:, one] * steps[:, other] / (sizes[one] * sizes[other])
    weight = np.sum(together**2)
    if not np.sum(together * products) > _CLEARLY * np.sqrt(weight):
        return 0.0, sizes
    variance = np.sum(together * products) / weight
    for _ in range(_ROUNDS):
        spread = 1 / (1 / variance + np.sum(ways**2 / own, axis=1))
        moved = spread * np.sum(ways * steps / own, axis=1)
        variance = np.mean(moved**2 + spread)
        along = ways * moved[:, None]
        own = np.mean((steps - along) ** 2 + ways**2 * spread[:, None], axis=0)
    return float(np.sqrt(variance)), np.sqrt(own)
