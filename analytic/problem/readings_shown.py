"""How one sweep looks: in a terminal, in a notebook, as a picture."""

from collections.abc import Mapping, Sequence
from html import escape
from typing import TYPE_CHECKING

import pandas as pd

from analytic.problem.arrays import Booleans
from analytic.problem.beam import Beam, Varying
from analytic.problem.columns import CLAMP_READINGS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ROWS = 8
_SI = {"foot_x": "m", "force_x": "N", "force_y": "N", "moment_z": "N m"}


def as_text(
    table: pd.DataFrame, beam: Beam, source: str, gaps: int, beyond: Mapping[str, Varying]
) -> str:
    """A sweep in a few lines: how long, how large, which phases."""
    foot_x = table["foot_x"]
    largest = ", ".join(f"{name} {table[name].abs().max():.4g}" for name in CLAMP_READINGS)
    lines = [
        f"Readings ({source}): {len(table)} stations, "
        f"foot_x from {foot_x.iloc[0]:.6g} to {foot_x.iloc[-1]:.6g}",
        f"  beam{' (SI)' if beam.si else ''}: length {beam.length:g}, "
        f"flexural rigidity {beam.flexural_rigidity:g}, radius {beam.radius:g}"
        + "".join(f", {name} {value:g}" for name, value in beyond.items()),
        f"  largest magnitudes: {largest}",
    ]
    for name in ("phase", "status"):
        if name in table:
            counts = table[name].value_counts(sort=False).items()
            lines.append(f"  {name}: {', '.join(f'{word} {count}' for word, count in counts)}")
    if gaps:
        lines.append(f"  gaps: {gaps} stations without a force or the moment")
    return "\n".join(lines)


def as_html(table: pd.DataFrame, text: str) -> str:
    """The same for a notebook, with the first and last rows."""
    rows = table.to_html(max_rows=_ROWS, float_format="{:.6g}".format, border=0)
    return f"<pre>{escape(text)}</pre>{rows}"


def plot(
    table: pd.DataFrame,
    beam: Beam,
    trusted: Booleans,
    source: str,
    axes: "Sequence[Axes] | None" = None,
) -> "list[Axes]":
    """Force and moment at the clamp over the foot position."""
    if axes is None:
        import matplotlib.pyplot as plt  # a third of a second, and most users draw nothing

        figure, axes = plt.subplots(len(CLAMP_READINGS), sharex=True, layout="constrained")
        axes[-1].set_xlabel(_with_unit("foot_x", beam))
        for ax, name in zip(axes, CLAMP_READINGS, strict=True):
            ax.set_ylabel(_with_unit(name, beam))
        figure.align_ylabels()
    foot_x, label = table["foot_x"], source.replace("$", r"\$")
    for ax, name in zip(axes, CLAMP_READINGS, strict=True):
        ax.plot(foot_x, table[name], ".-", markersize=3, linewidth=0.8, label=label)
        if not trusted.all():
            there = table[name][~trusted]
            ax.plot(foot_x[~trusted], there, "x", color="tab:red", label="not trusted")
    axes[0].legend()
    return list(axes)


def _with_unit(name: str, beam: Beam) -> str:
    return f"{name} [{_SI[name]}]" if beam.si else name
