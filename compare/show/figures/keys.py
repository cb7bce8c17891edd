"""What lines, dots and shades mean: a key below a figure."""

from collections.abc import Sequence
from typing import Any

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from compare.show.style import PHASE_COLOURS, PHASE_NAMES, SMALL


def key_below(figure: Figure, meant: Axes | Sequence[Artist], columns: int) -> None:
    """Say below all axes what is meant by these artists, or by those of one axes.

    A figure that lays itself out makes room for it.
    """
    handles = meant.get_legend_handles_labels()[0] if isinstance(meant, Axes) else meant
    outside = "outside " if figure.get_layout_engine() else ""
    place: Any = f"{outside}lower center"
    figure.legend(handles=handles, loc=place, ncols=columns, fontsize=SMALL, frameon=False)


def phase_handles(*phases: str, **style: Any) -> list[Artist]:  # noqa: ANN401  # matplotlib's
    """A line in the colour of each phase, by default of all."""
    return [
        Line2D([], [], color=PHASE_COLOURS[phase], label=PHASE_NAMES[phase], **style)
        for phase in phases or PHASE_COLOURS
    ]
