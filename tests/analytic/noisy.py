"""Readings as a sensor has them."""

from dataclasses import replace

import numpy as np


def noisy(readings, noise, random):
    """With normal noise of given standard deviations by column; `random` is a generator or seed."""
    draw, stations = np.random.default_rng(random), len(readings.table)
    columns = {n: readings.values(n) + s * draw.standard_normal(stations) for n, s in noise.items()}
    return replace(readings, table=readings.table.assign(**columns))
