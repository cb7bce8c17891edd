"""What a study records of a run: plain numbers, by name."""

import numpy as np
import pandas as pd

from analytic import Direction, Events, Readings, find_events, reconstruct, reconstruct_by_decision
from analytic.space import SpatialReadings, reconstruct_space
from analytic.space.problem.readings import CONTACT_POINT
from compare.read.tables import Physics

_EVENTS = ("first_contact", "phase_b_start", "phase_b_end", "back_start", "back_end", "snap_off")
_EVENTS_IN_SPACE = {"touch": "touch", "slip_off": "slip-off", "release": "release"}
_RECONSTRUCTION = ("reconstruction_rms", "reconstruction_max", "reconstruction_share")
_EXACT = 1e-6  # of criterion (26), for readings without noise
_SIGMAS = 4.0  # times the noise; the criterion has errors of its size


def find(physics: Physics, direction: Direction = "left") -> Events:
    beam, profile, held = physics
    if direction == "right":
        beam, profile, held = beam.mirrored(), profile.mirrored(), held.mirrored()
    return find_events(profile, beam, **held._asdict())


def events(
    found: Events, length: float, direction: Direction = "left"
) -> dict[str, float | bool | None]:
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


def events_on_way(found: Readings) -> dict[str, float | bool | None]:
    """Say where on a way of the clamp the events are, and how short the contact became [L]."""
    known = found.provenance["events"]
    shortest = found.table["contact_arc_length"].min() / found.beam.length
    return {
        "phase_b_exists": bool((found.table["phase"] == "tangent").any()),
        "contact_length_minimum": float(shortest),
        **{f"event_{name}": known.get(name) for name in _EVENTS},
    }


def events_in_space(found: SpatialReadings) -> dict[str, float | int | None]:
    """Say where a sweep in space first touches and first leaves."""
    known = [(event["kind"], float(event["travel"])) for event in found.provenance["events"]]
    return {
        **{
            f"event_{name}": next((at for kind, at in known if kind == word), None)
            for name, word in _EVENTS_IN_SPACE.items()
        },
        "hops": sum(kind == "hop" for kind, _ in known),
        "stations_touching": int(found.touching.sum()),
    }


def reconstruction(
    candidate: Readings | SpatialReadings, method: str = "elastica", noise: float = 0.0
) -> dict[str, float | None]:
    """Measure how far the contact points that the clamp shows are from the true ones."""
    names = [*CONTACT_POINT]
    if isinstance(candidate, SpatialReadings):
        found = reconstruct_space(candidate)
    else:
        names, found = names[:2], contacts_by(candidate, method, noise)
    true, seen = (table[names].to_numpy(dtype=float) for table in (candidate.table, found))
    touching = candidate.trusted & np.isfinite(true).all(axis=1)
    miss = np.linalg.norm(seen - true, axis=1)[touching] / candidate.beam.length
    miss = miss[np.isfinite(miss)]
    if miss.size == 0:
        return dict.fromkeys(_RECONSTRUCTION)
    return {
        "reconstruction_rms": float(np.sqrt(np.mean(miss**2))),
        "reconstruction_max": float(miss.max()),
        "reconstruction_share": miss.size / int(touching.sum()),
    }


def contacts_by(sensed: Readings, method: str, level: float) -> pd.DataFrame:
    if method != "decision":
        return reconstruct(sensed, method=method)
    # Where noise makes an impossible force, the square root of the closed form is none.
    with np.errstate(invalid="ignore"):
        return reconstruct_by_decision(sensed, tolerance=max(_EXACT, _SIGMAS * level))
