"""The object and the vibrissa as they stand in space."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from analytic import FittedObject, Readings, deflected_shapes, reconstruct
from analytic.numerics.arrays import Words
from compare.comparison import Comparison
from compare.show import style
from compare.show.figures.over_foot import draw, key_below, on_vibrissa, phase_handles
from compare.show.numbers import quantity

_SHAPES = 24  # drawn of each sweep
_CIRCLES = 2000  # drawn at most
_HIGHEST = 10.0  # inches, if the sweep is much shorter than the vibrissa
_OBJECT: dict[str, Any] = {"color": style.GREY, "linewidth": 2.5}
_CONTACT: dict[str, Any] = {"color": style.INK, "marker": "o", "markersize": 1.5, "linestyle": ""}


def geometry(comparison: Comparison) -> Figure:
    """Draw the object and the deflected vibrissa, coloured by phase, in both models."""
    figure = Figure(layout="constrained")
    axes = figure.subplots(2, 1, sharex=True, sharey=True)
    sides = {"reference": comparison.reference, "candidate": comparison.candidate}
    for ax, (which, readings) in zip(axes, sides.items(), strict=True):
        phase = comparison.judged[which].phase
        _draw_shapes(ax, readings, phase)
        _draw_object(ax, readings, phase)
        title = f"{which}: {style.label(readings.source)}"
        ax.set_title(title, loc="left", fontsize=style.NORMAL)
        ax.set_ylabel("$y$ / $L$")
        ax.axhline(0, color=style.FAINT, linewidth=0.8, zorder=0)
    beam = comparison.reference.beam
    size = f"$L$ = {quantity(beam.length, 'length', beam)}; " if beam.si else ""
    axes[-1].set_xlabel(f"$x$ / $L$   ({size}{_way(comparison.reference)})")
    handles = [
        *phase_handles(),
        Line2D([], [], **_OBJECT, label="object"),
        Line2D([], [], **_CONTACT | {"markersize": 3}, label="reconstructed contact"),
    ]
    key_below(figure, handles, 5)
    at_equal_scales(figure, axes, style.PAGE_WIDTH)
    return figure


def _way(readings: Readings) -> str:
    """How the clamp goes, in words."""
    direction = "right" if readings.runs_right else "left"
    return {
        "foot_x": f"the foot moves to the {direction} along $y = 0$",
        "clamp_angle": f"the foot stands, its clamp turns to the {direction}",
        "travel": f"foot and clamp move to the {direction}",
    }[readings.running]


def reconstruction(
    readings: Readings, found: pd.DataFrame, fitted: FittedObject | None = None
) -> Figure:
    """Draw the contact points that the clamp readings show, with their uncertainty if known.

    Those of other passes may follow; the vibrissa is drawn of the readings alone.
    """
    figure = Figure(layout="constrained")
    ax = figure.subplots()
    _draw_shapes(ax, readings, found["phase"].to_numpy(dtype=str)[: len(readings.table)])
    scale = readings.beam.length
    for xi, eta in (contour / scale for contour in readings.contours):
        ax.plot(xi, eta, color=style.FAINT, linewidth=3, label="object", zorder=0)
    there = np.isfinite(found["contact_x"].to_numpy())
    if "contact_arc_length" in found:  # not every method knows it
        there &= np.isfinite(on_vibrissa(found["contact_arc_length"].to_numpy() / scale))
    x, y = (np.where(there, found[name] / scale, np.nan) for name in ("contact_x", "contact_y"))
    if "uncertainty" in found:
        radius = found["uncertainty"].to_numpy() / scale
        known = np.flatnonzero(there & np.isfinite(radius))
        shown = known[:: len(known) // _CIRCLES + 1]
        circles = [Circle((x[i], y[i]), radius[i]) for i in shown]
        green = PatchCollection(circles, color=style.GREEN, alpha=0.08, linewidth=0)
        ax.add_collection(green)
        ax.plot([], [], "o", color=style.GREEN, alpha=0.3, markersize=9, label="95 % of cases")
    draw(ax, x, y, **_CONTACT | {"markersize": 2.5}, label="reconstructed contact")
    if fitted is not None:
        angle, x, y, half = (np.asarray(values) for values in fitted.band.values())
        across, up = half * np.sin(angle), half * np.cos(angle)
        edges = np.column_stack([np.append(x + across, (x - across)[::-1]),
                                 np.append(y - up, (y + up)[::-1])])  # fmt: skip
        ax.fill(*(edges / scale).T, color=style.CANDIDATE, alpha=0.35, linewidth=0, zorder=3)
        label = f"{fitted.family} and its 95 % band"
        ax.plot(x / scale, y / scale, color=style.CANDIDATE, linewidth=1.2, label=label, zorder=4)
    if not there.any():
        ax.text(0.5, 0.5, "no contact found", transform=ax.transAxes, ha="center")
    beam = readings.beam
    own = "" if beam.si else " of the readings' unit"
    ax.set_xlabel(f"$x$ / $L$   ($L$ = {quantity(scale, 'length', beam)}{own})")
    ax.set_ylabel("$y$ / $L$")
    ax.axhline(0, color=style.FAINT, linewidth=0.8)
    key_below(figure, phase_handles() + ax.get_legend_handles_labels()[0], 3)
    at_equal_scales(figure, [ax], style.PAGE_WIDTH)
    return figure


def at_equal_scales(figure: Figure, axes: Sequence[Axes], width: float) -> None:
    """Make a figure as high as its axes need, one above the other, at equal scales."""
    wide, high = (np.ptp(limits) for limits in (axes[0].get_xlim(), axes[0].get_ylim()))
    for ax in axes:
        ax.set_aspect("equal")
    around = len(axes) * 0.3 + 0.9  # titles, labels and the legend
    height = len(axes) * (width - 0.8) * high / wide + around
    figure.set_size_inches(width, min(height, _HIGHEST))


def _draw_shapes(ax: Axes, readings: Readings, phase: Words) -> None:
    usable = np.flatnonzero(np.isin(phase, list(style.PHASE_COLOURS)))
    chosen = usable[np.linspace(0, len(usable) - 1, min(_SHAPES, len(usable))).astype(int)]
    if not chosen.size:
        return
    # A sweep has two stations at least.
    picked = replace(readings, table=readings.table.iloc[np.append(chosen, chosen[-1])])
    x, y = (path[:-1] / readings.beam.length for path in deflected_shapes(picked))
    colours = [style.PHASE_COLOURS[str(phase[i])] for i in chosen]
    lines = list(np.stack([x, y], axis=-1))
    ax.add_collection(LineCollection(lines, colors=colours, linewidths=1.1))
    ax.plot(x[:, 0], y[:, 0], "s", color=style.GREY, markersize=2.5)
    ax.autoscale_view()


def _draw_object(ax: Axes, readings: Readings, phase: Words) -> None:
    scale = readings.beam.length
    for xi, eta in (contour / scale for contour in readings.contours):
        ax.fill_between(xi, eta, eta.max(), color=style.BODY, linewidth=0, zorder=0)
        ax.plot(xi, eta, **_OBJECT, zorder=1)
    found = reconstruct(readings)[np.isin(phase, ("tip", "tangent"))]
    s, x, y = found[["contact_arc_length", "contact_x", "contact_y"]].to_numpy().T / scale
    there = np.isfinite(on_vibrissa(s))
    draw(ax, x[there], y[there], **_CONTACT)
