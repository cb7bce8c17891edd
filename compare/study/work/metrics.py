"""What a study records of a run: plain numbers, by name."""

from collections.abc import Mapping

import numpy as np

from analytic import CLAMP_READINGS, Beam, Contour, Readings, find_events, reconstruct
from compare.comparison import compare
from compare.sense.transitions import TRANSITIONS
from compare.study.grid.file import Record

_EVENTS = ("first_contact", "phase_b_start", "phase_b_end", "snap_off")

COLUMNS: Mapping[Record, Mapping[str, str]] = {
    "events": {
        "phase_b_exists": "bool",
        "contact_length_minimum": "double",
        **{f"event_{name}": "double" for name in _EVENTS},
    },
    "disagreement": {
        **{
            f"disagreement_{name}_{kind}": "double"
            for name in CLAMP_READINGS
            for kind in ("rms", "max")
        },
        "agrees": "bool",
        "phase_agreement": "double",
        "stations_compared": "int64",
        **{
            f"{place}_{part}": "double"
            for place in (*(f"transition_{name}" for name in TRANSITIONS), "snap_off")
            for part in ("reference", "candidate", "difference")
        },
    },
    "reconstruction": {
        "reconstruction_rms": "double",
        "reconstruction_max": "double",
        "reconstruction_share": "double",
    },
}
"""Columns of a row by what is recorded, with their Arrow types; see `events` and the others."""


def events(beam: Beam, profile: Contour) -> dict[str, float | bool | None]:
    """The events of the sweep in closed form.

    ``contact_length_minimum`` [L] is that of eq. 21: Phase B exists where it is less than 1 and the
    sweep gets there before the snap-off. ``event_*`` are foot positions
    [length], None where there is no such event.
    """
    found = find_events(profile, beam)
    places = {name: getattr(found, name) for name in _EVENTS}
    minimum = found.contact_length_minimum.contact_arc_length
    return {
        "phase_b_exists": found.phase_b_start is not None,
        "contact_length_minimum": float(minimum) / beam.length,
        **{
            f"event_{name}": None if event is None else float(event.foot_x)
            for name, event in places.items()
        },
    }


def disagreement(reference: Readings, candidate: Readings) -> dict[str, float | int | bool | None]:
    """What `compare.compare` finds: relative to each reading's largest magnitude, places [length].

    Raises
    ------
    InputError
        If the two have no station in contact in common.
    """
    found = compare(reference, candidate)
    row: dict[str, float | int | bool | None] = {}
    for name, one in found.disagreement.items():
        row[f"disagreement_{name}_rms"] = one.rms
        row[f"disagreement_{name}_max"] = one.max
    row["agrees"] = found.agrees
    row["phase_agreement"] = min(found.phase_agreement().values(), default=None)
    row["stations_compared"] = found.alignment.counts["compared"]
    places = {f"transition_{name}": place for name, place in found.transitions.items()}
    for name, place in {**places, "snap_off": found.snap_off}.items():
        row[f"{name}_reference"] = place.reference
        row[f"{name}_candidate"] = place.candidate
        row[f"{name}_difference"] = place.difference
    return row


def reconstruction(candidate: Readings) -> dict[str, float | None]:
    """How far the contact points told by the clamp are from the true ones [L].

    Over the trusted stations in contact; ``reconstruction_share`` is the share of them whose
    readings some elastica explains, the others have no contact point.
    """
    touching = candidate.trusted & np.isfinite(candidate.values("contact_x"))
    found = reconstruct(candidate)
    miss = np.hypot(
        found["contact_x"].to_numpy() - candidate.values("contact_x"),
        found["contact_y"].to_numpy() - candidate.values("contact_y"),
    )[touching]
    miss = miss[np.isfinite(miss)] / candidate.beam.length
    if miss.size == 0:
        return dict.fromkeys(COLUMNS["reconstruction"])
    return {
        "reconstruction_rms": float(np.sqrt(np.mean(miss**2))),
        "reconstruction_max": float(miss.max()),
        "reconstruction_share": miss.size / int(touching.sum()),
    }
