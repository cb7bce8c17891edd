"""Clamp readings over the foot position: both models above, their difference below."""

from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from analytic import CLAMP_READINGS, reconstruct
from analytic.problem.arrays import Floats
from compare.comparison import Comparison
from compare.show import style
from compare.show.figures.fold import with_fold
from compare.show.figures.keys import key_below
from compare.show.figures.over_foot import (
    LINE,
    dots,
    draw,
    foot,
    foot_label,
    key,
    on_vibrissa,
    reading_label,
    scaled,
    shade_reference,
    unit,
)

_ALONE = 3.0  # points; of dots that lie on no line
_NEAR = 0.03  # of the sweep's length: what is shown on either side of the snap-off
_PANEL = (4.8, 4.0)  # inches
# To measure the texts of each picture would take longer than to draw it.
_ROW = {"left": 0.07, "right": 0.99, "top": 0.94, "bottom": 0.15, "hspace": 0.16, "wspace": 0.25}
_AXES = {"left": 0.155, "right": 0.98, "top": 0.93, "bottom": 0.25, "hspace": 0.2}


def readings(comparison: Comparison) -> Figure:
    """Draw clamp force, moment and reconstructed contact, and differences, side by side."""
    figure = Figure(figsize=(12, 5.4))
    upper, lower = figure.subplots(2, 4, sharex=True, height_ratios=[2.2, 1], gridspec_kw=_ROW)
    for i, name in enumerate(style.SYMBOLS):
        _draw_reading(upper[i], lower[i], comparison, name)
    lower[0].set_ylabel("difference\n(same unit)")
    key_below(figure, key(upper[0]), 4)
    return figure


def around_snap_off(comparison: Comparison, name: str) -> Figure:
    """Draw a reading around the snap-off, of which one sweep at least has one."""
    figure = reading_panel(comparison, name)
    length = comparison.reference.beam.length
    half = _NEAR * float(np.ptp(foot(comparison.reference))) or _NEAR
    places = {
        style.REFERENCE: comparison.snap_off.reference,
        style.CANDIDATE: comparison.snap_off.candidate,
    }
    known = {colour: place / length for colour, place in places.items() if place is not None}
    for ax in figure.axes:
        ax.set_xlim(min(known.values()) - half, max(known.values()) + half)
        ax.xaxis.set_major_locator(MaxNLocator(4))
        for colour, place in known.items():
            ax.axvline(place, color=colour, linestyle=":", linewidth=1.3)
    return figure


def reading_panel(comparison: Comparison, name: str) -> Figure:
    """Draw a reading of both sweeps, and their difference."""
    figure = Figure(figsize=_PANEL)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1], gridspec_kw=_AXES)
    _draw_reading(upper, lower, comparison, name)
    lower.set_ylabel("difference")
    key_below(figure, key(upper), 2)
    return figure


def _draw_reading(upper: Axes, lower: Axes, comparison: Comparison, name: str) -> None:
    """A reading of both sweeps above, their difference below."""
    for ax in (upper, lower):
        shade_reference(ax, comparison)
    reference, candidate = comparison.reference, comparison.candidate
    judged = comparison.judged["reference"]
    curve = with_fold(reference, judged.phase, foot(reference), scaled(reference, judged, name))
    draw(upper, *curve, label=style.label(reference.source), **LINE)
    points = foot(candidate), scaled(candidate, comparison.judged["candidate"], name)
    draw(upper, *points, label=style.label(candidate.source), **dots(comparison))
    upper.set_title(reading_label(reference, name), fontsize=style.LARGE)
    lower.axhline(0, color=style.INK, linewidth=0.8)
    draw(lower, *_difference(comparison, name), **dots(comparison) | {"markersize": _ALONE})
    lower.set_xlabel(foot_label(reference))
    lower.ticklabel_format(axis="y", scilimits=(-2, 2))


def _difference(comparison: Comparison, name: str) -> tuple[Floats, Floats]:
    """Foot positions and candidate less reference, both in units of the beam."""
    table, beam = comparison.alignment.table, comparison.reference.beam
    foot_x = table["foot_x"].to_numpy() / beam.length
    if name in CLAMP_READINGS:
        apart = (table[f"{name}_candidate"] - table[f"{name}_reference"]).to_numpy()
        return foot_x, apart / unit(comparison.reference, name)
    if len(table) < 2:  # no sweep
        return foot_x, np.full(len(table), np.nan)
    found, expected = (
        reconstruct(
            replace(
                comparison.reference,
                table=table.rename(columns={f"{r}_{side}": r for r in CLAMP_READINGS}),
            )
        )
        for side in ("candidate", "reference")
    )
    s, expected_s = (one[name].to_numpy() / beam.length for one in (found, expected))
    return foot_x, on_vibrissa(s) - on_vibrissa(expected_s)
