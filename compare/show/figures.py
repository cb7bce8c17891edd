"""The pictures of a comparison, drawn from readings alone."""

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PatchCollection
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from matplotlib.ticker import MaxNLocator

from analytic import CLAMP_READINGS, Readings, deflected_shapes, reconstruct
from analytic.problem.arrays import Floats, Words
from analytic.problem.files import whole_file
from compare.comparison import Comparison

# Okabe and Ito's palette: told apart by every kind of colour vision, and in print.
PHASE_COLOURS = {"free": "#999999", "tip": "#0072B2", "tangent": "#D55E00"}
PHASE_NAMES = {"free": "free", "tip": "A: tip contact", "tangent": "B: tangential contact"}
_REFERENCE, _CANDIDATE = "#000000", "#CC79A7"

READING_SYMBOLS = {
    "force_x": ("$F_{Ax}$", "$EI/L^2$"),
    "force_y": ("$F_{Ay}$", "$EI/L^2$"),
    "moment_z": ("$M_{Az}$", "$EI/L$"),
    "contact_arc_length": ("$s_1$", "$L$"),
}
_WIDTH = 9.0  # of a picture across the page, in inches
_SHAPES = 24  # drawn of each sweep
_BEYOND_TIP = 1.1  # L; as far as a noisy contact is drawn
_NEAR = 0.03  # of the sweep's length: what is shown on either side of the snap-off


def geometry(comparison: Comparison) -> Figure:
    """The object and the deflected vibrissa, coloured by phase, in both models."""
    figure = Figure(layout="constrained")
    axes = figure.subplots(2, 1, sharex=True, sharey=True)
    for ax, readings, which in zip(axes, *_sides(comparison), strict=True):
        phase = comparison.judged[which].phase
        _draw_shapes(ax, readings, phase)
        _draw_object(ax, readings, phase)
        ax.set_title(f"{which}: {readings.source}", loc="left", fontsize=10)
        ax.set_ylabel("$y$ / $L$")
        ax.set_aspect("equal")
        ax.axhline(0, color="#999999", linewidth=0.8, zorder=0)
    foot_x = _foot(comparison.reference)
    whither = "right" if foot_x[-1] > foot_x[0] else "left"
    axes[-1].set_xlabel(f"$x$ / $L$   (the foot moves to the {whither} along $y = 0$)")
    handles = [Line2D([], [], color=PHASE_COLOURS[p], label=PHASE_NAMES[p]) for p in PHASE_COLOURS]
    handles += [
        Line2D([], [], color="#555555", linewidth=2.5, label="object"),
        Line2D([], [], color="k", marker="o", markersize=3, linestyle="", label="reconstructed"),
    ]
    figure.legend(handles=handles, loc="outside lower center", ncols=5, fontsize=9, frameon=False)
    # As high as both axes need, at equal scales, besides their labels and the legend.
    wide, high = (np.ptp(limits) for limits in (axes[0].get_xlim(), axes[0].get_ylim()))
    figure.set_size_inches(_WIDTH, 2 * (_WIDTH - 0.8) * high / wide + 1.5)
    return figure


def readings(comparison: Comparison) -> Figure:
    """Clamp force, moment and reconstructed contact over the foot position, and differences."""
    figure = Figure(figsize=(12, 5.4), layout="constrained")
    upper, lower = figure.subplots(
        2, 4, sharex=True, height_ratios=[2.2, 1], gridspec_kw={"hspace": 0.05}
    )
    for i, name in enumerate(READING_SYMBOLS):
        _draw_reading(upper[i], lower[i], comparison, name)
    lower[0].set_ylabel("difference\n(same unit)")
    handles, labels = _key(upper[0])
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=9, frameon=False)
    return figure


def reading_panels(comparison: Comparison) -> dict[str, Figure]:
    """The same, a picture for each reading."""
    return {name: _panel(comparison, name) for name in READING_SYMBOLS}


def snap_off_panels(comparison: Comparison) -> dict[str, Figure]:
    """The clamp readings around the snap-off, a picture each; none if there is no snap-off."""
    places = [comparison.snap_off.reference, comparison.snap_off.candidate]
    known = [place / comparison.reference.beam.length for place in places if place is not None]
    if not known:
        return {}
    half = _NEAR * float(np.ptp(_foot(comparison.reference)))
    figures = {name: _panel(comparison, name) for name in CLAMP_READINGS}
    for figure in figures.values():
        for ax in figure.axes:
            ax.set_xlim(min(known) - half, max(known) + half)
            ax.xaxis.set_major_locator(MaxNLocator(4))
            for place, colour in zip(places, (_REFERENCE, _CANDIDATE), strict=True):
                if place is not None:
                    where = place / comparison.reference.beam.length
                    ax.axvline(where, color=colour, linestyle=":", linewidth=1.3)
    return figures


def phase_criterion(comparison: Comparison) -> Figure:
    """What decides the phase: criterion (26), zero in Phase B, and the contact, 1 in Phase A."""
    figure = Figure(figsize=(_WIDTH, 5.4), layout="constrained")
    axes = figure.subplots(2, 1, sharex=True)
    for readings, which in zip(*_sides(comparison), strict=True):
        judged, x = comparison.judged[which], _foot(readings)
        style = (
            {"color": _REFERENCE, "linewidth": 1.6} if which == "reference" else _dots(comparison)
        )
        axes[0].plot(x, judged.criterion, label=readings.source, **style)
        axes[1].plot(x, 1 - judged.shortfall, **style)
    for ax in axes:
        shade_phases(ax, *_phases(comparison))
    axes[0].axhline(0, color="#555555", linewidth=0.8, linestyle="--")
    axes[1].axhline(1, color="#555555", linewidth=0.8, linestyle="--")
    axes[0].set_ylabel(r"$(2F_{Ay} - M_{Az}^2)\,/\,2f$  (26)" + "\nzero in Phase B")
    axes[1].set_ylabel("contact $s_1$ / $L$\none in Phase A")
    axes[1].set_xlabel("foot position $x_0$ / $L$   (dotted: transitions found from the clamp)")
    length = comparison.reference.beam.length
    for place in comparison.transitions.values():
        for where, colour in ((place.reference, _REFERENCE), (place.candidate, _CANDIDATE)):
            if where is not None:
                for ax in axes:
                    ax.axvline(where / length, color=colour, linestyle=":", linewidth=1)
    figure.legend(loc="outside lower center", ncols=2, fontsize=9, frameon=False)
    return figure


def reconstruction(readings: Readings, found: pd.DataFrame) -> Figure:
    """The contact points that the clamp readings tell, with their uncertainty if there is one."""
    figure = Figure(figsize=(9, 4.5), layout="constrained")
    ax = figure.subplots()
    _draw_shapes(ax, readings, found["phase"].to_numpy(dtype=str))
    scale = readings.beam.length
    if "contour" in readings.provenance:
        xi, eta = (np.asarray(c) / scale for c in readings.provenance["contour"])
        ax.plot(xi, eta, color="#999999", linewidth=3, label="object", zorder=0)
    x, y = found["contact_x"].to_numpy() / scale, found["contact_y"].to_numpy() / scale
    if "uncertainty" in found:
        radius = found["uncertainty"].to_numpy() / scale
        sure = np.isfinite(radius)
        circles = PatchCollection(
            [Circle((x[i], y[i]), radius[i]) for i in np.flatnonzero(sure)],
            color="#009E73",
            alpha=0.08,
            linewidth=0,
        )
        ax.add_collection(circles)
        ax.plot([], [], "o", color="#009E73", alpha=0.3, markersize=9, label="95 % of cases")
    ax.plot(x, y, "k.", markersize=3.5, label="reconstructed contact")
    unit = "L" if scale == 1 else f"L = {scale:g}"
    ax.set_xlabel(f"$x$ / ({unit})")
    ax.set_ylabel(f"$y$ / ({unit})")
    ax.set_aspect("equal")
    ax.set_ylim(-0.05, 1.15)
    ax.axhline(0, color="#999999", linewidth=0.8)
    ax.legend(fontsize=9, frameon=False, loc="upper center", ncols=3)
    return figure


def shade_phases(ax: Axes, foot_x: Floats, phase: Words) -> None:
    """The phases of a sweep as a background over its foot positions."""
    edges = np.flatnonzero(phase[1:] != phase[:-1])
    begins, ends = np.append(0, edges + 1), np.append(edges, len(phase) - 1)
    for begin, end in zip(begins, ends, strict=True):
        if phase[begin] in ("tip", "tangent"):
            ax.axvspan(
                foot_x[max(begin - 1, 0)],
                foot_x[end],
                color=PHASE_COLOURS[str(phase[begin])],
                alpha=0.10,
                linewidth=0,
            )


def save_figure(figure: Figure, path: Path) -> Path:
    """Write a PNG, whole or not at all."""
    with whole_file(path) as unfinished:
        figure.savefig(unfinished, format="png", dpi=150)
    return path


def _panel(comparison: Comparison, name: str) -> Figure:
    figure = Figure(figsize=(4.8, 4.0), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1])
    _draw_reading(upper, lower, comparison, name)
    lower.set_ylabel("difference")
    figure.align_ylabels()
    handles, labels = _key(upper)
    figure.legend(handles, labels, loc="outside lower center", ncols=2, fontsize=9, frameon=False)
    return figure


def _draw_reading(upper: Axes, lower: Axes, comparison: Comparison, name: str) -> None:
    """A reading of both sweeps above, their difference below."""
    symbol, unit = READING_SYMBOLS[name]
    for ax in (upper, lower):
        shade_phases(ax, *_phases(comparison))
    for one, style in zip(
        (comparison.reference, comparison.candidate),
        ({"color": _REFERENCE, "linewidth": 1.6}, _dots(comparison)),
        strict=True,
    ):
        upper.plot(_foot(one), _reading(one, name), label=one.source, **style)
    upper.set_title(f"{symbol} / ({unit})", fontsize=11)
    lower.axhline(0, color=_REFERENCE, linewidth=0.8)
    lower.plot(*_difference(comparison, name), **_dots(comparison))
    lower.set_xlabel("foot $x_0$ / $L$")
    lower.ticklabel_format(axis="y", scilimits=(-2, 2))


def _key(ax: Axes) -> tuple[list[Artist], list[str]]:
    """What the lines and the shades of a reading's axes mean."""
    handles, labels = ax.get_legend_handles_labels()
    shades: list[Artist] = [
        Line2D([], [], color=PHASE_COLOURS[p], alpha=0.35, linewidth=7) for p in ("tip", "tangent")
    ]
    return [*handles, *shades], [*labels, PHASE_NAMES["tip"], PHASE_NAMES["tangent"]]


def _sides(comparison: Comparison) -> tuple[tuple[Readings, Readings], tuple[str, str]]:
    return (comparison.reference, comparison.candidate), ("reference", "candidate")


def _phases(comparison: Comparison) -> tuple[Floats, Words]:
    """Foot positions and phases of the reference."""
    return _foot(comparison.reference), comparison.judged["reference"].phase


def _dots(comparison: Comparison) -> dict[str, Any]:
    size = 2.2 if len(comparison.candidate.table) > 100 else 4.0
    return {"color": _CANDIDATE, "marker": "o", "markersize": size, "linestyle": ""}


def _foot(readings: Readings) -> np.ndarray:
    return readings.values("foot_x") / readings.beam.length


def _reading(readings: Readings, name: str) -> np.ndarray:
    beam = readings.beam
    if name == "contact_arc_length":
        s = reconstruct(readings)[name].to_numpy(dtype=float) / beam.length
        # Without a load the noise of a rig puts it anywhere; with one, a little beyond the tip.
        return np.where((s > 0) & (s < _BEYOND_TIP), s, np.nan)
    unit = beam.moment_unit if name == "moment_z" else beam.force_unit
    return np.where(readings.trusted, readings.values(name) / unit, np.nan)


def _difference(comparison: Comparison, name: str) -> tuple[np.ndarray, np.ndarray]:
    table, beam = comparison.alignment.table, comparison.reference.beam
    foot_x = table["foot_x"].to_numpy()
    if name in CLAMP_READINGS:
        unit = beam.moment_unit if name == "moment_z" else beam.force_unit
        return foot_x / beam.length, (
            (table[f"{name}_candidate"] - table[f"{name}_reference"]).to_numpy() / unit
        )
    sides = [
        Readings(
            table.rename(columns={f"{r}_{side}": r for r in CLAMP_READINGS})[
                ["foot_x", *CLAMP_READINGS]
            ],
            beam,
        )
        for side in ("candidate", "reference")
    ]
    return foot_x / beam.length, _reading(sides[0], name) - _reading(sides[1], name)


def _draw_shapes(ax: Axes, readings: Readings, phase: Words) -> None:
    x, y = deflected_shapes(readings)
    usable = np.flatnonzero(np.isin(phase, list(PHASE_COLOURS)))
    chosen = usable[np.linspace(0, len(usable) - 1, min(_SHAPES, len(usable))).astype(int)]
    scale = readings.beam.length
    lines = LineCollection(
        [np.column_stack([x[i], y[i]]) / scale for i in chosen],
        colors=[PHASE_COLOURS[str(phase[i])] for i in chosen],
        linewidths=1.1,
    )
    ax.add_collection(lines)
    ax.plot(x[chosen, 0] / scale, y[chosen, 0] / scale, "s", color="#555555", markersize=2.5)
    ax.autoscale_view()


def _draw_object(ax: Axes, readings: Readings, phase: Words) -> None:
    scale = readings.beam.length
    if "contour" in readings.provenance:
        xi, eta = (np.asarray(c) / scale for c in readings.provenance["contour"])
        ax.fill_between(xi, eta, eta.max(), color="#DDDDDD", linewidth=0, zorder=0)
        ax.plot(xi, eta, color="#555555", linewidth=2.5, zorder=1)
    found = reconstruct(readings)[np.isin(phase, ("tip", "tangent"))]
    ax.plot(found["contact_x"] / scale, found["contact_y"] / scale, "k.", markersize=2)
