"""How far off each method is: a picture of `compare.measure.methods.method_errors`."""

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from compare.show import style
from compare.show.figures.keys import key_below
from compare.show.numbers import short

_LEVELS = ((style.BLUE, "o"), (style.ORANGE, "s"), (style.GREEN, "^"))  # by level of noise
_DARK = -2.2  # decades; more is so dark that words on it are white
_NEARLY_ALL = 0.985
_LEAST = 1e-6  # L; what is less is drawn there: no sensor sees the difference


def picture(found: pd.DataFrame, title: str) -> Figure:
    """Draw median and worst error of each method, a panel for each phase."""
    methods = list(dict.fromkeys(found["method"]))
    phases = [name for name in ("tip", "tangent") if _count(found, name)]
    figure = Figure(
        figsize=(4.6 * max(len(phases), 1) + 1.2, 0.42 * len(methods) + 1.6), layout="constrained"
    )
    axes = figure.subplots(1, max(len(phases), 1), squeeze=False, sharey=True)[0]
    for ax, phase in zip(axes, phases, strict=False):
        _draw(ax, found[found["phase"] == phase], methods)
        ax.set_title(
            f"{style.PHASE_NAMES[phase]}, {_count(found, phase)} contacts",
            fontsize=style.SMALL + 1,
        )
    axes[0].set_yticks(range(len(methods)), methods)
    axes[0].invert_yaxis()
    key_below(figure, axes[0], 3)
    figure.supxlabel(
        "error / $L$: median, and a line to the worst; at the left edge: $10^{-6}$ or less; "
        "right: share answered without noise",
        fontsize=style.SMALL,
    )
    figure.suptitle(f"Error of the contact found from the clamp: {title}", fontsize=12)
    return figure


def side_by_side(found: pd.DataFrame, title: str) -> Figure:
    """Draw how each method fares on readings of different vibrissae, without noise."""
    found = found[found["noise"] == found["noise"].min()]
    methods, kinds = (list(dict.fromkeys(found[name])) for name in ("method", "readings"))
    phases = [name for name in ("tip", "tangent") if _count(found, name)]
    figure = Figure(
        figsize=(1.0 * len(kinds) * len(phases) + 3.6, 0.36 * len(methods) + 2.2),
        layout="constrained",
    )
    axes = figure.subplots(1, max(len(phases), 1), squeeze=False, sharey=True)[0]
    colours = colormaps["viridis_r"].with_extremes(bad=style.BODY)
    for ax, phase in zip(axes, phases, strict=False):
        rows = found[found["phase"] == phase]
        medians, shares = (
            rows.pivot_table(index="method", columns="readings", values=name, dropna=False)
            .reindex(index=methods, columns=kinds)
            .to_numpy(dtype=float)
            for name in ("median", "answered")
        )
        sizes = np.log10(np.maximum(medians, _LEAST))
        image = ax.imshow(
            np.ma.masked_invalid(sizes), colours, aspect="auto", vmin=np.log10(_LEAST), vmax=0
        )
        for (i, j), size in np.ndenumerate(sizes):
            share = shares[i, j]
            if np.isnan(share):  # not asked
                continue
            text = "none" if np.isnan(size) else short(10**size) if size > -6 else "<1e-6"
            text += "" if share > _NEARLY_ALL or np.isnan(size) else f"\n{share:.0%}"
            ax.text(
                j, i, text, ha="center", va="center", fontsize=style.SMALL - 2.5, linespacing=0.9,
                color=style.PAPER if size > _DARK else style.INK,
            )  # fmt: skip
        ax.set_xticks(range(len(kinds)), kinds, rotation=35, ha="right", fontsize=style.SMALL)
        ax.set_title(style.PHASE_NAMES[phase], fontsize=style.SMALL + 1)
    axes[0].set_yticks(range(len(methods)), methods, fontsize=style.SMALL)
    bar = figure.colorbar(image, ax=axes, label="median error / $L$", shrink=0.8)
    bar.set_ticks(
        range(-6, 1), labels=["$10^{-6}$ or less", *(f"$10^{{{n}}}$" for n in range(-5, 1))]
    )
    figure.supxlabel(
        "the readings' vibrissa; all methods take it for straight, in a rigid clamp, frictionless. "
        "Below a number: share answered, if not all",
        fontsize=style.SMALL - 1,
    )
    figure.suptitle(f"What each method survives: {title}, no noise", fontsize=12)
    return figure


def _count(found: pd.DataFrame, phase: str) -> int:
    return int(found.loc[found["phase"] == phase, "contacts"].max())


def _draw(ax: Axes, found: pd.DataFrame, methods: list[str]) -> None:
    levels = sorted(found["noise"].unique())
    for i, level in enumerate(levels):
        colour, marker = _LEVELS[i % len(_LEVELS)]
        rows = found[found["noise"] == level].set_index("method").loc[methods]
        height = np.arange(len(methods)) + 0.24 * (i - (len(levels) - 1) / 2)
        median, worst = (np.maximum(rows[n].to_numpy(), _LEAST) for n in ("median", "worst"))
        ax.hlines(height, median, worst, color=colour, linewidth=1.4)
        name = f"noise {short(level)}" if level else "no noise"
        ax.plot(median, height, marker, color=colour, markersize=4.5, label=f"median, {name}")
    share = found[found["noise"] == levels[0]].set_index("method")["answered"]
    for y, method in enumerate(methods):
        text = "no answer" if share[method] == 0 else f"{share[method]:.0%}"
        colour = style.INK if share[method] < 0.99 else style.GREY
        ax.annotate(
            text,
            (1.005, y),
            xycoords=("axes fraction", "data"),
            va="center",
            fontsize=style.SMALL - 1,
            color=colour,
        )
        if y % 2:
            ax.axhspan(y - 0.5, y + 0.5, color=style.BODY, alpha=0.35, linewidth=0)
    ax.set_xscale("log")
    ax.set_xlim(_LEAST / 1.5, 3)
    ax.tick_params(labelsize=style.SMALL)
