"""How well each method finds the contact, on equal readings."""

import time
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, InputError, Readings, reconstruct, reconstruct_by_decision
from analytic.from_clamp.earlier.methods import METHODS, NAMES
from analytic.problem.arrays import Floats
from analytic.problem.errors import unknown
from compare.sense.noise import with_noise

INFORMED = "elastica-informed"
"""The closed form with the true curvature, clamp and friction."""
KNOWN = ", curvature, clamp, friction"
"""What that needs beside what the closed form does."""
NOISE = (0.0, 1e-3, 1e-2)
_PHASES = ("tip", "tangent")
_EXACT = 1e-6  # of criterion (26), for readings without noise
_SIGMAS = 4.0  # times the noise; the criterion has errors of its size


def method_errors(
    truth: Readings,
    methods: Iterable[str] = NAMES,
    noise: Iterable[float] = NOISE,
    seed: int = 0,
) -> pd.DataFrame:
    """Contact error of each method, by phase and by noise of the clamp's readings."""
    chosen = list(methods)
    for name in chosen:
        if name not in NAMES:
            raise unknown("method", name, NAMES)
    if not {"contact_x", "contact_y", "phase"} <= set(truth.table):
        raise InputError(
            f"contacts of the readings ({truth.source})",
            "missing",
            "columns contact_x, contact_y and phase",
            "methods are held against contacts that are known: take a model's readings",
        )
    rows = [
        row
        for level in noise
        for sensed in [with_noise(truth, dict.fromkeys(CLAMP_READINGS, level), seed)]
        for name in chosen
        for row in _errors(truth, sensed, name, level)
    ]
    return pd.DataFrame(rows)


def needs_of(method: str) -> str:
    """What a method has to know beside the foot's position."""
    if method in METHODS:
        return ", ".join(METHODS[method].needs)
    return "moment, force, rigidity, length"


def _errors(
    truth: Readings, sensed: Readings, method: str, level: float
) -> Iterator[dict[str, Any]]:
    begun = time.process_time()
    found = contacts_by(sensed, method, level)
    seconds = time.process_time() - begun
    off = [found[name].to_numpy() - truth.values(name) for name in ("contact_x", "contact_y")]
    error = np.hypot(*off) / truth.beam.length
    phase = truth.table["phase"].to_numpy()
    touching = int(np.isin(phase, _PHASES).sum())
    for name in _PHASES:
        here: Floats = error[(phase == name) & truth.trusted]
        answered = here[np.isfinite(here)]
        yield {
            "method": method,
            "needs": needs_of(method),
            "noise": level,
            "phase": name,
            "contacts": len(here),
            "answered": len(answered) / len(here) if len(here) else np.nan,
            "median": float(np.median(answered)) if answered.size else np.nan,
            "rms": float(np.sqrt(np.mean(answered**2))) if answered.size else np.nan,
            "worst": float(answered.max()) if answered.size else np.nan,
            "seconds": seconds / max(touching, 1),
        }


def contacts_by(sensed: Readings, method: str, level: float) -> pd.DataFrame:
    """Contact points by a method, from readings with a known level of noise."""
    if method != "decision":
        return reconstruct(sensed, method=method)
    # Where noise makes an impossible force, the square root of the closed form is none.
    with np.errstate(invalid="ignore"):
        return reconstruct_by_decision(sensed, tolerance=max(_EXACT, _SIGMAS * level))
