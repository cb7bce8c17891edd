"""Two sweeps in space set side by side: six components, contact points, phases and events."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Words
from analytic.space import SpatialReadings, reconstruct_space
from analytic.space.problem.readings import CONTACT_POINT, FORCE, MOMENT
from compare.align.frames import Frame, components
from compare.measure.disagreement import SweepPair, disagreement, rms, worst
from compare.sense.occurrence import Occurrence
from compare.sense.touching import ENDS, TouchingStations, paired_events, touching


@dataclass(frozen=True, eq=False)
class ContactDisagreement:
    """How far the contact points are apart [L], at the stations where both are known."""

    rms: float  # NaN if there is no such station
    max: float  # NaN if there is no such station
    stations: int  # how many there are
    asked: int  # at how many both touch with a force that noise cannot hide
    # The sources that record no contacts: theirs are reconstructed from the clamp.
    from_clamp: tuple[str, ...]
    distance: Floats  # shape (stations,); of each station of the sweeps; NaN where it is not known

    def to_dict(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "distance"}


@dataclass(frozen=True, eq=False, repr=False)
class SpatialMeasurement(SweepPair[SpatialReadings]):
    """What two sweeps in space differ by, before anyone judges it.

    Components are ``"force_x"`` to ``"moment_z"``, each relative to the largest of its kind. Events
    are the travel of the foot to each touch, slip-off and release [length].
    """

    frame: Frame  # of the components
    travel: Floats  # shape (stations,); of the foot along its path [length]
    compared: Booleans  # shape (stations,); where both touch and are trusted
    idle: Booleans  # shape (stations,); where one is free, but those between an event in both
    error: Floats  # shape (6, stations); what components are off by, over `scale`
    contact: ContactDisagreement
    # Fraction of the compared stations that are in one phase; None where a source records none.
    phase_agreement: float | None
    statuses: dict[str, dict[str, int]]  # how many stations of either sweep have which status
    untrusted: int  # stations of the candidate without readings where the reference has them
    touching: TouchingStations


def measure_in_space(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    stated: Mapping[str, float],
    frame: Frame = "world",
) -> SpatialMeasurement:
    on, travel = touching(reference, candidate, stated), reference.running_values
    compared = on.reference & on.candidate
    phases = _phases(reference), _phases(candidate)
    same = None
    if phases[0] is not None and phases[1] is not None and compared.any():
        same = float((phases[0] == phases[1])[compared].mean())
    phase = np.full(len(compared), "") if phases[0] is None else phases[0].astype(str)
    events = paired_events(reference, candidate, travel, on)
    idle = reference.trusted & candidate.trusted & ~compared & ~_between(events, travel)
    exact, other, off = components(reference, frame), components(candidate, frame), {}
    errors = []
    for names in (FORCE, MOMENT):
        sizes = [np.abs(exact[name][reference.touching]).max(initial=0.0) for name in names]
        scale = float(max(sizes)) or math.nan
        for name in names:
            errors.append(error := (other[name] - exact[name]) / scale)
            here = disagreement(error[compared], travel[compared], phase[compared], scale)
            off[name] = replace(here, idle=worst(error[idle], travel[idle]))
    return SpatialMeasurement(
        reference,
        candidate,
        off,
        events,
        frame,
        travel,
        compared,
        idle,
        np.stack(errors),
        _contacts(reference, candidate, on.clear),
        same,
        {"reference": _counted(reference), "candidate": _counted(candidate)},
        int((reference.trusted & ~candidate.trusted).sum()),
        on,
    )


def _contacts(
    reference: SpatialReadings, candidate: SpatialReadings, compared: Booleans
) -> ContactDisagreement:
    from_clamp, points = [], []
    for readings in (reference, candidate):
        contact = readings.values(*CONTACT_POINT)
        if not np.isfinite(contact[compared]).all():
            contact = reconstruct_space(readings)[list(CONTACT_POINT)].to_numpy(dtype=float)
            from_clamp.append(readings.source)
        points.append(contact)
    distance = np.linalg.norm(points[0] - points[1], axis=1) / reference.beam.length
    distance[~compared] = np.nan
    far = distance[np.isfinite(distance)]
    most = float(far.max()) if far.size else math.nan
    asked = int(compared.sum())
    return ContactDisagreement(float(rms(far)), most, far.size, asked, tuple(from_clamp), distance)


def _between(events: Mapping[str, Occurrence], travel: Floats) -> Booleans:
    """Stations between one event in two sweeps: it is what is off there.

    But a touch, before which a vibrissa is all but unloaded, if it may be one and the same.
    """
    found = np.zeros(len(travel), dtype=bool)
    for kind, one in events.items():
        apart = one.difference is not None and not one.agrees(0.0)
        if apart or kind.startswith(ENDS):
            ends = [math.inf if at is None else at for at in (one.reference, one.candidate)]
            found |= (travel >= min(ends)) & (travel <= max(ends))
    return found


def _phases(readings: SpatialReadings) -> Words | None:
    return readings.table["phase"].to_numpy() if "phase" in readings.table else None


def _counted(readings: SpatialReadings) -> dict[str, int]:
    if "status" in readings.table:
        return {str(k): int(n) for k, n in readings.table["status"].value_counts().items()}
    fine = int(readings.trusted.sum())
    missing = len(readings.table) - fine
    return {"ok": fine} | ({"missing": missing} if missing else {})
