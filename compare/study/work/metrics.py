"""What a study records of a run: plain numbers, by name."""

from collections.abc import Mapping

import numpy as np

from analytic import CLAMP_READINGS, Direction, Events, Readings, find_events
from compare.measure.methods import contacts_by
from compare.read.tables import Physics
from compare.sense.transitions import TRANSITIONS
from compare.study.grid.study import Record

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
"""Columns of a row by what is recorded, with their Arrow types; those of a
disagreement are `Judged.metrics`."""


def find(physics: Physics, direction: Direction = "left") -> Events:
    """Find the events of the sweep in closed form."""
    beam, profile, clamp_stiffness, friction = physics
    if direction == "right":
        beam, profile = beam.mirrored(), profile.mirrored()
    return find_events(profile, beam, clamp_stiffness=clamp_stiffness, friction=friction)


def events(
    found: Events, length: float, direction: Direction = "left"
) -> dict[str, float | bool | None]:
    """Say where the events of a sweep are."""
    way = -1 if direction == "right" else 1
    places = {name: getattr(found, name) for name in _EVENTS}
    places = {n: x if x is not None and x.status == "ok" else None for n, x in places.items()}
    minimum = found.contact_length_minimum.contact_arc_length
    return {
        "phase_b_exists": places["phase_b_start"] is not None,
        "contact_length_minimum": float(minimum) / length,
        **{
            f"event_{name}": None if event is None else way * float(event.foot_x)
            for name, event in places.items()
        },
    }


def reconstruction(
    candidate: Readings, method: str = "elastica", noise: float = 0.0
) -> dict[str, float | None]:
    """Measure how far the contact points that the clamp shows are from the true ones."""
    touching = candidate.trusted & np.isfinite(candidate.values("contact_x"))
    found = contacts_by(candidate, method, noise)
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
