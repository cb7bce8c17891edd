"""Where two sweeps in space touch and leave, as far as the noise of their readings shows it."""

import math
from collections.abc import Mapping
from itertools import zip_longest
from typing import Literal, NamedTuple

import numpy as np

from analytic.numerics.arrays import Booleans, Floats
from analytic.space import SpatialReadings
from analytic.space.from_clamp.reconstruct import component_noise, felt, least_force
from analytic.space.problem.readings import FORCE, MOMENT
from compare.sense.noise import checked_level
from compare.sense.occurrence import Occurrence

_CLEAR = 2.0  # times the least force that is felt: noise hides no such force
_TOUCH, _LEAVING = "touch", "leaving"
ENDS = "slip-off", "release", _LEAVING
"""The ways a contact ends, the last one where a record does not say how."""
_Events = list[tuple[str, float, float]]  # kind, travel, by how much that is uncertain


class TouchingStations(NamedTuple):
    """Stations that touch, as far as noise lets it be seen; each of shape (stations,)."""

    reference: Booleans
    candidate: Booleans
    clear: Booleans
    """Where both do, with a force that noise cannot hide."""


def touching(
    reference: SpatialReadings, candidate: SpatialReadings, stated: Mapping[str, float]
) -> TouchingStations:
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
    return TouchingStations(found[0], found[1], np.asarray(clear))


def component_scales(reference: SpatialReadings) -> dict[str, float]:
    """The largest component of force and of moment, in stations that touch."""
    found: dict[str, float] = {}
    for names in (FORCE, MOMENT):
        values = np.abs(reference.values(*names)[reference.touching])
        found |= dict.fromkeys(names, float(values.max(initial=0.0)))
    return found


def component_levels(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    noise: float | Literal["auto"],
    scales: Mapping[str, float],
) -> dict[str, float]:
    """Noise of both sweeps together, relative to `scales`."""
    if noise != "auto":
        return checked_level(noise, (*FORCE, *MOMENT))
    one, other = component_noise(reference), component_noise(candidate)
    found: dict[str, float] = {}
    for names in (FORCE, MOMENT):  # a few stations show little: the largest of x, y and z counts
        sizes = [math.hypot(one[name], other[name]) for name in names]
        scale = scales[names[0]]
        found |= dict.fromkeys(names, max(sizes) / scale if scale > 0 else 0.0)
    return found


def paired_events(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    travel: Floats,
    touching: TouchingStations,
) -> dict[str, Occurrence]:
    """Touches, slip-offs and releases of two sweeps at the same stations.

    A source that records no events has those that its force shows: it touches or leaves between two
    stations, and its record does not say how. Then both ends are called ``"leaving"``.
    """
    both = [reference, candidate]
    if all("events" in one.provenance for one in both):
        sides = [_recorded(one) for one in both]
    else:
        sides = [
            [
                (_TOUCH if kind == _TOUCH else _LEAVING, at, wide)
                for kind, at, wide in _recorded(one)
            ]
            if "events" in one.provenance
            else _shown(on, travel, one.trusted | ~other.trusted)
            for one, other, on in zip(both, both[::-1], touching[:2], strict=True)
        ]
    found = {}
    for kind in (_TOUCH, *ENDS):
        pairs = zip_longest(*([event for event in side if event[0] == kind] for side in sides))
        for number, (one, other) in enumerate(pairs, start=1):
            found[kind if number == 1 else f"{kind} {number}"] = Occurrence(
                None if one is None else one[1],
                None if other is None else other[1],
                sum(event[2] for event in (one, other) if event is not None),
            )
    return found


def _recorded(readings: SpatialReadings) -> _Events:
    return [
        (str(event["kind"]), float(event["travel"]), 0.0)
        for event in readings.provenance["events"]
        if event["kind"] in (_TOUCH, *ENDS)
    ]


def _shown(touching: Booleans, travel: Floats, known: Booleans) -> _Events:
    """Midway between the stations before and after, and half of their distance uncertain.

    A station that this sweep alone does not trust shows neither.
    """
    touching, travel = touching[known], travel[known]
    changes = np.flatnonzero(touching[1:] != touching[:-1])
    return [
        (
            _TOUCH if touching[i + 1] else _LEAVING,
            float(travel[i] + travel[i + 1]) / 2,
            float(travel[i + 1] - travel[i]) / 2,
        )
        for i in changes
    ]
