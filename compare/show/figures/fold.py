"""The curve of a reading between the last stations before a snap-off, where it bends."""

import numpy as np

from analytic import Readings
from analytic.problem.arrays import Floats, Words

_LAST = 12  # stations of the last stretch that the curve is laid through
_FEWEST = 4  # that a cubic needs
_POINTS = 25  # drawn between two stations
_UNSURE = 0.03  # of the largest magnitude, between a parabola and the cubic at the fold


def with_fold(readings: Readings, phase: Words, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """A reading over the foot position, with points between the stations next to the snap-off.

    At a fold a reading grows with the square root of the foot's distance, so it is a smooth
    function of that root: a cubic spline in the root goes through the last stations, and on to the
    snap-off itself if the stations determine it there. Then the curve is broken, as the reading is.
    """
    if readings.snap_off is None:
        return x, y
    end = readings.snap_off / readings.beam.length
    way = np.sign(x[-1] - x[0])
    touching = np.flatnonzero(np.isin(phase, ("tip", "tangent")) & (way * (end - x) > 0))
    if not touching.size:
        return x, y
    last = touching[-1]
    ended = np.flatnonzero(phase[: last + 1] != phase[last])
    first = max(ended[-1] + 1 if ended.size else 0, last + 1 - _LAST)
    root = np.sqrt(way * (end - x[first : last + 1]))
    through = y[first : last + 1]
    if len(root) < _FEWEST or (np.diff(root) >= 0).any() or not np.isfinite(through).all():
        return x, y
    from scipy.interpolate import CubicSpline  # slow to load

    spline = CubicSpline(root[::-1], through[::-1])
    parabola = np.polynomial.Polynomial.fit(root[-3:], through[-3:], 2)
    sure = abs(spline(0.0) - parabola(0.0)) < _UNSURE * np.nanmax(np.abs(y))
    ends = np.append(root, 0.0) if sure else root
    fine = np.interp(np.arange((len(ends) - 1) * _POINTS + 1) / _POINTS, np.arange(len(ends)), ends)
    return (
        np.concatenate([x[:first], end - way * fine**2, [end], x[last + 1 :]]),
        np.concatenate([y[:first], spline(fine), [np.nan], y[last + 1 :]]),
    )
