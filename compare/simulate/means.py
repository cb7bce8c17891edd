"""A sweep at rest with the means that a sweep in motion has.

The readings of a coarse beam have kinks where the contact passes from segment to segment, so that a
mean over a distance is not the value in its middle: 9e-4 rms with twenty segments and sixty
stations.
"""

from dataclasses import replace

import numpy as np

from analytic import CLAMP_READINGS, Case, Readings
from mujoco_models import simulate_sweep
from mujoco_models.settings import Settings

_PARTS = 8  # of the distance from station to station


def sweep_as_means(case: Case, settings: Settings, average: float) -> Readings:
    """Sweep at rest, each station's clamp readings the means over the distance around it."""
    if average == 0:
        return simulate_sweep(case, settings)
    case.require_sweep("a budget in motion")
    first, last = (float(x) for x in case.foot_x[[0, -1]])
    stations = case.sweep.stations
    found = simulate_sweep(case.between(first, last, (stations - 1) * _PARTS + 1), settings)
    table = found.table.iloc[::_PARTS].reset_index(drop=True)
    places = np.arange(len(found.table))
    offsets = average * _PARTS * np.linspace(-0.5, 0.5, _PARTS + 1)
    wanted = np.clip(_PARTS * np.arange(stations)[:, None] + offsets, 0, places[-1])
    width = np.ptp(wanted, axis=1)
    for name in CLAMP_READINGS:
        values = np.interp(wanted, places, found.values(name))
        table[name] = np.trapezoid(values, wanted, axis=1) / width
    nowhere = table[[*CLAMP_READINGS]].isna().any(axis=1)
    table["status"] = table["status"].mask(nowhere & (table["status"] == "ok"), "unsettled")
    return replace(found, table=table)
