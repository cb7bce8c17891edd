"""Where two sweeps in space touch and leave, event by event."""

from itertools import zip_longest

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.space import SpatialReadings
from compare.sense.occurrence import Occurrence
from compare.sense.touching import TouchingStations

_TOUCH, _LEAVING, _ENDS = "touch", "leaving", ("slip-off", "release")
_Events = list[tuple[str, float, float]]  # kind, travel, by how much that is uncertain


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
            else _shown(on, travel)
            for one, on in zip(both, touching[:2], strict=True)
        ]
    found = {}
    for kind in (_TOUCH, *_ENDS, _LEAVING):
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
        if event["kind"] in (_TOUCH, *_ENDS)
    ]


def _shown(touching: Booleans, travel: Floats) -> _Events:
    """Midway between the stations before and after, and half of their distance uncertain."""
    changes = np.flatnonzero(touching[1:] != touching[:-1])
    return [
        (
            _TOUCH if touching[i + 1] else _LEAVING,
            float(travel[i] + travel[i + 1]) / 2,
            float(travel[i + 1] - travel[i]) / 2,
        )
        for i in changes
    ]
