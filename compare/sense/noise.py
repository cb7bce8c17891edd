"""Noise of the clamp readings: estimated from a sweep, and put on one."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.problem.arrays import Floats

_DIFFERENCE = np.array([1.0, -4.0, 6.0, -4.0, 1.0])  # kills cubics: what is left is noise
_ROUND_OFF = 1e-14  # of the largest magnitude: no reading is better than that


def reading_noise(readings: Readings) -> dict[str, float]:
    """Standard deviation of each clamp reading's noise, in the reading's unit.

    The median of the absolute fourth differences between neighbouring trusted stations: robust
    against the few stations where a phase begins or ends, and blind to anything smooth, so a
    model's bias is not taken for noise.

    Returns
    -------
    dict
        ``force_x``, ``force_y``, ``moment_z``; 0 for fewer than five loaded stations.
    """
    loaded = readings.trusted & (
        np.hypot(readings.values("force_x"), readings.values("force_y")) > 0
    )
    return {name: scatter(readings.values(name)[loaded]) for name in CLAMP_READINGS}


def scatter(values: Floats) -> float:
    """Standard deviation of what jumps from one of the values to the next, shape (stations,)."""
    if len(values) < len(_DIFFERENCE):
        return 0.0
    differences = np.convolve(values, _DIFFERENCE, mode="valid")
    # 0.6745: median of |x| for a standard normal x; sqrt(70): the difference's gain on white noise.
    noise = np.median(np.abs(differences)) / 0.6745 / np.linalg.norm(_DIFFERENCE)
    return float(max(noise, _ROUND_OFF * np.abs(values).max()))


def noise_level(reference: Readings, candidate: Readings) -> dict[str, float]:
    """Noise of the two sweeps together, estimated, relative to the reference's largest magnitudes.

    Anything that jumps from station to station counts, as the facets of a coarse mesh do.
    """
    one, other = reading_noise(reference), reading_noise(candidate)
    return {
        name: float(np.hypot(one[name], other[name]))
        / float(np.abs(reference.values(name)[reference.trusted]).max())
        for name in CLAMP_READINGS
    }


def checked_level(level: float) -> dict[str, float]:
    """The same relative noise for all readings.

    Raises
    ------
    InputError
        If it is no share of the largest magnitude.
    """
    if not 0 <= level < 1:
        raise InputError(
            "noise", level, "between 0 and 1", "it is relative to each reading's largest magnitude"
        )
    return dict.fromkeys(CLAMP_READINGS, float(level))


def with_noise(readings: Readings, level: Mapping[str, float], seed: int) -> Readings:
    """The readings with white noise, relative to each reading's largest magnitude, on top."""
    rng = np.random.default_rng(seed)
    noisy = {
        name: readings.values(name)
        + share
        * np.nanmax(np.abs(readings.values(name)))
        * rng.standard_normal(len(readings.table))
        for name, share in level.items()
    }
    return replace(readings, table=readings.table.assign(**noisy))
