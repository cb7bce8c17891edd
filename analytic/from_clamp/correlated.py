"""Linear least squares of readings whose noise remembers: hum, drift and a sensor's zero.

What a fit leaves, station after station, is taken for white noise plus noise of the kind
a[i + 1] = rho a[i] + white (Gauss and Markov's), of any size and memory from none to a random walk,
each channel with its own. How likely each of a grid of these is, is restricted maximum likelihood
(Patterson and Thompson 1971); the estimate is their mean, so that what is not known of the noise
widens its interval. Hum is a sine and a cosine of the period at which the residuals have a line.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.special import gammaln, log_softmax, logsumexp, softmax

from analytic.numerics.arrays import Booleans, Floats, Integers

_MEMORY = np.array([0.5, 0.75, 0.87, 0.93, 0.965, 0.983, 0.992, 0.9965, 0.9995])
_SIZES = np.array([0.1, 0.3, 1, 3, 10, 30, 1e2, 1e3, 1e4, 1e5])  # variance over that of the white
_GRID = np.array([(0.0, 0.0), *((rho, size) for rho in _MEMORY for size in _SIZES)])
_WHITE = 5.0  # times as likely beforehand as all that remembers
_LONG = 1 / (1 - _GRID[1:, :1] ** 2)  # long memories count more: one sweep shows least of them
_PRIOR = _LONG / _LONG.sum() / _WHITE
# Where noise is stated, what remembers cannot hide, and any memory is as likely: of AR(0.9) few
# stations would be taken for white, or for a long memory whose size is nearly all a zero's.
_STATED = -np.log(_PRIOR.size * _PRIOR * _WHITE)
_LOG_PRIOR = np.log(np.concatenate([[[1.0]], _PRIOR]))
_NOISELESS = 1e-3  # of what the readings are given over: readings without noise count as of so much
_STATED_TO = 0.2  # relative, of a stated noise's variance: the noise is known to a tenth
# Of that: no less than stated, of which few stations show less.
_MORE = np.linspace(0.0, 3.0, 7)[:, None, None]
# Of sizes, so many are stated too large, for each e-fold of the variance: rare, yet without these
# white noise of a fifth of it was a long memory's.
_LESS = 0.003
_DRAWS = 400  # of the noise, over which the estimate is averaged
_ENOUGH = 4000  # stations; of more, neighbours count as one
_FEW = 2  # a spread takes two
_AT_ONCE = 500_000  # numbers in memory, 4 MB
# Probability of a memory longer than a pass; of white noise and AR(0.9) 2 of 360 have it.
_SURELY = 0.95
# Memories; of three channels so many show the noise's size to 0.2, and 1.5 times that is clear.
_SHOWING = 10.0
_REMEMBERED = 0.3  # correlation from station to station that is said
_RANK = 1e-14  # of the largest square: rounding
_LINE = 40.0  # times the median of the power beside it; white noise has one in 10^4 sweeps
_FINER = 4  # points of a periodogram for each of its own
_SLOWEST = 5.0  # periods in all stations; what is slower is drift
# Stations; in fewer a line looks like noise, and takes two of each channel. Of AR(0.7) and AR(0.9)
# that are not stated, intervals of 95 % hold 78 % in 25, 88 % in 32, 91 % in 40, and 96 % in 60.
_FEWEST = 40
_WIDTH = 3.0  # of a line, in periods in all stations
_AROUND = 20.0  # the same: where the power beside a line is looked at


@dataclass(frozen=True)
class NoiseFound:
    """What the noise of some channels is like."""

    correlation: Floats  # shape (channels,); of the noise at one station with that at the next
    # Shape (channels,); stations after which the correlated part has fallen to 1/e; 0 if none. Of
    # AR(0.9), 9.5, it is 6 to 41 in 80 of 100 sweeps of 94 stations: it is said as "some".
    memory: Floats
    hum: float  # stations in a period of it; 0 where there is none
    lasts: Booleans  # shape (channels,); remembers longer than a pass, as what is no noise does
    shows: bool = True  # whether it would show that it remembers, or is stated

    @property
    def remembers(self) -> Booleans:
        """Of which channels it does, so far that it is said."""
        return self.correlation > _REMEMBERED

    def judged_by(self, rests: int | None) -> bool:
        """Whether so many stations off the contact show its size; None if it is known without."""
        forgotten = np.where(self.remembers & ~self.lasts, self.memory, 0.0)
        return rests is None or bool(rests >= _SHOWING * forgotten.max())

    def said(self, names: Sequence[str]) -> Iterator[str]:
        known = np.where(self.lasts | ~self.remembers, 0.0, self.memory)
        if not self.shows:
            yield (
                f"fewer than {_FEWEST} stations do not show whether noise remembers, and the "
                "intervals take it that it does not: state the noise, or take more stations"
            )
        for name, memory in zip(names, known, strict=True):
            if memory:
                said = f"the noise of {name} remembers: over some {memory:.0f} stations"
                yield f"{said}; the intervals know it"
        if any(self.lasts):
            of = " and ".join(np.array(names)[self.lasts])
            yield (
                f"what is left of {of} remembers longer than a pass: noise may, and so does what "
                "is not as stated, of which the intervals know nothing"
            )
        if self.hum:
            yield f"hum, with a period of {self.hum:.3g} stations; the intervals know it"


@dataclass(frozen=True)
class Estimated:
    """Numbers with the covariance of their errors, and what the noise is like."""

    numbers: Floats  # shape (k,)
    covariance: Floats  # shape (k, k)
    noise: NoiseFound
    by_pass: tuple[tuple[Floats, Floats], ...]  # numbers and covariance of each pass alone
    # Shape (noises, channels); logarithm of the readings' probability, but for a constant, were the
    # noise so.
    by_noise: Floats
    stations: int  # of which that is, neighbours counting as one where there are many
    relief: float  # by which all that is fitted lessens the sum of squares, were the noise white
    of_hum: float  # by which hum does, which is not among that
    # Probability that passes leave so much alike at the same places by chance; None of too few.
    alike: float | None = None


def estimate(
    readings: Floats,
    by_number: Floats,
    nuisances: Floats,
    uncertain: Floats,
    least: float = 0.0,
    seed: int = 0,
    rows: Sequence[int] | None = None,
    shared: Sequence[int] = (),
    since: Floats | None = None,
) -> Estimated:
    """The numbers that explain readings best, whatever their noise remembers.

    `readings`, shape (n, channels), are in order, one pass after the other, over their noise as far
    as that is known; `by_number` (n, channels, k) are their derivatives by the numbers sought,
    `nuisances` (n, channels, z) those by what else may be off in each pass on its own, as a
    sensor's zero, and `uncertain` (z,) is the standard uncertainty of that. Intervals are no
    narrower than white noise of the standard deviation `least` makes them. `rows` says how many
    stations each pass has, by default all are of one: noise of one pass does not remember that of
    another, but is of one kind in all. Of the numbers that are `shared` a pass alone says nothing:
    its others are those beside what all passes say of these. `since` (n,) is how many stations each
    is behind the one before it, by default one.
    """
    known = by_number.shape[2]
    rows = [len(readings)] if rows is None else rows
    flat = by_number.reshape(readings.size, known)
    start = np.linalg.lstsq(flat, readings.ravel(), rcond=None)[0]
    given = float(np.sum(readings**2))
    readings = readings - by_number @ start
    each = np.split(readings, np.cumsum(rows)[:-1])
    hum, of_hum = _hum(max(each, key=len)), 0.0
    parts = [by_number, nuisances, readings[:, :, None]]
    if hum:
        waves = [_waves(len(one), hum) for one in each]
        pairs = zip(waves, each, strict=True)
        of_hum = sum(np.sum((np.linalg.qr(x)[0].T @ one) ** 2) for x, one in pairs)
        line = np.concatenate([_line(x, readings.shape[1]) for x in waves])
        parts.insert(2, line)
        uncertain = np.append(uncertain, np.full(line.shape[2], np.inf))
    block = len(readings) // _ENOUGH + 1  # stations of which one is made
    columns = np.concatenate([_in_blocks(one, rows, block) for one in parts], axis=2)
    since = np.ones(len(readings)) if since is None else since
    since = _in_blocks(since[:, None, None], rows, block).ravel() / np.sqrt(block)
    rows = [_blocks(n, block) for n in rows]
    sizes = np.sqrt(np.einsum("ncm,ncm->m", *2 * [columns[:, :, :-1]]))
    sizes[sizes == 0] = 1.0
    columns[:, :, :-1] /= sizes
    gram, root = _gram(columns, rows, since)
    prior = np.zeros(len(sizes) + 1)
    prior[known:-1] = 1 / (uncertain * sizes[known:]) ** 2
    # The noise is what each pass's own numbers leave: passes that differ are no noise.
    left, logarithm = _without_nuisances(gram, prior, 0)
    free = np.einsum("pcmm->pcm", gram[:, 0])[..., :-1][..., prior[:-1] == 0] > _RANK
    freedom = len(columns) - free.sum(axis=(0, 2))
    determinants = root[:, None] + logarithm.sum(axis=0)
    square, weights = _likely(left.sum(axis=0)[..., 0, 0], determinants, freedom)
    draw = np.random.default_rng(seed)
    draws = _DRAWS if known else _FEW  # where only the noise is sought
    sized = np.empty((0, readings.shape[1]))  # variances that what is stated gives
    if least:
        sized, weights = _as_stated(square, weights, freedom, least)
    likely = softmax(weights, axis=0)
    drawn = []
    for channel in range(readings.shape[1]):
        at = draw.choice(len(likely), size=draws, p=likely[:, channel])
        at, beyond = at % len(_GRID), at - len(_GRID)
        size = square[at, channel] / draw.chisquare(freedom[channel], size=draws)
        # No less than stated is drawn even where it is taken for too large.
        size = np.maximum(size, least**2 / (1 + _GRID[at, 1]))
        size[beyond >= 0] = sized[beyond[beyond >= 0], channel]
        drawn.append((at, channel, size[:, None, None]))
    likely = likely.reshape(-1, len(_GRID), readings.shape[1]).sum(axis=0)
    systems = (sum(one[at, channel] / size for at, channel, size in drawn) for one in gram)
    one_by_one = _without_nuisances(systems, prior, known)[0]
    white = gram[:, :1].sum(axis=2)
    narrowest = _without_nuisances(white / (least or _NOISELESS) ** 2, prior, known)[0][:, 0]
    together = _posterior(one_by_one.sum(axis=0), narrowest.sum(axis=0))
    by_pass = [_alone(*one, together[0], shared) for one in zip(one_by_one, narrowest, strict=True)]
    common, logarithm = _without_nuisances(gram, prior, known)
    unexplained = np.append(-together[0], 1.0)
    left = unexplained @ common.sum(axis=0) @ unexplained
    determinants = root[:, None] + logarithm.sum(axis=0)
    _, weights = _likely(left, determinants, len(columns))
    size = sizes[:known]
    kept = np.array([*range(known + nuisances.shape[2]), -1])
    steady = white[..., kept[:, None], kept]
    unfitted = float(white[..., -1, -1].sum() - _without_nuisances(steady, prior[kept], 0)[0].sum())

    def scaled(found: tuple[Floats, Floats]) -> tuple[Floats, Floats]:
        return start + found[0] / size, found[1] / np.outer(size, size)

    return Estimated(
        *scaled(together),
        _described(likely, hum, block, block * max(rows), least > 0 or len(columns) >= _FEWEST),
        tuple(scaled(one) for one in by_pass),
        weights - _LOG_PRIOR,
        len(columns),
        given - float(np.sum(readings**2)) + unfitted,
        float(of_hum),
    )


def _blocks(stations: int, block: int) -> int:
    return -(-stations // block)


def _in_blocks(columns: Floats, rows: Sequence[int], block: int) -> Floats:
    """Means of neighbours times the root of their number, which keeps white noise as it is."""
    each = zip(np.cumsum(rows) - rows, rows, strict=True)
    parts = [begin + np.arange(_blocks(n, block)) * n // _blocks(n, block) for begin, n in each]
    first = np.concatenate(parts)
    number = np.diff(first, append=len(columns))
    # By one root for all: noise that remembers is not to jump where a block is one shorter.
    means = np.add.reduceat(columns, first, axis=0) / number[:, None, None]
    return np.asarray(means * np.sqrt(block))


def _gram(columns: Floats, rows: Sequence[int], since: Floats) -> tuple[Floats, Floats]:
    """Products of the columns whitened by each noise of the grid, and its log determinants.

    Kalman's filter of the correlated part, shape (n, channels, m) to (passes, grid, channels, m,
    m). All passes go at once, the longest first, so that those at work are always the first ones.
    """
    _, channels, m = columns.shape
    order = np.argsort(rows, kind="stable")[::-1]
    begins = (np.cumsum(rows) - rows)[order]
    lengths = np.asarray(rows)[order]
    rho, size = _GRID.T
    variance, expected = np.tile(size, (len(rows), 1)), np.zeros((len(rows), len(rho), channels, m))
    products, logarithm = np.zeros((*expected.shape, m)), np.zeros(len(rho))
    steps = np.arange(lengths[0])
    for some in np.array_split(steps, lengths[0] * expected.size // _AT_ONCE + 1):
        white = np.zeros((len(some), *expected.shape))
        for new, step in zip(white, some.tolist(), strict=True):
            working = int(np.sum(lengths > step))
            new, now, here = new[:working], expected[:working], begins[:working] + step
            left = rho ** since[here, None]
            now *= left[:, :, None, None]
            variance = left**2 * variance[:working] + size * (1 - left**2)
            total = 1 + variance
            np.subtract(columns[here, None], now, out=new)
            now += (variance / total)[:, :, None, None] * new
            new /= np.sqrt(total)[:, :, None, None]
            logarithm += np.log(total).sum(axis=0)
            variance /= total
        stations = white.transpose(1, 2, 3, 0, 4)
        products += stations.swapaxes(-1, -2) @ stations
    found = np.empty_like(products)
    found[order] = products
    return found, logarithm


def _without_nuisances(grams: Iterable[Floats], prior: Floats, known: int) -> tuple[Floats, Floats]:
    """Normal equations (passes, some, ..., m, m) without the columns from `known` to the last.

    And the logarithm of the determinant of what is left out. All passes at once would take 100 MB.
    """
    kept = np.array([*range(known), len(prior) - 1])
    found, logarithms = [], []
    for gram in grams:
        normal = gram + np.diag(prior)
        inner, beside = normal[..., known:-1, known:-1], normal[..., known:-1, kept]
        squares = np.einsum("...ii->...i", inner)
        rounding = _RANK * squares.max(axis=-1, initial=0.0, keepdims=True)
        # What a reading does not depend on, says nothing of its noise.
        apart = np.where(squares <= rounding, 1.0, rounding)
        inner = inner + apart[..., None] * np.eye(inner.shape[-1])
        left = beside.swapaxes(-1, -2) @ np.linalg.solve(inner, beside)
        found.append(normal[..., kept[:, None], kept] - left)
        logarithms.append(np.linalg.slogdet(inner).logabsdet)
    return np.stack(found), np.stack(logarithms)


def _posterior(systems: Floats, white: Floats) -> tuple[Floats, Floats]:
    """Mean and covariance of the numbers, of the normal equations of all draws of the noise.

    Intervals are no narrower than the white noise makes them whose normal equations are given too.
    """
    covariances = np.linalg.pinv(systems[:, :-1, :-1], hermitian=True)
    numbers = np.einsum("dij,dj->di", covariances, systems[:, :-1, -1])
    spread = covariances.mean(axis=0)
    spread += np.cov(numbers.T).reshape(spread.shape)
    narrow = np.diag(np.linalg.pinv(white[:-1, :-1], hermitian=True)) / np.diag(spread)
    spread *= np.sqrt(np.outer(*2 * [np.maximum(1.0, narrow)]))
    return numbers.mean(axis=0), spread


def _alone(
    systems: Floats, white: Floats, together: Floats, shared: Sequence[int]
) -> tuple[Floats, Floats]:
    """What one pass says, the shared numbers being as all passes say: without a variance."""
    own = np.delete(np.arange(systems.shape[-1]), list(shared))
    numbers, covariance = together.copy(), np.zeros((len(together), len(together)))
    moved = systems.copy()
    moved[..., -1] -= systems[..., list(shared)] @ together[list(shared)]
    kept = (one[..., own, :][..., own] for one in (moved, white))
    numbers[own[:-1]], covariance[np.ix_(own[:-1], own[:-1])] = _posterior(*kept)
    return numbers, covariance


def _likely(left: Floats, determinants: Floats, freedom: Integers | int) -> tuple[Floats, Floats]:
    """Sums of squares, and logarithms of each noise's likelihood, each shape (grid, channels)."""
    square = np.maximum(left, freedom * _NOISELESS**2)
    return square, _LOG_PRIOR - (freedom * np.log(square) + determinants) / 2


def _as_stated(
    square: Floats, weights: Floats, freedom: Integers, least: float
) -> tuple[Floats, Floats]:
    """Of noises whose size in all is stated, or shown to be more: the white part's variance.

    Shape (sizes * grid, channels). And how likely each is, behind those of the size that is left:
    shape (grid + sizes * grid, channels).
    """
    stated = np.maximum(least**2, square[0] / freedom)
    variance = stated * np.exp(_STATED_TO * _MORE) / (1 + _GRID[:, 1:])
    over = square / variance
    likely = weights + (freedom * np.log(over) - over - _MORE**2) / 2
    likely -= logsumexp(-(_MORE**2) / 2)
    total = np.maximum(square * (1 + _GRID[:, 1:]) / (freedom * stated), 1.0)
    smaller = weights - (np.log(total) / _STATED_TO) ** 2 / 2
    smaller += gammaln(freedom / 2) + freedom / 2 * np.log(2) + np.log(_LESS)
    every = np.concatenate([smaller[None], likely])
    every[:, 1:] += _STATED
    channels = square.shape[1]
    return variance.reshape(-1, channels), every.reshape(-1, channels)


def likelihood(by_noise: Floats, seen: Floats | None = None) -> float:
    """Logarithm of readings' probability over what their noise may be, but for a constant.

    By what another fit has `seen` of that noise, its own `by_noise`, if that is given.
    """
    prior = _LOG_PRIOR if seen is None else log_softmax(seen + _LOG_PRIOR, axis=0)
    return float(logsumexp(by_noise + prior, axis=0).sum())


def _hum(left: Floats) -> float:
    """Stations in the period of a line in what plain least squares leave; 0 if there is none."""
    n = len(left)
    if n < _FEWEST:
        return 0.0
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
    # Of a parabola through its neighbours: half a point off, a line's ends are an eighth of a turn.
    near = power[[top - 1, top, min(top + 1, len(power) - 1)]]
    behind, here, ahead = np.log(np.maximum(near, np.finfo(float).tiny))
    bend = behind - 2 * here + ahead
    off = (behind - ahead) / (2 * bend) if bend < 0 else 0.0
    return float(1 / (cycles[top] + off * cycles[1]))


def _waves(n: int, period: float) -> Floats:
    """Cosine and sine, shape (n, 2)."""
    turn = 2 * np.pi * np.arange(n) / period
    return np.stack([np.cos(turn), np.sin(turn)], axis=1)


def _line(waves: Floats, channels: int) -> Floats:
    """Those of each channel, shape (n, channels, 2 channels)."""
    every = np.einsum("nw,cd->ncdw", waves, np.eye(channels))
    return np.asarray(every.reshape(len(waves), channels, -1))


def _described(likely: Floats, hum: float, block: int, stations: int, shows: bool) -> NoiseFound:
    rho, size = _GRID.T
    rho, size = rho ** (1 / block), size / block  # of sums of what remembers longer than they are
    correlation = np.array((rho * size / (1 + size)) @ likely)
    memory = np.array([-1 / np.log(r) if r else 0.0 for r in rho])
    shown = likely[1:] / _PRIOR.reshape(-1, 1)  # any memory being as likely beforehand
    remembered = np.exp(np.log(memory[1:]) @ (shown / shown.sum(axis=0)))
    long = memory >= min(stations, memory.max())  # the longest stands for all that are longer
    lasts = likely[long].sum(axis=0) > _SURELY
    return NoiseFound(correlation, np.where(likely[0] > 0.5, 0.0, remembered), hum, lasts, shows)
