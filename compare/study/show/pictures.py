"""The pictures of a study, drawn from its table alone."""

from collections.abc import Callable
from functools import partial
from itertools import combinations
from typing import Literal, TypeAlias

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LogNorm, Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator, NullFormatter

from compare.show.style import FAINT, GREY, INK, LINE_STYLES, ORANGE, SERIES, SMALL, label
from compare.study.show import results
from compare.study.show.sentences import pareto_front

Drawings: TypeAlias = dict[str, Callable[[], Figure]]
"""Figures to draw, by what they show."""

_MARKED = 25  # points of a line up to which each is marked
_MAP_FROM = 4  # values an axis from which a map shows more than lines do


def axis_pictures(found: results.StudyResults, question: results.Question) -> Drawings:
    """Draw the number that answers a question over each axis by itself."""
    drawn: Drawings = {}
    for axis in found.plain_axes:
        cut = results.lines(found, axis, question.metric)
        if cut:
            drawn[axis] = partial(_over_axis, found, question, axis, cut)
        if sum(int(line.table["runs"].sum()) for line in cut) == len(found.done):
            break  # every run is in it: over another axis they would be drawn again
    return drawn


def maps(found: results.StudyResults, question: results.Question) -> Drawings:
    """Draw the number that answers a question over each pair of axes with many values."""
    drawn: Drawings = {}
    for beam, done in found.by_beam(question.metric):
        many = [axis for axis in found.plain_axes if done[axis].nunique() >= _MAP_FROM]
        for across, up in combinations(many, 2):
            sampled = {across, up} <= set(found.sampled)
            if not sampled and results.together(done, across, up):
                continue  # zipped: the lines show it
            held, shown = results.plane(found, done, (across, up), question.metric)
            title = ", ".join(filter(None, (beam, f"at {results.words(held)}" if held else "")))
            name = " ".join(filter(None, ("map", across, up, beam)))
            drawn[name] = partial(_map, shown, across, up, question, title)
    return drawn


def timed(found: results.StudyResults) -> pd.DataFrame:
    """The simulated runs whose time and error are known."""
    if results.WORST not in found.done or "seconds_candidate" not in found.done:
        return pd.DataFrame()
    done = found.done.dropna(subset=["seconds_candidate", results.WORST])
    return done[(done["seconds_candidate"] > 0) & (done[results.WORST] > 0)]


def error_against_time(found: results.StudyResults, done: pd.DataFrame) -> Figure:
    """Draw every simulated run by its time and its error, and the front that none of them beats."""
    figure = Figure(figsize=(5.6, 3.9), layout="constrained")
    ax = figure.subplots()
    for colour, (beam, group) in zip(SERIES, found.by_beam(results.WORST), strict=False):
        runs = group[group.index.isin(done.index)]
        ax.plot(runs["seconds_candidate"], runs[results.WORST], "o", color=colour, alpha=0.6,
                markersize=4, label=f"{beam}: {len(runs)} runs")  # fmt: skip
    front = pareto_front(done, "seconds_candidate", results.WORST)
    ax.plot(front["seconds_candidate"], front[results.WORST], color=INK, linewidth=1.2,
            drawstyle="steps-post", label="best error for the time")  # fmt: skip
    ax.set(xscale="log", yscale="log", xlabel="time of the simulated sweep [s]")
    ax.set_ylabel("worst reading's rms\n/ largest magnitude")
    ax.legend(fontsize=SMALL, frameon=False)
    return figure


def _over_axis(
    found: results.StudyResults, question: results.Question, axis: str, cut: list[results.Line]
) -> Figure:
    figure = Figure(figsize=(4.6, 3.5), layout="constrained")
    ax = figure.subplots()
    beams = list(dict.fromkeys(line.beam for line in cut))
    varying = next((key for key in cut[0].held if len({line.held[key] for line in cut}) > 1), None)
    shades = list(dict.fromkeys(line.held[varying] for line in cut)) if varying else [0.0]
    for line in cut:
        shade = shades.index(line.held[varying]) if varying else 0
        beam = beams.index(line.beam)
        # Several beams: a colour each, and another style where colours run out. One: a colour for
        # each value of the other axis.
        colour, style = (beam, shade + beam // len(SERIES)) if len(beams) > 1 else (shade, 0)
        value = f"{line.held[varying]:.4g}" if varying else ""
        name = ", ".join(filter(None, (line.beam.replace("method ", ""), value)))
        shown, table = SERIES[colour % len(SERIES)], _from(line.table, question.least)
        ax.plot(table["value"], table["median"], marker="o" if len(table) <= _MARKED else "",
                markersize=3.5, linewidth=1.4, label=name, color=shown,
                linestyle=LINE_STYLES[style % len(LINE_STYLES)])  # fmt: skip
        if (table["high"] > table["low"]).any():
            ax.fill_between(
                table["value"], table["low"], table["high"], alpha=0.15, linewidth=0, color=shown
            )
    sizes = pd.concat([_from(line.table, question.least)["median"] for line in cut])
    if question.limit is not None:
        ax.axhline(question.limit, color=GREY, linestyle="--", linewidth=1)
    elif _spans_decades(sizes):
        ax.set_yscale("log")
    _dress(ax, found.done[axis], axis, "x")
    ax.set_ylabel(question.label)
    ax.grid(axis="y", color=FAINT, alpha=0.35, linewidth=0.6)
    held = {key: value for key, value in cut[0].held.items() if key != varying}
    if held:
        ax.set_title(f"at {label(results.words(held))}", fontsize=SMALL)
    if len(cut) > 1:
        title = _label(varying) if varying else None
        figure.legend(
            loc="outside lower center", ncols=3, fontsize=SMALL - 1, frameon=False,
            title=title, title_fontsize=SMALL - 1,
        )  # fmt: skip
    return figure


def _from(table: pd.DataFrame, least: float) -> pd.DataFrame:
    """The table of a line, with what is less than anybody can see drawn at that."""
    drawn = ["median", "low", "high"]
    return table.assign(**{name: table[name].clip(lower=least) for name in drawn})


def _map(
    done: pd.DataFrame, across: str, up: str, question: results.Question, title: str
) -> Figure:
    figure = Figure(figsize=(5.4, 4.0), layout="constrained")
    ax = figure.subplots()
    column = question.metric
    table = done[[across, up, column]].abs()
    norm = LogNorm() if _spans_decades(table[column]) else Normalize()
    low, high = table[column].min(), table[column].max()
    limit = question.limit if question.limit is not None else np.inf
    passed = low < limit < high
    drawn: ScalarMappable
    if len(table) >= table[across].nunique() * table[up].nunique():  # a grid, not a sample
        grid = table.pivot_table(values=column, index=up, columns=across, aggfunc="median")
        drawn = ax.pcolormesh(
            grid.columns, grid.index, grid, shading="nearest", norm=norm, cmap="cividis"
        )
        if passed:
            ax.contour(grid.columns, grid.index, grid, levels=[limit], colors=ORANGE)
    else:
        drawn = ax.scatter(
            table[across], table[up], c=table[column], s=14, norm=norm, cmap="cividis"
        )
        if passed and len(table) > 3:
            border = ax.tricontour(table[across], table[up], table[column],
                                   levels=[limit], colors=ORANGE)  # fmt: skip
            border.set_linewidth(2)
    bar = figure.colorbar(drawn, ax=ax, label=question.label.replace("\n", " "))
    if passed:
        bar.ax.axhline(limit, color=ORANGE, linewidth=2)
    _dress(ax, done[across], across, "x")
    _dress(ax, done[up], up, "y")
    ax.set_title(label(title), fontsize=SMALL)
    return figure


def _dress(ax: Axes, values: pd.Series, axis: str, which: Literal["x", "y"]) -> None:
    """Label an axis; logarithmic where its values ask for it, ticks at them where they are few."""
    logarithmic = values.min() > 0 and _spans_decades(values)
    if logarithmic:
        (ax.set_xscale if which == "x" else ax.set_yscale)("log")
    ruler = ax.xaxis if which == "x" else ax.yaxis
    ruler.set_label_text(_label(axis))
    ticks = np.unique(values)
    if not logarithmic:
        ruler.set_major_locator(MaxNLocator(5))
    if len(ticks) <= 6:
        ruler.set_ticks(ticks, [f"{float(f'{tick:.3g}'):g}" for tick in ticks])
        ruler.set_ticks([], minor=True)
    elif logarithmic and ticks[-1] / ticks[0] >= 100:
        ruler.set_minor_formatter(NullFormatter())


def _spans_decades(values: pd.Series) -> bool:
    values = values[values != 0]
    return bool(len(values) and values.min() > 0 and values.max() / values.min() >= 7)


def _label(axis: str) -> str:
    return results.AXES.get(axis, label(axis))
