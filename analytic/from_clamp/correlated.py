"""Linear least squares of readings whose noise remembers: hum, drift and a sensor's zero.

What a fit leaves, station after station, is taken for white noise plus noise of the kind
a[i + 1] = rho a[i] + white (Gauss and Markov's), of any size and memory from none to a random walk,
each channel with its own. How likely each of a grid of these is, is restricted maximum likelihood
(Patterson and Thompson 1971); the estimate is their mean, so that what is not known of the noise
widens its interval. Hum is a sine and a cosine of the period at which the residuals have a line.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from analytic.problem.arrays import Floats

_MEMORY = np.array([0.5, 0.75, 0.87, 0.93, 0.965, 0.983, 0.992, 0.9965, 0.9995])
_SIZES = np.array([0.1, 0.3, 1, 3, 10, 30, 1e2, 1e3, 1e4, 1e5])  # variance over that of the white
_GRID = np.array([(0.0, 0.0), *((rho, size) for rho in _MEMORY for size in _SIZES)])
_WHITE = 5.0  # times as likely beforehand as all that remembers
_NOISELESS = 1e-3  # of what the readings are given over: readings without noise count as of so much
_DRAWS = 400  # of the noise, over which the estimate is averaged
_AT_ONCE = 2_000_000  # numbers in memory
_REMEMBERED = 0.3  # correlation from station to station that is said
_RANK = 1e-14  # of the largest eigenvalue: rounding
_LINE = 40.0  # times the median of the power beside it; white noise has one in 10^4 sweeps
_FINER = 4  # points of a periodogram for each of its own
_SLOWEST = 5.0  # periods in all stations; what is slower is drift
_WIDTH = 3.0  # of a line, in periods in all stations
_AROUND = 20.0  # the same: where the power beside a line is looked at


@dataclass(frozen=True)
class NoiseFound:
    """What the noise of some channels is like.

    Parameters
    ----------
    correlation : array, shape (channels,)
        Of the noise at one station with that at the next.
    memory : array, shape (channels,)
        Stations after which the correlated part has fallen to 1/e; 0 where there is none.
    hum : float
        Stations in a period of it; 0 where there is none.
    """

    correlation: Floats
    memory: Floats
    hum: float

    def said(self, names: Sequence[str]) -> Iterator[str]:
        """What a user should know of it, a line each."""
        for name, correlation, memory in zip(names, self.correlation, self.memory, strict=True):
            if memory and correlation > _REMEMBERED:
                yield f"the noise of {name} remembers: over some {memory:.0f} stations"
        if self.hum:
            yield f"hum, with a period of {self.hum:.3g} stations"


@dataclass(frozen=True)
class Estimated:
    """Numbers with the covariance of their errors, and what the noise is like."""

    numbers: Floats  # shape (k,)
    covariance: Floats  # shape (k, k)
    noise: NoiseFound


def estimate(
    readings: Floats,
    by_number: Floats,
    nuisances: Floats,
    uncertain: Floats,
    least: float = 0.0,
    seed: int = 0,
) -> Estimated:
    """The numbers that explain readings best, whatever their noise remembers.

    Parameters
    ----------
    readings : array, shape (n, channels)
        In order, over their noise as far as that is known.
    by_number : array, shape (n, channels, k)
        Their derivatives by the numbers sought.
    nuisances : array, shape (n, channels, z)
        The same by what else may be off, as a sensor's zero.
    uncertain : array, shape (z,)
        The standard uncertainty of that.
    least : float
        Intervals are no narrower than white noise of this standard deviation makes them.
    seed : int
        Of the draws.
    """
    known = by_number.shape[2]
    flat = by_number.reshape(readings.size, known)
    start = np.linalg.lstsq(flat, readings.ravel(), rcond=None)[0]
    readings = readings - by_number @ start
    hum = _hum(readings)
    if hum:
        line = _line(len(readings), readings.shape[1], hum)
        nuisances = np.concatenate([nuisances, line], axis=2)
        uncertain = np.append(uncertain, np.full(line.shape[2], np.inf))
    design = np.concatenate([by_number, nuisances], axis=2)
    sizes = np.sqrt(np.einsum("ncm,ncm->m", design, design))
    sizes[sizes == 0] = 1.0
    gram, root = _gram(np.concatenate([design / sizes, readings[:, :, None]], axis=2))
    prior = np.zeros(len(sizes))
    prior[known:] = 1 / (uncertain * sizes[known:]) ** 2
    freedom = len(readings) - int(np.sum(prior == 0))
    square, likely = _likely(gram + np.diag([*prior, 0]), root, freedom)
    precision, toward = np.diag(prior) + np.zeros((_DRAWS, 1, 1)), np.zeros((_DRAWS, len(sizes)))
    draw = np.random.default_rng(seed)
    for channel in range(readings.shape[1]):
        at = draw.choice(len(_GRID), size=_DRAWS, p=likely[:, channel])
        variance = square[at, channel] / draw.chisquare(freedom, size=_DRAWS)
        precision += gram[at, channel, :-1, :-1] / variance[:, None, None]
        toward += gram[at, channel, :-1, -1] / variance[:, None]
    covariances = np.linalg.pinv(precision, hermitian=True)
    numbers = np.einsum("dij,dj->di", covariances, toward)
    spread = covariances.mean(axis=0) + np.cov(numbers.T).reshape(2 * sizes.shape)
    if least:
        white = np.diag(prior) + gram[0, :, :-1, :-1].sum(axis=0) / least**2
        narrow = np.diag(np.linalg.pinv(white, hermitian=True)) / np.diag(spread)
        spread *= np.sqrt(np.outer(*2 * [np.maximum(1.0, narrow)]))
    return Estimated(
        start + (numbers.mean(axis=0) / sizes)[:known],
        (spread / np.outer(sizes, sizes))[:known, :known],
        _described(likely, hum),
    )


def _gram(columns: Floats) -> tuple[Floats, Floats]:
    """Products of the columns whitened by each noise of the grid, and its log determinants.

    Kalman's filter of the correlated part, shape (n, channels, m) to (grid, channels, m, m).
    """
    n, channels, m = columns.shape
    rho, size = _GRID.T
    variance, expected = size.copy(), np.zeros((len(rho), channels, m))
    products, logarithm = np.zeros((len(rho), channels, m, m)), np.zeros(len(rho))
    for some in np.array_split(columns, n * expected.size // _AT_ONCE + 1):
        white = np.empty((len(some), *expected.shape))
        for new, row in zip(white, some, strict=True):
            total = 1 + variance
            np.subtract(row, expected, out=new)
            expected += (variance / total)[:, None, None] * new
            expected *= rho[:, None, None]
            new /= np.sqrt(total)[:, None, None]
            logarithm += np.log(total)
            variance = rho**2 * variance / total + size * (1 - rho**2)
        rows = white.transpose(1, 2, 0, 3)
        products += rows.transpose(0, 1, 3, 2) @ rows
    return products, logarithm


def _likely(gram: Floats, root: Floats, freedom: int) -> tuple[Floats, Floats]:
    """Sums of squares and likelihoods, each shape (grid, channels)."""
    values, vectors = np.linalg.eigh(gram[..., :-1, :-1])
    values = np.maximum(values, _RANK * values[..., -1:].max(axis=0))
    along = np.einsum("gcij,gci->gcj", vectors, gram[..., :-1, -1])
    explained = (along**2 / values).sum(axis=-1)
    square = np.maximum(gram[..., -1, -1] - explained, freedom * _NOISELESS**2)
    logarithms = freedom * np.log(square) + root[:, None] + np.log(values).sum(axis=-1)
    prior = 1 / (1 - _GRID[1:, :1] ** 2)  # long memories, of which one sweep shows least
    logarithms[1:] -= 2 * np.log(prior / prior.sum() / _WHITE)
    likely = np.exp((logarithms.min(axis=0) - logarithms) / 2)
    return square, likely / likely.sum(axis=0)


def _hum(left: Floats) -> float:
    """Stations in the period of a line in what plain least squares leave; 0 if there is none."""
    n = len(left)
    left = left / np.maximum(left.std(), np.finfo(float).tiny)
    window = np.hanning(n)[:, None] * (left - left.mean(axis=0))
    power = (np.abs(np.fft.rfft(window, _FINER * n, axis=0)) ** 2).sum(axis=1)
    cycles = np.fft.rfftfreq(_FINER * n)
    fast = cycles > _SLOWEST / n
    if not fast.any():
        return 0.0
    top = np.flatnonzero(fast)[np.argmax(power[fast])]
    away = (cycles - cycles[top]) * n
    beside = [power[(way > _WIDTH) & (way < _AROUND)] for way in (away, -away)]
    # To either side: the power of noise that remembers falls with the frequency.
    if power[top] < _LINE * max(np.median(some) for some in beside if some.size):
        return 0.0
    return float(1 / cycles[top])


def _line(n: int, channels: int, period: float) -> Floats:
    """Sine and cosine of each channel, shape (n, channels, 2 channels)."""
    turn = 2 * np.pi * np.arange(n) / period
    waves = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    return np.asarray(np.einsum("nw,cd->ncdw", waves, np.eye(channels)).reshape(n, channels, -1))


def _described(likely: Floats, hum: float) -> NoiseFound:
    rho, size = _GRID.T
    correlation = np.array((rho * size / (1 + size)) @ likely)
    memory = np.array([-1 / np.log(r) if r else 0.0 for r in rho])
    remembered = np.array(memory @ likely)
    return NoiseFound(correlation, np.where(likely[0] > 0.5, 0.0, remembered), hum)
