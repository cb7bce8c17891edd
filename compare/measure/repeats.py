"""How well a rig repeats itself: two passes in the same direction, held against each other."""

from dataclasses import dataclass, replace

import numpy as np

from analytic import CLAMP_READINGS, SENSED, InputError, Readings
from compare.measure.measurement import measure

_STEPS = 4  # median steps of the foot that are averaged; nearer stations differ by noise alone
_ACROSS = 2  # averages next to the snap-off that do not count


@dataclass(frozen=True)
class Repeat:
    """What two passes of one vibrissa past one object differ by."""

    # By clamp reading, relative to its largest magnitude: drift that is left, hysteresis, and half
    # of the noise, as four stations are averaged.
    rms: dict[str, float]
    # By how much the second pass's foot positions exceed the first one's for equal readings, as by
    # play or creep [length]; None if the readings do not show it.
    shift: float | None
    shift_uncertainty: float  # half the width of a 95 % interval about it [length]
    rms_without_shift: dict[str, float]  # as `rms`, with the shift taken off
    stations: int  # how many averages there are


def repeat(first: Readings, second: Readings, window: float = 5e-3) -> Repeat:
    """Hold a pass against an earlier one in the same direction."""
    width = _STEPS * max(float(np.median(np.abs(np.diff(x)))) for x in map(_foot, (first, second)))
    first, second = _averaged(first, width), _averaged(second, width)
    # An average that lies across the snap-off is of two states.
    window = max(window, _ACROSS * width / float(np.ptp(_foot(first))))
    plain = measure(first, second, window)
    rms = {name: plain.disagreement[name].rms for name in CLAMP_READINGS}
    stations = plain.disagreement[CLAMP_READINGS[0]].stations
    try:
        shifted = measure(first, second, window, "auto")
    except InputError:
        return Repeat(rms, None, 0.0, rms, stations)
    without = {name: shifted.disagreement[name].rms for name in CLAMP_READINGS}
    offset = shifted.offset
    return Repeat(rms, offset.value, offset.uncertainty, without, stations)


def _foot(readings: Readings) -> np.ndarray:
    return readings.values("foot_x")


def _averaged(readings: Readings, width: float) -> Readings:
    """The means over stretches of the foot's travel: unevenly spaced noise has no spline."""
    if not width > 0:
        return readings
    foot_x = _foot(readings)
    number = np.floor(np.abs(foot_x - foot_x[0]) / width)
    table = readings.table[list(SENSED)].groupby(number).mean().reset_index(drop=True)
    return replace(readings, table=table)
