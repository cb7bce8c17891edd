"""The pictures of a study, drawn from its table alone."""

from collections.abc import Iterator
from itertools import combinations
from typing import Literal

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from analytic import CLAMP_READINGS
from compare.show.style import GREY, PHASE_COLOURS, SERIES, SYMBOLS
from compare.study.grid.study import BEAM
from compare.study.show import tables
from compare.study.show.tables import WORST, StudyResults, curve, pareto_front

_AXES = {
    "mujoco.segments": "segments $N$",
    "mujoco.contour_points": "contour points of the mesh",
    "mujoco.contact_stiffness": "contact stiffness / ($EI/L^3$)",
    "sweep.stations": "stations of the sweep",
    "beam.radius": "radius of the vibrissa [length]",
    "noise.relative": "noise, of each reading's largest magnitude",
    "profile.a": "$a$ of the object [1/length]",
    "profile.c": "$c$ of the object [length]",
}
PANELS: dict[str, dict[str, str]] = {
    "disagreement, rms\n(of the largest magnitude)": {
        f"disagreement_{name}_rms": SYMBOLS[name] for name in CLAMP_READINGS
    },
    "shift of the snap-off [length]": {"snap_off_difference": ""},
    "reconstruction error / $L$": {
        "reconstruction_rms": "rms",
        "reconstruction_max": "largest",
    },
    "least contact length / $L$": {"contact_length_minimum": ""},
}
"""What is drawn over an axis: a panel's label, its columns and what they are called."""


def panels(found: StudyResults) -> dict[str, dict[str, str]]:
    """The panels that this study has numbers for; those that are zero throughout have none."""
    there = {
        label: {column: name for column, name in columns.items() if _varies(found.done, column)}
        for label, columns in PANELS.items()
    }
    return {label: columns for label, columns in there.items() if columns}


def axis_curves(found: StudyResults) -> Iterator[tuple[str, Figure]]:
    """Each axis by itself: medians, and bands over all that varies besides."""
    shown = panels(found)
    for axis in found.plain_axes if shown else ():
        figure = Figure(figsize=(1 + 3.6 * len(shown), 3.6), layout="constrained")
        for ax, (label, columns) in zip(
            np.atleast_1d(figure.subplots(1, len(shown))), shown.items(), strict=True
        ):
            for colour, (column, name) in zip(SERIES, columns.items(), strict=False):
                line = curve(found, axis, column)
                style = {"color": colour, "linewidth": 1.5, "marker": "o", "markersize": 3.5}
                ax.plot(line[axis], line["median"], label=name, **style)
                if (line["high"] > line["low"]).any():
                    ax.fill_between(
                        line[axis], line["low"], line["high"], color=colour, alpha=0.15, linewidth=0
                    )
            _place(ax, found.done[axis], "x")
            if column == "contact_length_minimum":
                ax.axhline(1, color=GREY, linestyle="--", linewidth=1, label="Phase B below")
            elif _spans_decades(pd.concat([found.done[c].abs() for c in columns])):
                ax.set_yscale("log")
            ax.set_xlabel(_label(axis))
            ax.set_ylabel(label)
            if ax.get_legend_handles_labels()[0] and len(ax.lines) > 1:
                ax.legend(fontsize=8, framealpha=0.85)
        yield f"curves-{axis}", figure


def heat_maps(found: StudyResults) -> Iterator[tuple[str, Figure]]:
    """Each pair of axes: the median of what lies at a place, as a colour."""
    shown = [
        (label.replace("\n", " "), next(iter(columns)) if len(columns) < 3 else WORST)
        for label, columns in panels(found).items()
    ]
    for across, up in combinations(found.plain_axes, 2) if shown else ():
        if tables.together(found.done, across, up) and tables.together(found.done, up, across):
            continue  # zipped or each sampled: see the curves
        figure = Figure(figsize=(1 + 4.4 * len(shown), 3.8), layout="constrained")
        for ax, (label, column) in zip(
            np.atleast_1d(figure.subplots(1, len(shown))), shown, strict=True
        ):
            _map(ax, found.done, across, up, column)
            ax.set_title(label if column != WORST else "worst reading's " + label, fontsize=9)
            ax.set_xlabel(_label(across))
            ax.set_ylabel(_label(up))
            _place(ax, found.done[across], "x")
            _place(ax, found.done[up], "y")
        yield f"map-{across}-{up}", figure


def error_against_time(found: StudyResults) -> Iterator[tuple[str, Figure]]:
    """Every simulated run by its time and its error, and the front that none of them beats."""
    done = found.done
    if WORST not in done or not _varies(done, "seconds_candidate"):
        return
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    ax = figure.subplots()
    for colour, (beam, group) in zip(SERIES, done.groupby(BEAM), strict=False):
        ax.plot(group["seconds_candidate"], group[WORST], "o", color=colour, alpha=0.6,
                markersize=4, label=f"{beam}: {len(group)} runs")  # fmt: skip
    front = pareto_front(done, "seconds_candidate", WORST)
    ax.plot(front["seconds_candidate"], front[WORST], color="k", linewidth=1.2,
            drawstyle="steps-post", label="best error for the time")  # fmt: skip
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlabel("time of the simulated sweep [s]")
    ax.set_ylabel("worst reading's disagreement, rms\n(of its largest magnitude)")
    ax.legend(fontsize=8, frameon=False)
    yield "error-against-time", figure


def _map(ax: Axes, done: pd.DataFrame, across: str, up: str, column: str) -> None:
    table = done[[across, up, column]].dropna().abs()
    norm = LogNorm() if _spans_decades(table[column]) else Normalize()
    drawn: ScalarMappable
    if len(table) >= table[across].nunique() * table[up].nunique():  # a grid, not a sample
        grid = table.pivot_table(values=column, index=up, columns=across, aggfunc="median")
        drawn = ax.pcolormesh(
            grid.columns, grid.index, grid, shading="nearest", norm=norm, cmap="cividis"
        )
        if column == "contact_length_minimum" and grid.min().min() < 1 < grid.max().max():
            ax.contour(grid.columns, grid.index, grid, levels=[1], colors=PHASE_COLOURS["tangent"])
    else:
        drawn = ax.scatter(
            table[across], table[up], c=table[column], s=12, norm=norm, cmap="cividis"
        )
        if column == "contact_length_minimum" and table[column].min() < 1 < table[column].max():
            lines = ax.tricontour(table[across], table[up], table[column], levels=[1],
                                  colors=PHASE_COLOURS["tangent"])  # fmt: skip
            lines.set_linewidth(2)
    bar = ax.figure.colorbar(drawn, ax=ax)
    if column == "contact_length_minimum":
        bar.ax.axhline(1, color=PHASE_COLOURS["tangent"], linewidth=2)


def _place(ax: Axes, values: pd.Series, which: Literal["x", "y"]) -> None:
    """Logarithmic where a parameter asks for it; ticks at its values where they are few."""
    logarithmic = values.min() > 0 and _spans_decades(values)
    if logarithmic:
        (ax.set_xscale if which == "x" else ax.set_yscale)("log")
    place = ax.xaxis if which == "x" else ax.yaxis
    ticks = np.unique(values)
    if not logarithmic:
        place.set_major_locator(MaxNLocator(5))
    if len(ticks) <= 6:
        place.set_ticks(ticks, [f"{tick:.4g}" for tick in ticks])
        place.set_ticks([], minor=True)


def _spans_decades(values: pd.Series) -> bool:
    values = values[values != 0]
    return bool(len(values) and values.min() > 0 and values.max() / values.min() >= 7)


def _varies(done: pd.DataFrame, column: str) -> bool:
    return column in done and bool((done[column].fillna(0) != 0).any())


def _label(axis: str) -> str:
    return _AXES.get(axis, axis)
