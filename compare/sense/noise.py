"""Noise of two sweeps: relative to the reference, as a level, and put on one."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.from_clamp.noise import largest, reading_noise, resting_noise

NOTHING = 1e-100  # in any units: less is no load
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


def noise_level(reference: Readings, candidate: Readings) -> dict[str, float]:
    """Noise of the two sweeps together, estimated.

    Anything that jumps from station to station counts, as the facets of a coarse mesh do, and what
    readings scatter by off the contact; of a mean of passes what these scatter by, too, as hum
    does, which hardly jumps.
    """
    one, other, scale = shown_noise(reference), shown_noise(candidate), scales(reference)
    return {name: float(np.hypot(one[name], other[name])) / scale[name] for name in CLAMP_READINGS}


def shown_noise(readings: Readings) -> dict[str, float]:
    """Standard deviation of each clamp reading's noise, also of what remembers."""
    between = readings.provenance.get("scatter", {})
    values = np.stack([readings.values(name) for name in CLAMP_READINGS])[:, readings.trusted]
    seen = resting_noise(values, np.array([*reading_noise(readings).values()]))
    known = zip(CLAMP_READINGS, seen.tolist(), strict=True)
    return {name: max(x, between.get(name, 0.0)) for name, x in known}


def checked_level(level: float, names: Sequence[str] = CLAMP_READINGS) -> dict[str, float]:
    """The same relative noise for all readings."""
    if isinstance(level, bool | str) or not 0 <= level < 1:
        raise InputError(
            "noise",
            level,
            "'auto', or between 0 and 1",
            "it is relative to each reading's largest magnitude",
        )
    return dict.fromkeys(names, float(level))


def with_noise(readings: Readings, level: Mapping[str, float], seed: int) -> Readings:
    rng = np.random.default_rng(seed)
    noisy = {
        name: readings.values(name)
        + fraction * largest(readings.values(name)) * rng.standard_normal(len(readings.table))
        for name, fraction in level.items()
    }
    return replace(readings, table=readings.table.assign(**noisy))
