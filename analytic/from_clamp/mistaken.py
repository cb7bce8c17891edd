"""Mistakes of signs, axes and units that would explain readings of no such vibrissa."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from analytic.from_clamp.phases import judge_phases
from analytic.problem.arrays import Booleans
from analytic.problem.columns import CLAMP_READINGS
from analytic.problem.readings import Readings

_LOOKED_AT = 200  # stations; more say nothing new
_EXPLAINS = 0.95  # of the stations: a few lie between two phases, or are spikes
_UNITS = (1e3, 1e6, 9.80665)  # by which units are mistaken: milli, micro, kgf and N
_FORCES, _MOMENT = CLAMP_READINGS[:2], CLAMP_READINGS[2:]


@dataclass(frozen=True)
class _Mistake:
    """What is said of it, and what undoes it: factors of the readings, after forces are swapped."""

    said: str
    factors: dict[str, float] = field(default_factory=dict)
    swapped: bool = False

    def undone(self, readings: Readings) -> Readings:
        source = dict(zip(CLAMP_READINGS, CLAMP_READINGS, strict=True))
        if self.swapped:
            source |= zip(_FORCES, reversed(_FORCES), strict=True)
        right = {n: self.factors.get(n, 1.0) * readings.values(source[n]) for n in CLAMP_READINGS}
        return replace(readings, table=readings.table.assign(**right))


def likely_mistakes(readings: Readings, counted: Booleans) -> list[str]:
    """What may have been mistaken, if that makes contacts of what is none."""
    thin = np.arange(0, len(counted), len(counted) // _LOOKED_AT + 1)
    if len(thin) < 2 or not counted[thin].any():
        return []
    some = replace(readings, table=readings.table.iloc[thin].reset_index(drop=True))
    return [
        one.said
        for one in _mistakes()
        if judge_phases(one.undone(some)).explained[counted[thin]].mean() >= _EXPLAINS
    ]


def _mistakes() -> Iterator[_Mistake]:
    for name in ("moment_z", "force_x", "force_y"):
        yield _Mistake(f"the sign of {name}", {name: -1.0})
    yield _Mistake(
        "all signs (the vibrissa's action on the clamp)", dict.fromkeys(CLAMP_READINGS, -1.0)
    )
    yield _Mistake("force_x and force_y, swapped", swapped=True)
    for name in _FORCES:
        yield _Mistake("the sensor's axes, turned by 90 degrees", {name: -1.0}, swapped=True)
    for names, called in (
        (_FORCES, "both forces"),
        (_MOMENT, "moment_z"),
        (CLAMP_READINGS, "all three readings, or of the flexural rigidity"),
    ):
        for unit in _UNITS:
            yield _Mistake(
                f"the unit of {called} ({unit:.4g} times too large)", dict.fromkeys(names, 1 / unit)
            )
            yield _Mistake(
                f"the unit of {called} ({unit:.4g} times too small)", dict.fromkeys(names, unit)
            )
