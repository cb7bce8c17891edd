"""The readings of a rig's passes over the foot position, after calibration."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from compare.read.passes import Pass
from compare.show.figures.keys import key_below
from compare.show.figures.over_foot import draw, foot, reading_label, stacked, unit
from compare.show.style import SERIES, SMALL, label

_MOST = 12  # names in the legend


def picture(passes: Sequence[Pass]) -> Figure:
    """Draw the three readings of each pass."""
    figure, axes = stacked(passes[0].readings)
    for name, ax in axes.items():
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
    key_below(figure, axes["force_x"], 3)
    return figure
