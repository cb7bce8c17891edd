"""Contacts from the clamp readings by an earlier method, on the terms of `reconstruct`."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from analytic.from_clamp.contact import LONGEST, dimensionless, sides
from analytic.from_clamp.earlier.methods import METHODS, NAMES
from analytic.from_clamp.earlier.sensed import LoadedStations
from analytic.from_clamp.phases import judge_phases
from analytic.problem.arrays import Booleans, Floats
from analytic.problem.columns import SENSED
from analytic.problem.errors import unknown
from analytic.problem.readings import Readings


def reconstruct_earlier(
    readings: Readings, method: str, noise: Mapping[str, float] | None = None
) -> pd.DataFrame:
    """Contact points by one of the methods that were there before the closed form."""
    if method not in METHODS:
        raise unknown("method", method, NAMES)
    chosen = METHODS[method]
    sensed = dimensionless(readings)
    gap = np.isnan(sensed).any(axis=0)
    phase = np.where(gap, "gap", judge_phases(readings, noise).phase)
    loaded = ~gap & (phase != "free")
    side = sides(sensed)
    foot_x, force_x, force_y, moment = (side * sensed)[:, loaded]
    first = _first_contact(readings, sensed, loaded)
    travel = side[0, loaded] * first / readings.beam.length - foot_x
    answer = chosen.estimate(LoadedStations(foot_x, -force_x, force_y, moment, travel))
    reach = np.hypot(answer.x - foot_x, answer.y)
    x, y = answer
    if "force" in chosen.needs:
        normal = np.arctan2(-force_x, force_y)
        radius = readings.beam.radius / readings.beam.length
        x, y = x - radius * np.sin(normal), y + radius * np.cos(normal)
    status = np.where(gap, "gap", "free").astype(object)
    with np.errstate(invalid="ignore"):
        status[loaded] = np.where(
            np.isnan(x), "no answer", np.where(reach > LONGEST, "longer than the vibrissa", "ok")
        )
    places = np.full((2, len(phase)), np.nan)
    places[:, loaded] = side[0, loaded] * x, y
    contact_x, contact_y = np.where(status == "ok", places * readings.beam.length, np.nan)
    status = status.astype(str)
    return pd.DataFrame(
        {"contact_x": contact_x, "contact_y": contact_y, "phase": phase, "status": status}
    )


def _first_contact(readings: Readings, sensed: Floats, loaded: Booleans) -> float:
    """Where the moment of the first two loaded stations goes to zero, behind the last free one."""
    at = np.flatnonzero(loaded)
    foot_x = readings.values(SENSED[0])
    if len(at) < 2:
        return float(foot_x[at[0]]) if len(at) else 0.0
    first, second = at[:2]
    moment = sensed[3]
    share = moment[first] / (moment[second] - moment[first])
    back = float(foot_x[first] - share * (foot_x[second] - foot_x[first]))
    free = float(foot_x[first - 1]) if first else back
    low, high = sorted((float(foot_x[first]), free))
    return min(max(back, low), high)
