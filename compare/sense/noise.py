"""Noise of two sweeps: relative to the reference, as a level, and put on one."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.from_clamp.noise import SIGMAS, correlation_of, largest, reading_noise, resting_noise

NOTHING = 1e-100  # in any units: less is no load
# Relative standard uncertainties of a level, times the root of the number of stations it is from:
# of jumps on 200 to 2000 of white noise; of the median of half of those that rest.
_JUMPING, _RESTING = 1.7, 1.7
_ROUNDING = 1e-16  # of a moment beside a force times length: less is none


def scales(reference: Readings) -> dict[str, float]:
    """Largest magnitude of each clamp reading, which all disagreements are relative to."""
    trusted = reference.trusted
    largest = {
        name: float(np.abs(reference.values(name)[trusted]).max(initial=0.0))
        for name in CLAMP_READINGS
    }
    force = max(largest["force_x"], largest["force_y"])
    moment = max(largest["moment_z"], force * reference.beam.length)
    if not moment > NOTHING:
        raise InputError(
            f"contact of the reference ({reference.source})",
            "none",
            "at some stations, with a load in the clamp",
            "a case needs a start and stop of its [sweep] or [whisk] on either side of the object, "
            "a file the right columns",
        )
    by_moment = moment / reference.beam.length
    force = force if force > _ROUNDING * by_moment else by_moment
    instead = {"force_x": force, "force_y": force, "moment_z": moment}
    return {
        name: largest[name] if largest[name] > _ROUNDING * size else size
        for name, size in instead.items()
    }


class Noise(NamedTuple):
    """Of each clamp reading, by name."""

    level: Mapping[str, float]  # its standard deviation
    unsure: Mapping[str, float] = {}  # relative standard uncertainty of that, if it is estimated
    # Fraction of the stations of which independent noise would say as much; all if nothing is said.
    independent: Mapping[str, float] = {}


def noise_level(reference: Readings, candidate: Readings) -> Noise:
    """Noise of the two sweeps together over the reference's largest magnitudes, estimated.

    Anything that jumps from station to station counts, as the facets of a coarse mesh do, and what
    readings scatter by off the contact; of a mean of passes what these scatter by, too, as hum
    does, which hardly jumps.
    """
    one, other, scale = shown_noise(reference), shown_noise(candidate), scales(reference)
    larger = {n: one if one.level[n] > other.level[n] else other for n in CLAMP_READINGS}
    return Noise(
        {n: float(np.hypot(one.level[n], other.level[n])) / scale[n] for n in CLAMP_READINGS},
        {n: larger[n].unsure[n] for n in CLAMP_READINGS},
        {n: larger[n].independent[n] for n in CLAMP_READINGS},
    )


def shown_noise(readings: Readings) -> Noise:
    """Each clamp reading's noise, also of what remembers."""
    between = readings.provenance.get("scatter", {})
    values = np.stack([readings.values(name) for name in CLAMP_READINGS])[:, readings.trusted]
    jumps = np.array([*reading_noise(readings).values()])
    resting = resting_noise(values, jumps)
    rests = np.hypot(*values[:2]) <= SIGMAS * np.hypot(*resting[:2])
    share = np.divide(jumps, resting, out=np.ones_like(jumps), where=resting > 0)
    rho = np.where(share < 1, correlation_of(share), 0.0)
    independent = (1 - rho**2) / (1 + rho**2)
    unsure = np.where(
        share < 1,
        _RESTING / np.sqrt(np.maximum(independent * rests.sum(), 1)),
        _JUMPING / np.sqrt(max(rests.size, 1)),
    )
    level, *of = (
        dict(zip(CLAMP_READINGS, x.tolist(), strict=True)) for x in (resting, unsure, independent)
    )
    return Noise({n: max(x, between.get(n, 0.0)) for n, x in level.items()}, *of)


def checked_level(level: float, names: Sequence[str] = CLAMP_READINGS) -> dict[str, float]:
    """The same relative noise for all readings."""
    if isinstance(level, bool | str) or not 0 <= level < 1:
        remedy = "it is relative to each reading's largest magnitude"
        raise InputError("noise", level, "'auto', or between 0 and 1", remedy)
    return dict.fromkeys(names, float(level))


def with_noise(readings: Readings, level: Mapping[str, float], seed: int) -> Readings:
    rng = np.random.default_rng(seed)
    noisy = {
        name: readings.values(name)
        + fraction * largest(readings.values(name)) * rng.standard_normal(len(readings.table))
        for name, fraction in level.items()
    }
    return replace(readings, table=readings.table.assign(**noisy))
