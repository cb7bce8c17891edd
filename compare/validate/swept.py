"""The closed form's sweep of a case whose inputs are off."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from analytic import CLAMP_READINGS, Case, Sweep, solve_sweep
from analytic.problem.arrays import Floats
from compare.validate.inputs import GAINS, INPUTS


@dataclass(frozen=True)
class Swept:
    """What a sensor reads of a case, over the stations of the nominal one."""

    readings: Floats  # shape (3, stations); NaN where the vibrissa is free or has no trusted state
    snap_off: float | None  # its foot position [length]


def swept(case: Case, changes: Mapping[str, float] | None = None) -> Swept:
    """The closed form's sweep of a case whose inputs are off, over the stations of the case."""
    changes = {} if changes is None else changes
    start, stop = (float(x) + changes.get("foot_x", 0.0) for x in case.foot_x[[0, -1]])
    varied = replace(case, sweep=Sweep(2, direction=case.sweep.direction))
    gains = np.ones((len(CLAMP_READINGS), 1))
    for name, by in changes.items():
        if name in GAINS:
            gains[GAINS.index(name)] += by
        elif name != "foot_x" and by != 0:
            varied = INPUTS[name].larger(varied, by)
    # A sweep has to start clear of the object: stations are put before the first one.
    number = case.sweep.stations
    step = (stop - start) / (number - 1)
    before = max(0, math.ceil((float(varied.foot_x[0]) - start) / -step))
    sweep = Sweep(number + before, start - before * step, stop, case.sweep.direction)
    found = solve_sweep(replace(varied, sweep=sweep))
    known = found.trusted & (found.table["phase"] != "free").to_numpy()
    readings = np.stack([np.where(known, found.values(n), np.nan) for n in CLAMP_READINGS])
    away = changes.get("foot_x", 0.0)
    return Swept(
        (gains * readings)[:, before:], None if found.snap_off is None else found.snap_off - away
    )
