"""What pictures over the foot position share: units of the beam, phases, marks, keys, folds."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from analytic import CLAMP_READINGS, Readings
from analytic.numerics.arrays import Floats, Words
from analytic.space import SpatialReadings
from compare.comparison import Comparison
from compare.sense.phases import Classification
from compare.show import style
from compare.show.numbers import Kind, quantity

LINE: dict[str, Any] = {"color": style.REFERENCE, "linewidth": 3.0}
"""How the reference is drawn: so wide that dots upon it hide it nowhere."""
_DOTS = {"color": style.CANDIDATE, "marker": "o", "markeredgewidth": 0, "linestyle": ""}
_IN_KEY = 2.0  # times as large is a dot there, where it is alone
_MANY = 2000  # dots are pixels, behind a line through them
_BEYOND_TIP = 1.1  # L; as far as a noisy contact is drawn
# Of the curve between the last stations before a snap-off:
_LAST = 12  # stations of the last stretch that it is laid through
_FEWEST = 4  # that a cubic needs
_POINTS = 25  # drawn between two stations
_UNSURE = 0.03  # of the largest magnitude, between a parabola and the cubic at the fold


def stacked(readings: Readings) -> tuple[Figure, dict[str, Axes]]:
    """Axes for the clamp readings, one above the other, over the foot position."""
    figure = Figure(figsize=(style.PAGE_WIDTH, 7.0), layout="constrained")
    axes = figure.subplots(len(CLAMP_READINGS), 1, sharex=True)
    for ax in axes:
        ax.tick_params(labelsize=style.SMALL)
    axes[-1].set_xlabel(foot_label(readings))
    return figure, dict(zip(CLAMP_READINGS, axes, strict=True))


def dots(comparison: Comparison) -> dict[str, Any]:
    """How the candidate is drawn: the smaller the more stations it has."""
    size = 2.0 if len(comparison.candidate.table) > 100 else 3.5
    return {**_DOTS, "markersize": size}


def foot(readings: Readings) -> Floats:
    """Places along the sweep as they are drawn."""
    return readings.running_values / readings.running_unit[0]


def unit(readings: Readings | SpatialReadings, name: str) -> float:
    beam = readings.beam
    return beam.moment_unit if name.startswith("moment") else beam.force_unit


def in_unit(readings: Readings | SpatialReadings, name: str) -> Floats:
    """A clamp reading as it is drawn; NaN where it is not to be trusted."""
    return np.where(readings.trusted, readings.values(name) / unit(readings, name), np.nan)


def reading_label(readings: Readings, name: str) -> str:
    """A reading's symbol and the unit it is drawn in, with what that is where it is known."""
    if not readings.beam.si or name not in CLAMP_READINGS:
        return style.axis_label(name)
    kind: Kind = "moment" if name == "moment_z" else "force"
    size = quantity(unit(readings, name), kind, readings.beam)
    return f"{style.SYMBOLS[name]} / ({style.UNITS[name]} = {size})"


def foot_label(readings: Readings) -> str:
    beam = readings.beam
    own = f"   ($L$ = {quantity(beam.length, 'length', beam)})" if beam.si else ""
    return style.ALONG[readings.running].axis + own


def scaled(readings: Readings, judged: Classification, name: str) -> Floats:
    if name in CLAMP_READINGS:
        return in_unit(readings, name)
    return on_vibrissa(1 - judged.shortfall)


def on_vibrissa(s: Floats) -> Floats:
    """Arc lengths of contacts, without those that are no place on the vibrissa.

    Without a load the noise of a rig puts a contact anywhere; with one, a little beyond the tip.
    """
    return np.where((s > 0) & (s < _BEYOND_TIP), s, np.nan)


def draw(ax: Axes, x: Floats, y: Floats, **style: Any) -> None:  # noqa: ANN401
    """Plot a line or dots, many dots as pixels: a page must not grow with the stations."""
    if style.get("linestyle") == "" and len(y) > _MANY:
        style |= {"rasterized": True, "zorder": 1.9}
    ax.plot(x, y, **style)


def shade_phases(ax: Axes, foot_x: Floats, phase: Words) -> None:
    """Draw the contact phases of a sweep as a background over its foot positions."""
    for name in ("tip", "tangent"):
        here = phase == name
        here[:-1] |= here[1:]  # from the station before on
        ax.fill_between(
            foot_x, 0, 1, where=here, transform=ax.get_xaxis_transform(),
            color=style.PHASE_COLOURS[name], alpha=0.10, linewidth=0,
            rasterized=len(phase) > _MANY,
        )  # fmt: skip


def shade_reference(ax: Axes, comparison: Comparison) -> None:
    """Draw the contact phases of a comparison's reference as a background."""
    shade_phases(ax, foot(comparison.reference), comparison.judged["reference"].phase)


def key_below(figure: Figure, meant: Axes | Sequence[Artist], columns: int) -> None:
    """Say below all axes what is meant by these artists, or by those of one axes.

    A figure that lays itself out makes room for it.
    """
    handles = meant.get_legend_handles_labels()[0] if isinstance(meant, Axes) else meant
    outside = "outside " if figure.get_layout_engine() else ""
    place: Any = f"{outside}lower center"
    look: Any = {"fontsize": style.SMALL, "frameon": False, "markerscale": _IN_KEY}
    figure.legend(handles=handles, loc=place, ncols=columns, **look)


def phase_handles(*phases: str, **look: Any) -> list[Artist]:  # noqa: ANN401  # matplotlib's
    """A line in the colour of each phase, by default of all."""
    return [
        Line2D([], [], color=style.PHASE_COLOURS[phase], label=style.PHASE_NAMES[phase], **look)
        for phase in phases or style.PHASE_COLOURS
    ]


def key(ax: Axes) -> list[Artist]:
    """What the lines and the shades of a reading's axes mean."""
    return [
        *ax.get_legend_handles_labels()[0],
        *phase_handles("tip", "tangent", alpha=0.35, linewidth=7),
    ]


def with_fold(readings: Readings, phase: Words, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """A reading over the foot position, with points between the stations next to the snap-off.

    At a fold a reading grows with the square root of the foot's distance, so it is a smooth
    function of that root: a cubic spline in the root goes through the last stations, and on to the
    snap-off itself if the stations determine it there. Then the curve is broken, as the reading is.
    """
    if readings.snap_off is None:
        return x, y
    end = readings.snap_off / readings.running_unit[0]
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
