"""How one sweep looks: in a terminal, in a notebook, as a picture."""

from collections.abc import Sequence
from html import escape
from typing import TYPE_CHECKING

import numpy as np

from analytic.problem.shown import stacked, with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from analytic.problem.sweep_table import SweepTable

_ROWS = 8


def as_text(readings: "SweepTable") -> str:
    beam, running = readings.beam, readings.running_values
    beyond = "".join(f", {name} {value:g}" for name, value in readings.beyond_the_paper.items())
    loads = [name for name in readings.sensed if not name.startswith("foot")]
    sizes = (f"{name} {np.abs(readings.table[name]).max():.4g}" for name in loads)
    lines = [
        f"{type(readings).__name__} ({readings.source}): {len(running)} stations, "
        f"{readings.running} from {running[0]:.6g} to {running[-1]:.6g}",
        f"  beam{' (SI)' if beam.si else ''}: length {beam.length:g}, "
        f"flexural rigidity {beam.flexural_rigidity:g}, radius {beam.radius:g}{beyond}",
        f"  largest magnitudes: {', '.join(sizes)}",
    ]
    lines += [f"  {name}: {said}" for name, said in counts(readings).items()]
    if readings.gaps:
        lines.append(f"  gaps: {readings.gaps} stations without a force or the moment")
    return "\n".join(lines)


def counts(readings: "SweepTable") -> dict[str, str]:
    """How many stations are in which phase, and of which status."""
    return {
        name: ", ".join(
            f"{word} {n}" for word, n in readings.table[name].value_counts(sort=False).items()
        )
        for name in ("phase", "status")
        if name in readings.table
    }


def as_html(readings: "SweepTable") -> str:
    """The same for a notebook, with the first and last rows."""
    rows = readings.table.to_html(max_rows=_ROWS, float_format="{:.6g}".format, border=0)
    return f"<pre>{escape(as_text(readings))}</pre>{rows}"


def new_axes(readings: "SweepTable", figure: "Figure | None" = None) -> "list[Axes]":
    """Axes for what the clamp reads, one above the other."""
    labels = (with_unit(label, readings.beam) for label in readings.panels)
    return stacked(labels, with_unit(readings.running, readings.beam), figure)


def draw(readings: "SweepTable", axes: "Sequence[Axes]") -> None:
    along, trusted = readings.running_values, readings.trusted
    label = readings.source.replace("$", r"\$")
    for ax, names in zip(axes, readings.panels.values(), strict=True):
        for name in names:
            values = readings.values(name)
            said = label if len(names) == 1 else f"{label}: {name}"
            ax.plot(along, values, ".-", markersize=3, linewidth=0.8, label=said)
            if not trusted.all():
                there = along[~trusted], values[~trusted]
                ax.plot(*there, "x", color="tab:red", label="not trusted")
    for ax in axes if len(readings.panels) < len(readings.sensed) - 1 else axes[:1]:
        ax.legend(fontsize="small")
