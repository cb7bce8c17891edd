"""Long sweeps drawn with no more points than a picture can show; numbers never pass through here.

A picture across a page is some 1,300 pixels wide, so what is left out would lie on what is drawn.
"""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from analytic.problem.arrays import Floats, Integers, Words

_PARTS = 500  # that a long sweep is cut into, each a pixel or three wide
_KEPT = 4  # stations of each: the first, the last, the lowest, the highest
_FEW = _PARTS * _KEPT  # are all drawn
_BEHIND = 1.9  # a dense cloud, for a line through it


def draw(ax: Axes, x: Floats, y: Floats, **style: Any) -> Line2D:  # noqa: ANN401
    """Plot a line or dots: a long line thinned, many dots as pixels."""
    are_dots = style.get("linestyle") == ""
    kept = np.arange(len(y)) if are_dots else envelope(y)
    (line,) = ax.plot(x[kept], y[kept], **style)
    if are_dots and len(y) > _FEW:
        line.set(rasterized=True, zorder=_BEHIND)
    return line


def envelope(y: Floats) -> Integers:
    """Stations that draw the same picture as all of them: no peak and no dip is lost."""
    if len(y) <= _FEW:
        return np.arange(len(y))
    lowest, highest = (np.where(np.isnan(y), bound, y) for bound in (np.inf, -np.inf))
    kept = [
        (part[0], part[-1], part[lowest[part].argmin()], part[highest[part].argmax()])
        for part in np.array_split(np.arange(len(y)), _PARTS)
    ]
    return np.unique(kept)


def stretches(phase: Words) -> tuple[Integers, Integers, Words]:
    """Uninterrupted stretches of one phase, as many as a picture can show."""
    begin, end = _runs(phase)
    if len(begin) <= _PARTS:
        return begin, end, phase[begin]
    parts = np.array_split(np.arange(len(phase)), _PARTS)
    prevailing = []
    for part in parts:
        names, counts = np.unique(phase[part], return_counts=True)
        prevailing.append(names[counts.argmax()])
    names = np.array(prevailing)
    begin, end = _runs(names)
    return (
        np.array([parts[i][0] for i in begin]),
        np.array([parts[i][-1] for i in end]),
        names[begin],
    )


def _runs(phase: Words) -> tuple[Integers, Integers]:
    edges = np.flatnonzero(phase[1:] != phase[:-1])
    return np.append(0, edges + 1), np.append(edges, len(phase) - 1)
