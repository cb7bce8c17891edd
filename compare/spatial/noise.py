"""What noise of readings in space hides of touching, and adds to the limits of agreement."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal, NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.space import SpatialReadings
from analytic.space.from_clamp.noise import component_noise, felt, least_force
from analytic.space.from_clamp.reconstruct import contacts_moved
from analytic.space.problem.readings import FORCE, MOMENT
from compare.align.frames import COMPONENTS
from compare.judge.allowance import NoiseAllowance
from compare.sense.noise import checked_level

_STATIONS = 10_000  # that an rms is estimated from: more take memory, and say the same
_CLEAR = 2.0  # times the least force that is felt: noise hides no such force


@dataclass(frozen=True)
class SpatialNoise:
    """What noise adds to the limits of agreement in space."""

    readings: NoiseAllowance = field(
        default_factory=lambda: NoiseAllowance(dict.fromkeys(COMPONENTS, 0.0))
    )  # for each component, relative to the largest of its kind in the reference
    # The rms of contact points that noise alone moves, in all but one of 400 cases [L].
    contact: float = 0.0
    unknown: float = 0.0  # the share of stations at which it leaves no contact, in as many cases


class Touching(NamedTuple):
    """Stations that touch, as far as noise lets it be seen; each of shape (stations,)."""

    reference: Booleans
    candidate: Booleans
    clear: Booleans
    """Where both do, with a force that noise cannot hide."""


def noise_levels(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    noise: float | Literal["auto"],
    scales: Mapping[str, float],
) -> dict[str, float]:
    """Noise of both sweeps together."""
    if noise != "auto":
        return checked_level(noise, COMPONENTS)
    one, other = component_noise(reference), component_noise(candidate)
    found: dict[str, float] = {}
    for names in (FORCE, MOMENT):  # a few stations show little: the largest of x, y and z counts
        sizes = [math.hypot(one[name], other[name]) for name in names]
        scale = scales[names[0]]
        found |= dict.fromkeys(names, max(sizes) / scale if scale > 0 else 0.0)
    return found


def touching(
    reference: SpatialReadings, candidate: SpatialReadings, stated: Mapping[str, float]
) -> Touching:
    """Which stations touch in either sweep.

    A force counts if it stands out of its noise, stated or seen. Where that leaves in doubt whether
    a sweep touches, since the force that the other one has there is so small, it does as the other.
    """
    sides = reference, candidate
    known = [component_noise(one, None if "events" in one.provenance else stated) for one in sides]
    seen = [felt(one, noise) for one, noise in zip(sides, known, strict=True)]
    least = [least_force(one, noise) for one, noise in zip(sides, known, strict=True)]
    force = [np.linalg.norm(one.values(*FORCE), axis=1) for one in sides]
    found = []
    for mine, other in ((0, 1), (1, 0)):
        doubtful = seen[other] & (force[other] <= _CLEAR * least[mine])
        found.append(np.asarray(seen[mine] | (doubtful & sides[mine].trusted)))
    clear = seen[0] & seen[1] & (force[0] > _CLEAR * max(least))
    return Touching(found[0], found[1], np.asarray(clear))


def spatial_noise(
    reference: SpatialReadings,
    level: Mapping[str, float],
    stated: Mapping[str, float],
    clear: Booleans,
) -> SpatialNoise:
    """What noise of that level does to the reference's contacts, and adds to the limits."""
    if not any(level.values()):
        return SpatialNoise()
    if not clear.any():
        return SpatialNoise(NoiseAllowance(level))
    some = np.flatnonzero(clear)
    some = some[:: len(some) // _STATIONS + 1]
    moved: Floats = contacts_moved(reference, stated, some) / reference.beam.length
    known = np.isfinite(moved)
    squares = np.where(known, moved, 0.0) ** 2
    rms = np.sqrt(squares.sum(axis=1) / np.maximum(known.sum(axis=1), 1))
    return SpatialNoise(NoiseAllowance(level), float(rms.max()), float((~known).mean(axis=1).max()))


def component_scales(reference: SpatialReadings) -> dict[str, float]:
    """The largest component of force and of moment, in stations that touch."""
    found: dict[str, float] = {}
    for names in (FORCE, MOMENT):
        values = np.abs(reference.values(*names)[reference.touching])
        found |= dict.fromkeys(names, float(values.max(initial=0.0)))
    return found
