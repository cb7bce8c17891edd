"""Readings of a vibrissa that nobody named: of L = EI = 1 if they can be, and said so."""

from dataclasses import replace

import numpy as np
import pandas as pd

from analytic import Beam, InputError, Readings, reconstruct
from analytic.from_clamp.reconstruct import clearly_loaded

ASSUMED = "vibrissa_assumed"
"""In the provenance of a sweep whose vibrissa nobody named."""

BEAM_WANTED = "use --beam FILE, for a reference --reference-beam FILE (in Python beam=Beam(...))"
"""What to do about a missing vibrissa."""

_LOOKED_AT = 2000  # stations
# Of readings that are of L = EI = 1 and have 5 % of noise at most 0.18 were of no elastica, and
# contacts got at most 0.9 L off the contour (25 objects); with 1 %, 0.01 and 0.2 L.
_IMPOSSIBLE = 0.25
_OFF = 1.0  # L


def assumed_of(readings: Readings) -> Readings:
    """A sweep of the default vibrissa, whose provenance says that it is assumed."""
    thin = readings.table.iloc[:: len(readings.table) // _LOOKED_AT + 1]
    some = replace(readings, table=thin.reset_index(drop=True)) if len(thin) > 1 else readings
    found = reconstruct(some)[clearly_loaded(some)]
    good = found["status"] == "ok"
    wrong, apart = int((~good).sum()), _off_the_contour(found[good])
    why = f"contacts up to {apart:.2g} L off any one object with" if apart > _OFF else ""
    if wrong > _IMPOSSIBLE * len(found):
        why = f"{wrong} of {len(found)} contacts cannot be of"
    if why:
        allowed = f"the one that was measured ({why} L = EI = 1)"
        remedy = f"{BEAM_WANTED}; and check the signs of {readings.source}"
        raise InputError("vibrissa", "none given", allowed, remedy)
    return replace(readings, provenance={**readings.provenance, ASSUMED: "L = EI = 1"})


def vibrissa_of(readings: Readings) -> Beam | None:
    """The vibrissa of a sweep; None if it is assumed."""
    return None if ASSUMED in readings.provenance else readings.beam


def _off_the_contour(found: pd.DataFrame) -> float:
    """How far contacts get along their normals [L]: not at all on a contour, nor at a corner.

    The largest step counts as none: the vibrissa may swing to the other side of the object.
    """
    x, y, alpha = found[["contact_x", "contact_y", "contact_angle"]].to_numpy(dtype=float).T
    if len(x) < 2:
        return 0.0
    normal = (alpha[1:] + alpha[:-1]) / 2
    steps = np.diff(y) * np.cos(normal) - np.diff(x) * np.sin(normal)
    steps[np.argmax(np.abs(steps))] = 0.0
    return float(np.ptp(np.cumsum(steps)))
