"""How far off each method is: a picture of `compare.measure.methods.method_errors`."""

import numpy as np
import pandas as pd
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from compare.show import style
from compare.show.numbers import short

_DARK = -2.2  # decades; more is so dark that words on it are white
_NEARLY_ALL = 0.985
_LEAST = 1e-6  # L; what is less is drawn there: no sensor sees the difference


def picture(found: pd.DataFrame, title: str) -> Figure:
    """Draw each method's median error over noise, or over kinds of readings without noise."""
    over, said = "noise", "noise over each reading's largest magnitude"
    if len(set(found["readings"])) > 1:
        over, said = "readings", "the readings' vibrissa"
        found = found[found["noise"] == found["noise"].min()]
    methods, columns = (list(dict.fromkeys(found[name])) for name in ("method", over))
    phases = [name for name, of in found.groupby("phase", sort=False) if of["contacts"].any()]
    figure = Figure(
        figsize=(1.0 * len(columns) * len(phases) + 3.6, 0.36 * len(methods) + 2.2),
        layout="constrained",
    )
    axes = figure.subplots(1, max(len(phases), 1), squeeze=False, sharey=True)[0]
    colours = colormaps["viridis_r"].with_extremes(bad=style.BODY)
    decades = Normalize(np.log10(_LEAST), 0)
    for ax, phase in zip(axes, phases, strict=False):
        rows = found[found["phase"] == phase]
        medians, shares = (
            rows.pivot_table(index="method", columns=over, values=name, dropna=False)
            .reindex(index=methods, columns=columns)
            .to_numpy(dtype=float)
            for name in ("median", "answered")
        )
        sizes = np.log10(np.maximum(medians, _LEAST))
        ax.imshow(np.ma.masked_invalid(sizes), colours, decades, aspect="auto")
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
        ax.set_xticks(range(len(columns)), columns, rotation=35, ha="right", fontsize=style.SMALL)
        ax.set_title(style.PHASE_NAMES[str(phase)], fontsize=style.SMALL + 1)
    scale = ScalarMappable(decades, colours)
    figure.colorbar(scale, ax=axes, label="median error / $L$, powers of ten", shrink=0.8)
    axes[0].set_yticks(range(len(methods)), methods, fontsize=style.SMALL)
    figure.supxlabel(f"{said}; below a number: share answered", fontsize=style.SMALL - 1)
    figure.suptitle(f"Contact found from the clamp: {title}", fontsize=12)
    return figure
