"""Readings as a sensor has them."""

from dataclasses import replace

import numpy as np
from scipy.signal import lfilter


def noisy(readings, noise, random, memory=0.0):
    """With normal noise of given standard deviations by column; `random` is a generator or seed.

    `memory` is its correlation from one station to the next.
    """
    draw, stations = np.random.default_rng(random), len(readings.table)
    columns = {}
    for name, size in noise.items():
        white = draw.standard_normal(stations)
        white[1:] *= np.sqrt(1 - memory**2)
        columns[name] = readings.values(name) + size * lfilter([1.0], [1.0, -memory], white)
    return replace(readings, table=readings.table.assign(**columns))
