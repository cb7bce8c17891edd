"""What a study records of a sweep in space: plain numbers, by name."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from analytic.problem.arrays import Floats
from analytic.space import SpatialReadings, reconstruct_space
from analytic.space.problem.readings import CONTACT_POINT, FORCE, MOMENT
from compare.align.frames import COMPONENTS
from compare.study.grid.study import Record

_ENDS = {"touch": "touch", "slip_off": "slip-off", "release": "release"}

COLUMNS: Mapping[Record, Mapping[str, str]] = {
    "events": {
        **{f"event_{name}": "double" for name in _ENDS},
        "hops": "int64",
        "stations_touching": "int64",
    },
    "disagreement": {
        **{
            f"disagreement_{name}_{kind}": "double"
            for name in COMPONENTS
            for kind in ("rms", "max")
        },
        "agrees": "bool",
        "phase_agreement": "double",
        "stations_compared": "int64",
        "contact_rms": "double",
        **{
            f"{name}_{part}": "double"
            for name in _ENDS
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


def events(found: SpatialReadings) -> dict[str, float | int | None]:
    """Say where a sweep first touches and first leaves."""
    known = [(event["kind"], float(event["travel"])) for event in found.provenance["events"]]
    return {
        **{
            f"event_{name}": next((at for kind, at in known if kind == word), None)
            for name, word in _ENDS.items()
        },
        "hops": sum(kind == "hop" for kind, _ in known),
        "stations_touching": int(found.touching.sum()),
    }


def with_noise(readings: SpatialReadings, relative: float, seed: int) -> SpatialReadings:
    """Add a sensor's noise."""
    if relative == 0:
        return readings
    random = np.random.default_rng(seed)
    noisy: dict[str, Floats] = {}
    for names in (FORCE, MOMENT):
        values = readings.values(*names)
        size = relative * np.nanmax(np.abs(values))
        drawn = values + size * random.normal(size=values.shape)
        noisy |= dict(zip(names, drawn.T, strict=True))
    return replace(readings, table=readings.table.assign(**noisy))


def reconstruction(candidate: SpatialReadings) -> dict[str, float | None]:
    """Measure how far the contacts that the clamp shows are from the true ones."""
    true = candidate.values(*CONTACT_POINT)
    touching = candidate.trusted & np.isfinite(true).all(axis=1)
    found = reconstruct_space(candidate)[list(CONTACT_POINT)].to_numpy(dtype=float)
    far = np.linalg.norm(found - true, axis=1)[touching] / candidate.beam.length
    far = far[np.isfinite(far)]
    if far.size == 0:
        return dict.fromkeys(COLUMNS["reconstruction"])
    return {
        "reconstruction_rms": float(np.sqrt(np.mean(far**2))),
        "reconstruction_max": float(far.max()),
        "reconstruction_share": far.size / int(touching.sum()),
    }
