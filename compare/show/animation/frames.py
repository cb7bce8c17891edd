"""Which stations of a sweep are frames of its film."""

import numpy as np

from analytic import InputError
from analytic.problem.arrays import Integers


def framed(touching: Integers, stations: int, frames: int, source: str) -> Integers:
    """Evenly over all of the sweep, if it touches anything."""
    if frames < 2:
        raise InputError("--frames", frames, "2 or more", "60 is usual")
    if not touching.size:
        raise InputError(f"stations in contact ({source})", 0, "one or more", "sweep farther")
    return np.unique(np.linspace(0, stations - 1, min(frames, stations)).astype(int))
