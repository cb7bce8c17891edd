"""How noisy a sweep's readings are, estimated from the readings themselves."""

import numpy as np

from analytic import Readings
from analytic.problem.arrays import Floats
from analytic.problem.readings import CLAMP_READINGS

_DIFFERENCE = np.array([1.0, -4.0, 6.0, -4.0, 1.0])  # kills cubics: what is left is noise
_ROUND_OFF = 1e-14  # of the largest magnitude: no reading is better than that


def reading_noise(readings: Readings) -> dict[str, float]:
    """Standard deviation of each clamp reading's noise, in the reading's unit.

    The median of the absolute fourth differences between neighbouring trusted stations: robust
    against the few stations where a phase begins or ends, and blind to anything smooth, so a
    model's bias is not taken for noise.

    Returns
    -------
    dict
        ``force_x``, ``force_y``, ``moment_z``; 0 for fewer than five loaded stations.
    """
    loaded = readings.trusted & (
        np.hypot(readings.values("force_x"), readings.values("force_y")) > 0
    )
    return {name: _noise(readings.values(name)[loaded]) for name in CLAMP_READINGS}


def _noise(values: Floats) -> float:
    if len(values) < len(_DIFFERENCE):
        return 0.0
    differences = np.convolve(values, _DIFFERENCE, mode="valid")
    # 0.6745: median of |x| for a standard normal x; sqrt(70): the difference's gain on white noise.
    noise = np.median(np.abs(differences)) / 0.6745 / np.linalg.norm(_DIFFERENCE)
    return float(max(noise, _ROUND_OFF * np.abs(values).max()))
