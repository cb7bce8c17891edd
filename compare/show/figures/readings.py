"""Readings over the foot position: of both models, with what they say of phases; of passes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from analytic import CLAMP_READINGS, reconstruct
from analytic.numerics.arrays import Floats
from compare.comparison import Comparison
from compare.read.passes import Pass
from compare.show import style
from compare.show.figures import over_foot as over
from compare.validate.validation import Validation

_COLOURS = {"reference": style.REFERENCE, "candidate": style.CANDIDATE}
_ALONE = 3.0  # points; of dots that lie on no line
_NEAR = 0.03  # of the sweep's length: what is shown on either side of the snap-off
_EXPANDED = 2  # standard uncertainties, at one station of one reading
_MOST = 12  # names in a legend
_PANEL = (4.8, 4.0)  # inches
# To measure the texts of each picture would take longer than to draw it.
_ROW = {"left": 0.07, "right": 0.99, "top": 0.94, "bottom": 0.15, "hspace": 0.16, "wspace": 0.25}
_CRITERION = {"left": 0.107, "right": 0.99, "top": 0.95, "bottom": 0.15, "hspace": 0.08}
_AXES = {"left": 0.155, "right": 0.98, "top": 0.93, "bottom": 0.25, "hspace": 0.2}


def readings(comparison: Comparison) -> Figure:
    """Draw clamp force, moment and reconstructed contact, and differences, side by side."""
    figure = Figure(figsize=(12, 5.4))
    upper, lower = figure.subplots(2, 4, sharex=True, height_ratios=[2.2, 1], gridspec_kw=_ROW)
    for i, name in enumerate(style.SYMBOLS):
        _draw_reading(upper[i], lower[i], comparison, name)
    lower[0].set_ylabel("difference\n(same unit)")
    over.key_below(figure, over.key(upper[0]), 4)
    return figure


def around_snap_off(comparison: Comparison, name: str) -> Figure:
    """Draw a reading around the snap-off, of which one sweep at least has one."""
    figure = reading_panel(comparison, name)
    size, _ = comparison.reference.running_unit
    half = _NEAR * float(np.ptp(over.foot(comparison.reference))) or _NEAR
    places = ((colour, getattr(comparison.snap_off, side)) for side, colour in _COLOURS.items())
    known = {colour: place / size for colour, place in places if place is not None}
    for ax in figure.axes:
        ax.set_xlim(min(known.values()) - half, max(known.values()) + half)
        ax.xaxis.set_major_locator(MaxNLocator(4))
        for colour, place in known.items():
            ax.axvline(place, color=colour, linestyle=":", linewidth=1.3)
    return figure


def reading_panel(comparison: Comparison, name: str) -> Figure:
    figure = Figure(figsize=_PANEL)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=[2.2, 1], gridspec_kw=_AXES)
    _draw_reading(upper, lower, comparison, name)
    lower.set_ylabel("difference")
    over.key_below(figure, over.key(upper), 2)
    return figure


def _draw_reading(upper: Axes, lower: Axes, comparison: Comparison, name: str) -> None:
    """A reading of both sweeps above, their difference below."""
    for ax in (upper, lower):
        over.shade_reference(ax, comparison)
    reference, candidate = comparison.reference, comparison.candidate
    judged = comparison.judged["reference"]
    curve = over.with_fold(
        reference, judged.phase, over.foot(reference), over.scaled(reference, judged, name)
    )
    over.draw(upper, *curve, label=style.label(reference.source), **over.LINE)
    points = over.foot(candidate), over.scaled(candidate, comparison.judged["candidate"], name)
    over.draw(upper, *points, label=style.label(candidate.source), **over.dots(comparison))
    upper.set_title(over.reading_label(reference, name), fontsize=style.LARGE)
    lower.axhline(0, color=style.INK, linewidth=0.8)
    if comparison.alignment.table.empty:
        lower.set_yticks([0.0])  # else a scale of 1e-17
    over.draw(
        lower, *_difference(comparison, name), **over.dots(comparison) | {"markersize": _ALONE}
    )
    lower.set_xlabel(over.foot_label(reference))
    lower.ticklabel_format(axis="y", scilimits=(-2, 2))


def _difference(comparison: Comparison, name: str) -> tuple[Floats, Floats]:
    """Places along the sweep and candidate less reference, both in units of the beam."""
    table, beam = comparison.alignment.table, comparison.reference.beam
    at = table["at"].to_numpy() / comparison.reference.running_unit[0]
    if name in CLAMP_READINGS:
        apart = (table[f"{name}_candidate"] - table[f"{name}_reference"]).to_numpy()
        return at, apart / over.unit(comparison.reference, name)
    if len(table) < 2:  # no sweep
        return at, np.full(len(table), np.nan)
    stations = comparison.candidate.table.iloc[table["station"]].reset_index(drop=True)
    found = []
    for side in ("candidate", "reference"):
        felt = stations.assign(**{r: table[f"{r}_{side}"] for r in CLAMP_READINGS})
        contacts = reconstruct(replace(comparison.reference, table=felt))
        found.append(over.on_vibrissa(contacts[name].to_numpy() / beam.length))
    return at, found[0] - found[1]


def phase_criterion(comparison: Comparison) -> Figure:
    """Draw criterion (26) of the paper, zero in Phase B, and the contact, at the tip in Phase A."""
    figure = Figure(figsize=(style.PAGE_WIDTH, 5.4))
    axes = figure.subplots(2, 1, sharex=True, gridspec_kw=_CRITERION)
    for which, marks in (("reference", over.LINE), ("candidate", over.dots(comparison))):
        judged = comparison.judged[which]
        x, source = over.foot(judged.readings), judged.readings.source
        over.draw(axes[0], x, judged.criterion, label=style.label(source), **marks)
        over.draw(axes[1], x, over.on_vibrissa(1 - judged.shortfall), **marks)
    for ax, expected in zip(axes, (0, 1), strict=True):
        over.shade_reference(ax, comparison)
        ax.axhline(expected, color=style.GREY, linewidth=0.8, linestyle="--")
    axes[0].set_ylabel(r"(2 force_y - moment_z$^2$) / $2f$" + "\nzero in Phase B")
    axes[0].ticklabel_format(axis="y", scilimits=(-2, 2))
    axes[1].set_ylabel("contact $s_1$ / $L$\none in Phase A")
    axes[1].set_xlabel(
        f"{over.foot_label(comparison.reference)}   (dotted: transitions found from the clamp)"
    )
    size, _ = comparison.reference.running_unit
    for place in comparison.transitions.values():
        for side, colour in _COLOURS.items():
            where = getattr(place, side)
            for ax in () if where is None else axes:
                ax.axvline(where / size, color=colour, linestyle=":", linewidth=1)
    over.key_below(figure, axes[0], 2)
    return figure


def validation_picture(comparison: Comparison, found: Validation) -> Figure:
    """Draw E = S - D of each reading within its expanded uncertainty."""
    figure, axes = over.stacked(comparison.reference)
    length = comparison.reference.beam.length
    for name, ax in axes.items():
        rows = found.table[found.table["reading"] == name].sort_values("foot_x")
        x = rows["foot_x"].to_numpy() / length
        over.shade_reference(ax, comparison)
        for part, colour, what in (
            ("u_val", style.SKY, r"$\pm 2\,u_\mathrm{val}$"),
            ("u_data", style.GREY, r"$\pm 2\,u_D$, noise alone"),
        ):
            wide = _EXPANDED * rows[part].to_numpy()
            ax.fill_between(x, -wide, wide, color=colour, alpha=0.45, linewidth=0, label=what)
        marks = {"color": style.INK, "marker": "o", "markersize": 2.5, "linestyle": ""}
        over.draw(ax, x, rows["error"].to_numpy(), label="$E = S - D$", **marks)
        ax.axhline(0, color=style.BLUE, linewidth=0.8)
        one = found.by_reading[name]
        said = "resolved" if one.resolved else "not resolved"
        ax.set_title(
            f"{style.SYMBOLS[name]}: rms {one.error:.1e}, {said} "
            f"(limit {one.limit:.1e} = {one.coverage:.2f} $u_\\mathrm{{val}}$)",
            fontsize=style.SMALL + 1,
        )
        ax.set_ylabel("of the largest magnitude", fontsize=style.SMALL)
    over.key_below(figure, axes["force_x"], 4)
    return figure


def passes_picture(passes: Sequence[Pass]) -> Figure:
    figure, axes = over.stacked(passes[0].readings)
    for name, ax in axes.items():
        for i, one in enumerate(passes):
            # The first is dark, the last light: their order is seen, and none has another's colour.
            colour = colormaps["viridis"](i / len(passes))
            look = {"color": colour, "linestyle": "", "alpha": 0.5}
            marker = "." if one.direction == "left" else "x"
            values = one.readings.values(name) / over.unit(one.readings, name)
            said = style.label(f"{one.name}, to the {one.direction}") if i < _MOST else "_"
            of_foot = over.foot(one.readings)
            over.draw(ax, of_foot, values, label=said, marker=marker, markersize=2.5, **look)
        ax.set_ylabel(over.reading_label(passes[0].readings, name), fontsize=style.SMALL)
    over.key_below(figure, axes["force_x"], 3)
    return figure


def pass_picture(one: Pass) -> Figure:
    """Draw what was read of a pass, what was cut or taken off, and what is kept."""
    figure, axes = over.stacked(one.readings)
    foot_x = over.foot(one.readings)
    cut = ~one.readings.trusted
    for i, (name, ax) in enumerate(axes.items()):
        size = over.unit(one.readings, name)
        small = {"linestyle": "", "marker": ".", "markersize": 3}
        over.draw(ax, foot_x, one.raw[i] / size, **small, color=style.GREY, label="read")
        over.draw(ax, foot_x, one.taken[i] / size, color=style.CANDIDATE, label="zero, taken off")
        kept = one.readings.values(name) / size
        over.draw(ax, foot_x, kept, **small, color=style.REFERENCE, label="kept")
        everywhere = ax.get_xaxis_transform()
        ax.vlines(
            foot_x[cut], 0, 1, style.CANDIDATE, linewidth=0.5, alpha=0.4, transform=everywhere
        )
        ax.fill_between(
            foot_x, 0, 1, where=one.free, transform=everywhere, color=style.GREY, alpha=0.15
        )
        ax.set_ylabel(over.reading_label(one.readings, name), fontsize=style.SMALL)
    cuts = Line2D([], [], color=style.CANDIDATE, linewidth=0.5, label=f"cut: {cut.sum()} rows")
    free = Patch(color=style.GREY, alpha=0.15, label="called free")
    handles = axes["force_x"].get_legend_handles_labels()[0]
    over.key_below(figure, [*handles, cuts, free], 3)
    axes["force_x"].set_title(style.label(f"{one.name}, to the {one.direction}"), loc="left")
    return figure
