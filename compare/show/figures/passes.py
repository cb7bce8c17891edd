"""The readings of a rig's passes over the foot position, after calibration."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from analytic import CLAMP_READINGS
from compare.read.passes import Pass
from compare.show.figures.keys import key_below
from compare.show.figures.over_foot import foot, foot_label, reading_label, unit
from compare.show.figures.thinning import draw
from compare.show.style import PAGE_WIDTH, SERIES, SMALL, label

_MOST = 12  # names in the legend


def picture(passes: Sequence[Pass]) -> Figure:
    """Draw the three readings of each pass."""
    figure = Figure(figsize=(PAGE_WIDTH, 7.0), layout="constrained")
    axes = figure.subplots(len(CLAMP_READINGS), 1, sharex=True)
    for ax, name in zip(axes, CLAMP_READINGS, strict=True):
        for i, one in enumerate(passes):
            style = {
                "marker": "." if one.direction == "left" else "x",
                "color": SERIES[i % len(SERIES)],
                "linestyle": "",
                "markersize": 3.5,
            }
            values = one.readings.values(name) / unit(one.readings, name)
            said = label(f"{one.name}, to the {one.direction}") if i < _MOST else "_"
            draw(ax, foot(one.readings), values, label=said, **style)
        ax.set_ylabel(reading_label(passes[0].readings, name), fontsize=SMALL)
        ax.tick_params(labelsize=SMALL)
    axes[-1].set_xlabel(foot_label(passes[0].readings))
    key_below(figure, axes[0], 3)
    return figure
