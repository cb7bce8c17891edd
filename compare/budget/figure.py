"""The budget as a picture."""

import numpy as np
from matplotlib.figure import Figure

from analytic.problem.readings import CLAMP_READINGS
from compare.budget.budget import PARTS, Budget

# Okabe and Ito's palette; what is unexplained is black.
_COLOURS = dict(
    zip(
        PARTS,
        ("#0072B2", "#E69F00", "#56B4E9", "#009E73", "#F0E442", "#CC79A7", "#000000"),
        strict=True,
    )
)
_FLOOR = 1e-8  # of the largest magnitude; less has no place on a logarithmic axis


def picture(found: Budget) -> Figure:
    """Size of each part of each reading's disagreement, with its uncertainty."""
    figure = Figure(figsize=(11, 3.6), layout="constrained")
    axes = figure.subplots(1, len(CLAMP_READINGS), sharey=True, sharex=True)
    rows = np.arange(len(PARTS))[::-1]
    for ax, reading in zip(axes, CLAMP_READINGS, strict=True):
        parts = [found.parts[name][reading] for name in PARTS]
        sizes = np.maximum([part.rms for part in parts], _FLOOR)
        whiskers = np.array([part.uncertainty for part in parts])
        ax.barh(
            rows,
            sizes,
            xerr=[np.minimum(whiskers, 0.9 * sizes), whiskers],
            color=[_COLOURS[name] for name in PARTS],
            error_kw={"ecolor": "#666666", "capsize": 2.5},
        )
        total = found.disagreement[reading]
        ax.axvline(total, color="#D55E00", linestyle="--", linewidth=1.2)
        ax.set_title(f"{reading}: {total:.1e} rms in all (dashed)", fontsize=10)
        ax.set_xlabel("rms / largest magnitude")
        ax.set_xscale("log")
        ax.set_xlim(_FLOOR, 3 * max(total, *sizes))
    axes[0].set_yticks(rows, PARTS)
    return figure
