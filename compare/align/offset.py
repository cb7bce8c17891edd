"""How far apart the origins of two sweeps' foot positions are."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.from_clamp.correlated import estimate
from analytic.from_clamp.noise import DOUBLE_SIDED_95, MEDIAN_OF_NORMAL, known_to
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.errors import require
from analytic.problem.support import recorded_contours
from compare.align.jumps import jumps
from compare.align.stations import interpolant
from compare.sense.noise import scales
from compare.sense.phases import Classification
from compare.sense.transitions import locate_transitions

_ALONG = ("foot_x", "contact_x", "second_contact_x")
_FEWEST = 8  # stations that a fit is worth something with
_FOLD = 2  # last stations before a snap-off: the readings' slope grows without bound there
_SCAN = 4  # trial offsets a station of the reference
_MOST = 4000  # trial offsets, and stations that they are tried on
_HUBER = 2.5  # standard deviations; stations that are farther off count by their sign only
_ROUND_OFF = 1e-13  # of the largest magnitude
_USELESS = 0.05  # L; a less certain offset blurs whole phases
_DISTINCT = 0.8  # a second minimum is worse than the best if its residual times this still is
_PLAIN, _ITERATIONS = 10, 30  # at most, of least squares and of Huber's estimator
_ONE = 1e-6  # stations; offsets that least squares finds closer together are one


class NoOffsetError(Exception):
    """The readings determine none, and why."""


@dataclass(frozen=True)
class Offset:
    """By how much the candidate's ``foot_x`` exceeds the reference's for one foot position.

    Attributes
    ----------
    value : float
        The offset [length].
    uncertainty : float
        The true one lies within `value` +- `uncertainty` in 95 % of all cases [length]; 0 where
        the offset was given. From the residual of the fit and its correlation between stations, so
        that a model's smooth deviation widens it, and from what a rig's zeros are known to; what
        of that deviation looks exactly like an offset cannot be distinguished from one.
    unknown : str
        Why none was found, and `value` is 0; empty otherwise.
    """

    value: float
    uncertainty: float = 0.0
    unknown: str = ""


def separate_lag(left: Offset, right: Offset) -> tuple[Offset, Offset]:
    """Offset of the stage and lag of the readings, from a sweep in each direction.

    Readings that lag behind a stage of constant speed seem displaced along the motion: to the left
    in a sweep to the left. One sweep cannot distinguish that from an offset, two can.

    Parameters
    ----------
    left, right : Offset
        Of a sweep to the left and of one to the right, at the same speed.

    Returns
    -------
    offset, lag : Offset
        Half the sum, and half the difference: the lag as the distance that the stage travels
        meanwhile [length]; divide by its speed for a time.
    """
    for name, one in (("left", left), ("right", right)):
        require(name, one, Offset, "as compare(reference, sweep, offset='auto').offset")
    uncertainty = float(np.hypot(left.uncertainty, right.uncertainty)) / 2
    return (
        Offset((left.value + right.value) / 2, uncertainty),
        Offset((right.value - left.value) / 2, uncertainty),
    )


def without_offset(readings: Readings, offset: float) -> Readings:
    """The readings with `offset` subtracted from every position along x, events and contour too."""
    table = readings.table
    moved = {name: table[name] - offset for name in _ALONG if name in table}
    provenance: dict[str, Any] = dict(readings.provenance)
    if "events" in provenance:
        events = provenance["events"]
        provenance["events"] = {n: None if x is None else x - offset for n, x in events.items()}
    lines = [[(xi - offset).tolist(), eta.tolist()] for xi, eta in readings.contours]
    provenance |= recorded_contours(lines)
    return replace(readings, table=table.assign(**moved), provenance=provenance)


def checked_offset(offset: float) -> float:
    if isinstance(offset, bool | str) or not np.isfinite(offset):
        raise InputError("offset", repr(offset), "'auto' or a finite number", "give a length")
    return float(offset)


def estimate_offset(
    reference: Readings,
    candidate: Readings,
    reference_phase: Classification,
    candidate_phase: Classification,
) -> Offset:
    """The offset that lays the candidate's clamp readings over the reference's.

    All offsets that leave half of the contact in common are tried, the snap-off included. From the
    best one on, the sum of squares of the three readings' differences, each in units of its own
    scatter, is minimised (Huber's estimator) over the trusted stations that lie within one phase of
    the reference, the last two before its snap-off left out; then with a rig's zeros, and noise
    that remembers (`estimate`). The interval is that one's or, if wider, as of a model that
    differs, Kiefer and Vogelsang's with Newey and West's variance and Andrews' lag window.
    """
    length = reference.beam.length
    best, *others = offset_fits(reference, candidate, reference_phase, candidate_phase)
    for other in others:
        apart = abs(other.value - best.value) > _USELESS * length
        if apart and other.misfit * _DISTINCT < best.misfit:
            raise NoOffsetError(f"{best.value:.4g} and {other.value:.4g} fit alike")
    if not best.uncertainty < _USELESS * length:
        raise NoOffsetError(f"{best.value:.4g} +- {best.uncertainty:.2g}, a flat minimum")
    return Offset(best.value, best.uncertainty)


class OffsetFit(NamedTuple):
    """An offset that fits, at least better than those around it."""

    value: float
    uncertainty: float
    misfit: float
    """Root mean square of the robust residual, relative to the readings' largest magnitudes."""


def offset_fits(
    reference: Readings,
    candidate: Readings,
    reference_phase: Classification,
    candidate_phase: Classification,
) -> list[OffsetFit]:
    """Offsets at which the candidate's clamp readings fit the reference's, the best first."""
    curve = _Curve.of(reference, reference_phase)
    loaded = np.isin(candidate_phase.phase, ("tip", "tangent"))
    for name, number in (("reference", curve.stations), ("candidate", int(loaded.sum()))):
        if number < _FEWEST:
            raise NoOffsetError(f"{number} trusted stations of the {name} in contact")
    sizes = np.array([*scales(reference).values()])
    seen = np.stack([candidate.values(n) for n in CLAMP_READINGS]) / sizes[:, None]
    x, zeros = candidate.running_values, _zeros(reference, candidate) / sizes[:, None]
    starts = _scan(curve, x, seen, loaded, candidate.trusted)
    x, seen, zeros = x[loaded], seen[:, loaded], zeros[..., loaded]
    plain = [_fit(curve, x, seen, start, robust=False) for start in starts]
    # Again from where each leads: on a long way it leaves stations behind.
    first = [_fit(curve, x, seen, start, robust=True) for start in _apart(curve, plain)]
    fits = [
        fit
        for start in _apart(curve, first)
        if (fit := _fit(curve, x, seen, start, robust=True, zeros=zeros)) is not None
    ]
    if not fits:
        raise NoOffsetError(f"fewer than {_FEWEST} stations in a phase of the reference")
    return sorted(fits, key=lambda fit: fit.misfit)


@dataclass(frozen=True)
class _Curve:
    """The reference's clamp readings over the foot position, smooth pieces and the whole."""

    pieces: list[tuple[float, float, Callable[..., Any]]]
    x: Floats
    values: Floats
    """Over the largest magnitudes, shape (3, stations), by ascending `x`; zero where free."""
    stations: int
    spacing: float
    ends: tuple[float, float]
    """Of the contact."""

    @classmethod
    def of(cls, reference: Readings, judged: Classification) -> "_Curve":
        x = reference.running_values
        values = np.stack([reference.values(n) / size for n, size in scales(reference).items()])
        touching = np.isin(judged.phase, ("tip", "tangent"))
        places = locate_transitions(reference, judged)
        limits = [places[name][0] for name in ("phase_b_start", "phase_b_end")]
        after = jumps(x, values, np.zeros(1, dtype=int))
        cuts = [*(x[after] + x[after + 1]) / 2, *(limit for limit in limits if limit is not None)]
        piece = np.searchsorted(np.sort(cuts), x)
        last = np.flatnonzero(touching)[-1] if touching.any() else 0
        lets_go = last + 1 < len(x)
        pieces = []
        for one in np.unique(piece[touching]):
            here = np.flatnonzero(touching & (piece == one))
            kept = here[:-_FOLD] if lets_go and last in here else here
            if len(here) < 4 or len(kept) < 2:
                continue
            order = here[np.argsort(x[here])]
            spline = interpolant(x[order], values[:, order])
            pieces.append((float(x[kept].min()), float(x[kept].max()), spline))
        order = np.argsort(x)
        ends = (x[touching].min(), x[touching].max()) if touching.any() else (0.0, 0.0)
        return cls(
            pieces,
            x[order],
            np.where(touching, values, 0.0)[:, order],
            int(touching.sum()),
            float(np.median(np.abs(np.diff(x)))) or float(np.ptp(x)) / len(x),
            (float(ends[0]), float(ends[1])),
        )

    def smooth(self, x: Floats) -> tuple[Floats, Floats]:
        """Readings, and their derivatives, shape (3, len(x)); NaN where `x` is within no piece."""
        found = np.full((2, len(CLAMP_READINGS), len(x)), np.nan)
        for low, high, spline in self.pieces:
            here = (x >= low) & (x <= high)
            found[:, :, here] = spline(x[here]), spline(x[here], 1)
        return found[0], found[1]


def _scan(
    curve: _Curve, x: Floats, seen: Floats, loaded: Booleans, trusted: Booleans
) -> list[float]:
    """The offsets at the lowest minima of a coarse scan, the lowest first."""
    low, high = x[loaded].min(), x[loaded].max()
    first, last = curve.ends
    half = min(high - low, last - first) / 2
    range_ = high - low + last - first - 2 * half
    count = int(min(_SCAN * range_ / curve.spacing, _MOST)) + 2 if range_ > 0 else 2
    trials = np.linspace(low - last + half, high - first - half, count)
    stride = -(-int(trusted.sum()) // _MOST)
    tried = np.flatnonzero(trusted)[::stride]
    felt = np.where(loaded, seen, 0.0)[:, tried]
    least = min(loaded.sum(), curve.stations) / 2

    def missed(trial: float) -> float:
        """Mean square at an offset; infinite where too little is in common."""
        there = x[tried] - trial
        known = (there >= curve.x[0]) & (there <= curve.x[-1])
        common = known & (there >= first) & (there <= last) & loaded[tried]
        if common.sum() * stride < least:
            return np.inf
        due = [np.interp(there[known], curve.x, row) for row in curve.values]
        return float(np.mean((felt[:, known] - np.array(due)) ** 2))

    misfit = np.array([missed(trial) for trial in trials.tolist()])
    padded = np.concatenate([[np.inf], misfit, [np.inf]])
    minima = np.flatnonzero(np.isfinite(misfit) & (misfit <= padded[:-2]) & (misfit <= padded[2:]))
    return [float(trials[i]) for i in minima[np.argsort(misfit[minima])][:3]]


def _zeros(reference: Readings, candidate: Readings) -> Floats:
    """What the zeros may be off, of both: all along, along a line, and bent, (3, 3, stations)."""
    x = candidate.running_values
    along = 2 * (x - x.min()) / np.ptp(x) - 1
    known = [
        np.hypot(*(known_to(name, sweep) for sweep in (reference, candidate)))
        for name in ("zero_uncertainty", "zero_uncertainty", "bend_uncertainty")
    ]
    shapes = np.array([along**0, along, 1 - along**2])
    return np.asarray(np.array(known)[..., None] * shapes[:, None])


def _apart(curve: _Curve, fits: list[OffsetFit | None]) -> list[float]:
    """Where fits lead, each place once."""
    near: list[float] = []
    for fit in fits:
        if fit is not None and not np.isclose(near, fit.value, 0, _ONE * curve.spacing).any():
            near.append(fit.value)
    return near


def _fit(
    curve: _Curve,
    x: Floats,
    seen: Floats,
    start: float,
    *,
    robust: bool,
    zeros: Floats | None = None,
) -> OffsetFit | None:
    """Gauss and Newton's method from `start`; None where it leads out of the reference.

    Plain least squares first, each reading over its largest magnitude: the scatter that the
    readings are then weighed by is known only near the best offset.
    """
    value, inside = start, np.ones(len(x), dtype=bool)
    iterations = _ITERATIONS if robust else _PLAIN
    for iteration in range(iterations):
        due, slope = curve.smooth(x - value)
        # Towards the end the same stations, so that none comes and goes.
        settled = robust and iteration >= iterations // 2
        inside = np.isfinite(due[0]) & (inside if settled else True)
        if inside.sum() < _FEWEST:
            return None
        due, slope = due[:, inside], slope[:, inside]
        miss = seen[:, inside] - due
        scatter = np.median(np.abs(miss), axis=1, keepdims=True) / MEDIAN_OF_NORMAL + _ROUND_OFF
        scatter = scatter if robust else np.ones_like(scatter)
        clipped = np.clip(miss / scatter, -_HUBER, _HUBER)
        linear = np.abs(miss / scatter) < _HUBER
        information = float(np.sum(linear * (slope / scatter) ** 2))
        score = np.sum(-slope / scatter * clipped, axis=0)
        if information == 0:
            return None
        step = float(np.clip(score.sum() / information, -curve.spacing, curve.spacing))
        value += step
        if abs(step) < 1e-12 * (abs(value) + curve.spacing):
            break
    misfit = float(np.sqrt(np.mean((clipped * scatter) ** 2)))
    width = _half_width(score, information)
    if zeros is None:
        return OffsetFit(value, width, misfit)
    each = np.einsum("krn,rc->nckr", zeros[..., inside] / scatter, np.eye(len(scatter)))
    off = each.reshape(*clipped.T.shape, -1)
    off = off[..., off.any(axis=(0, 1))]
    found = estimate(clipped.T, (-slope / scatter).T[..., None], off, np.ones(off.shape[-1]))
    width = max(width, DOUBLE_SIDED_95 * float(np.sqrt(found.covariance[0, 0])))
    return OffsetFit(value + float(found.numbers[0]), width, misfit)


def _half_width(score: Floats, information: float) -> float:
    """Half a 95 % interval of an estimate with those scores (their sum is zero)."""
    n = len(score)
    centred = score - score.mean()
    if not centred.any():
        return 0.0
    rho = float(np.clip(centred[1:] @ centred[:-1] / (centred @ centred), -0.97, 0.97))
    # Andrews 1991, eq. 6.4, for Bartlett's window and a first-order autoregression.
    alpha = 4 * rho**2 / ((1 - rho) * (1 + rho)) ** 2
    window = min(1.1447 * (alpha * n) ** (1 / 3), n - 1.0)
    lags = np.arange(1, int(window) + 1)
    autocovariance = np.array([centred[k:] @ centred[:-k] for k in lags])
    variance = centred @ centred + 2 * np.sum((1 - lags / (window + 1)) * autocovariance)
    variance = max(float(variance), float(centred @ centred))
    b = window / n
    # Kiefer and Vogelsang 2005, table 1: 97.5 % point for Bartlett's window of width b n.
    critical = 1.9600 + 2.9694 * b + 0.4160 * b**2 - 0.5324 * b**3
    return float(critical * np.sqrt(variance) / information)
