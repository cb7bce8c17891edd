"""The convergence of a budget's sweeps as a picture."""

from collections.abc import Mapping

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import NullFormatter, NullLocator

from compare.explain.convergence import fitted_orders
from compare.show.style import FAINT, GREY, READING_COLOURS, READING_MARKERS, SMALL

_SECOND = 2  # the order of a beam that first bends half a cell from the clamp


def convergence_picture(found: Mapping[int, Mapping[str, float]]) -> Figure:
    """Draw disagreement against the number of segments, with the fitted and the expected order."""
    figure = Figure(figsize=(5.6, 3.9), layout="constrained")
    ax = figure.subplots()
    n = np.array(list(found), dtype=float)
    for name, order in fitted_orders(found).items():
        errors = np.array([found[segments][name] for segments in found])
        colour, marker = READING_COLOURS[name], READING_MARKERS[name]
        fit = np.exp(np.log(errors).mean()) * (n / np.exp(np.log(n).mean())) ** -order
        ax.plot(n, fit, color=colour, linewidth=1.2)
        ax.plot(n, errors, marker, color=colour, markersize=6, label=f"{name}: order {order:.2f}")
    ax.set_xscale("log")
    ax.set_yscale("log")
    ax.set_xlim(n.min() / 1.25, n.max() * 1.25)
    ax.set_xticks(n, [f"{segments:g}" for segments in n])
    ax.xaxis.set_minor_locator(NullLocator())
    ax.yaxis.set_minor_formatter(NullFormatter())
    ax.grid(axis="y", color=FAINT, alpha=0.35, linewidth=0.6)
    ax.set_xlabel("segments $N$")
    ax.set_ylabel("rms / largest magnitude")
    lowest = min(errors[name] for errors in found.values() for name in errors)
    second = 0.7 * lowest * (n.max() / n) ** _SECOND
    ax.plot(n, second, color=GREY, linestyle="--", linewidth=1, label="second order")
    ax.legend(fontsize=SMALL, frameon=False, loc="upper right")
    return figure
