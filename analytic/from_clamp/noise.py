"""Noise of the clamp readings: given, or estimated from the sweep itself."""

from collections.abc import Mapping, Sequence

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.columns import CLAMP_READINGS, SENSED
from analytic.problem.errors import InputError
from analytic.problem.numbers import is_finite_number, within
from analytic.problem.readings import Readings, require_readings

_DIFFERENCE = np.array([1.0, -4.0, 6.0, -4.0, 1.0])  # kills cubics: what is left is noise
_ZERO = 1e-3  # of a reading's largest magnitude: what its zero is known to, if nothing says
_SURELY = 1e-6  # of it: no zero is known better
SIGMAS = 5.0  # standard deviations; a force of less is none, a miss of more is no noise
IDLE = 10  # stations that show how large noise is where nothing touches
# Over the root of their number: three standard deviations of what such a median says of white noise
_CLEARLY = 3.5
_WHOLE = 1e-3  # of a step; steps so near to whole multiples of the smallest are a converter's
_ROUND_OFF = 1e-14  # of the largest magnitude: no reading is better than that

DOUBLE_SIDED_95 = 1.959964  # standard deviations, of a normal distribution
SAMPLES = 400  # of the noise, a station
AT_ONCE = 500  # stations whose samples are in memory: 1.6 MB for each number of them
_COVERAGE = 0.95
MEDIAN_OF_NORMAL = 0.6745
"""Median of |x| for a standard normal x: turns a median deviation into a standard deviation."""


def reading_noise(readings: Readings) -> dict[str, float]:
    """Standard deviation of each clamp reading's noise, in the reading's unit.

    The median of the absolute fourth differences between neighbouring trusted stations: robust
    against the few stations where a phase begins or ends, and blind to anything smooth, so a
    model's bias is not taken for noise.
    """
    values = {name: readings.values(name) for name in CLAMP_READINGS}
    loaded = readings.trusted & (np.hypot(values["force_x"], values["force_y"]) > 0)
    return {name: scatter(column[loaded]) for name, column in values.items()}


def resting_noise(values: Floats, seen: Floats) -> Floats:
    """What readings scatter by off the contact, if that is clearly more than is `seen` in jumps.

    Noise that remembers jumps little. `values`, shape (3, stations), forces first, are of trusted
    stations. Those off the stretch of most load count whose force noise explains, of `seen` first,
    then of what these scatter by; and of those what has the sign that the load beside has not.
    """
    force = np.hypot(*values[:2])
    loaded = force > SIGMAS * np.hypot(*seen[:2])
    which = np.cumsum(np.diff(loaded, prepend=False))
    load = np.bincount(which, weights=np.where(loaded, force, 0.0), minlength=1)
    if not load.any():
        return seen
    contact = np.flatnonzero(which == np.argmax(load))
    sides = slice(0, contact[0]), slice(contact[-1] + 1, None)
    off = [
        np.where(values[:, side] * values[:, near].sum(axis=1)[:, None] < 0, values[:, side], 0.0)
        for side, near in zip(sides, (contact[:IDLE], contact[-IDLE:]), strict=True)
    ]
    against = np.abs(np.concatenate(off, axis=1))
    other = np.concatenate([force[side] for side in sides])
    while True:
        idle = against[:, other <= SIGMAS * np.hypot(*seen[:2])]
        more = seen.copy()
        for i, row in enumerate(idle):
            row = row[row > 0]
            if len(row) >= IDLE:
                shown = np.median(row) / MEDIAN_OF_NORMAL
                more[i] = shown if shown > (1 + _CLEARLY / len(row) ** 0.5) * seen[i] else seen[i]
        if (more == seen).all():
            return more
        seen = more


def correlation_of(jumps: Floats) -> Floats:
    """Of noise at one station with that at the next, by its `scatter` over its size (AR(1))."""
    rho = np.linspace(0, 1, 1001)
    _, *powers = np.correlate(_DIFFERENCE, _DIFFERENCE, "full")[len(_DIFFERENCE) - 2 :]
    square = np.polynomial.polynomial.polyval(rho, [powers[0], *(2 * x for x in powers[1:])])
    left = np.sqrt(np.maximum(square / powers[0], 0.0))
    return np.interp(jumps, left[::-1], rho[::-1])


def scatter(values: Floats) -> float:
    """Standard deviation of what jumps from one value to the next."""
    if len(values) < len(_DIFFERENCE):
        return 0.0
    differences = np.convolve(values, _DIFFERENCE, mode="valid")
    # The norm, sqrt(70), is the difference's gain on white noise.
    noise = np.median(np.abs(differences)) / MEDIAN_OF_NORMAL / np.linalg.norm(_DIFFERENCE)
    if 0 < np.mean(np.diff(values) == 0) < 1:  # a converter may hide the noise
        noise = max(noise, rounding(values))
    return float(max(noise, _ROUND_OFF * np.abs(values).max()))


def rounding(values: Floats) -> float:
    """Standard deviation of what a converter rounds off; 0 of none, or one that does not move."""
    known = np.unique(values[np.isfinite(values)])
    steps = np.diff(known)
    # Of a value on the grid rounding leaves two numbers that differ in the last place.
    steps = steps[steps > _ROUND_OFF * np.abs(known).max(initial=0.0)]
    if len(steps) < 2:
        return 0.0
    off = np.abs(steps / steps.min() - np.round(steps / steps.min()))
    return float(steps.min()) / 12**0.5 if off.max() < _WHOLE else 0.0


def relative_noise(readings: Readings | Sequence[Readings], level: float) -> dict[str, float]:
    """Noise in proportion to each clamp reading's largest magnitude, as `reconstruct` takes it.

    Parameters
    ----------
    readings : Readings, or a sequence of them
        Whose magnitudes count, of several passes the largest of all.
    level : float
        Standard deviation over largest magnitude, as 0.01 for one per cent.

    Returns
    -------
    dict
        Standard deviation by column, in the column's unit.

    Raises
    ------
    InputError
        If `level` is not between 0 and 1.
    """
    passes = [*readings] if isinstance(readings, Sequence) else [readings]
    for one in passes:
        require_readings(one)
    if not (is_finite_number(level) and 0 <= level < 1):
        remedy = "it is a share of each reading's largest magnitude"
        raise InputError("noise", level, "between 0 and 1", remedy)
    return {
        name: float(level) * max(largest(one.values(name)) for one in passes)
        for name in CLAMP_READINGS
    }


def checked_noise(noise: object, columns: tuple[str, ...] = SENSED) -> dict[str, float]:
    if not isinstance(noise, Mapping):
        remedy = "`relative_noise(readings, 0.01)` makes it from a share of the largest magnitudes"
        raise InputError("noise", repr(noise), "a standard deviation by column", remedy)
    for name in noise:
        if name not in columns:
            raise InputError("noise", repr(name), f"of {', '.join(columns)}")
    remedy = "it is in the column's unit"
    return {name: within(f"noise of {name}", x, 0.0, remedy=remedy) for name, x in noise.items()}


def zero_uncertainty(readings: Readings, sizes: Floats) -> Floats:
    """What each clamp reading's zero is known to, by a rig's free stretches or as a share of sizes.

    Shape (3,), in the reading's unit.
    """
    known = readings.provenance.get("zero_uncertainty", {})
    shares = zip(CLAMP_READINGS, _ZERO * sizes, strict=True)
    stated = np.array([known.get(name, share) for name, share in shares], dtype=float)
    return np.asarray(np.maximum(stated, _SURELY * sizes), dtype=float)


def known_to(what: str, readings: Readings) -> Floats:
    """What a rig's pass says of an uncertainty, shape (3,), in the reading's unit; 0 if nothing."""
    known = readings.provenance.get(what, {})
    return np.array([known.get(name, 0.0) for name in CLAMP_READINGS], dtype=float)


def covering(misses: Floats, axis: int) -> Floats:
    """The distance within which 95 % of the samples lie; a sample that is nowhere is far away."""
    far = np.nan_to_num(misses, nan=np.inf)
    return np.asarray(np.quantile(far, _COVERAGE, axis=axis, method="higher"))


def largest(values: Floats) -> float:
    return float(np.abs(values[np.isfinite(values)]).max(initial=0.0))
