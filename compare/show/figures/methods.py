"""How far off each method is: a picture of `compare.measure.methods.method_errors`."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from compare.show.page import short
from compare.show.style import BLUE, BODY, GREEN, GREY, INK, ORANGE, PHASE_NAMES, SMALL

_LEVELS = ((BLUE, "o"), (ORANGE, "s"), (GREEN, "^"))  # by level of noise
_LEAST = 1e-6  # L; what is less is drawn there: no sensor sees the difference


def picture(found: pd.DataFrame, title: str) -> Figure:
    """Draw median and worst error of each method, a panel for each phase.

    Parameters
    ----------
    found : pandas.DataFrame
        As `method_errors` has it.
    title : str
        Which sweep.

    Returns
    -------
    Figure
        Methods from top to bottom; each level of noise has a line from the median to the worst.
    """
    methods = list(dict.fromkeys(found["method"]))
    phases = [name for name in ("tip", "tangent") if _count(found, name)]
    figure = Figure(
        figsize=(4.6 * max(len(phases), 1) + 1.2, 0.42 * len(methods) + 1.6), layout="constrained"
    )
    axes = figure.subplots(1, max(len(phases), 1), squeeze=False, sharey=True)[0]
    for ax, phase in zip(axes, phases, strict=False):
        _draw(ax, found[found["phase"] == phase], methods)
        ax.set_title(f"{PHASE_NAMES[phase]}, {_count(found, phase)} contacts", fontsize=SMALL + 1)
    axes[0].set_yticks(range(len(methods)), methods)
    axes[0].invert_yaxis()
    handles, labels = axes[0].get_legend_handles_labels()
    figure.legend(
        handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize=SMALL
    )
    figure.supxlabel(
        "error / $L$: median, and a line to the worst; at the left edge: $10^{-6}$ or less; "
        "right: share answered without noise",
        fontsize=SMALL,
    )
    figure.suptitle(f"Error of the contact found from the clamp: {title}", fontsize=12)
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
        colour = INK if share[method] < 0.99 else GREY
        ax.annotate(
            text,
            (1.005, y),
            xycoords=("axes fraction", "data"),
            va="center",
            fontsize=SMALL - 1,
            color=colour,
        )
        if y % 2:
            ax.axhspan(y - 0.5, y + 0.5, color=BODY, alpha=0.35, linewidth=0)
    ax.set_xscale("log")
    ax.set_xlim(_LEAST / 1.5, 3)
    ax.tick_params(labelsize=SMALL)
