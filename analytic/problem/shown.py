"""What a value shows of itself: a line in a terminal, tiles and a picture in a notebook."""

from base64 import b64encode
from collections.abc import Iterable, Mapping
from dataclasses import replace
from html import escape
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from analytic.problem.beam import Beam, Unloaded
from analytic.problem.clamp_path import Pose

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_TILES = "display:flex;flex-wrap:wrap;gap:6px;margin:4px 0"
_TILE = "border:1px solid #8888;border-radius:6px;padding:2px 10px"
_WIDTH, _HEIGHT, _DPI = 6.4, 3.8, 110  # inches; dots an inch
_SI = {"foot": "m", "travel": "m", "force": "N", "moment": "N m", "clamp_angle": "rad"}


class Shown:
    """A value that says what it comes to, and can be drawn."""

    def _tiles(self) -> Mapping[str, object]:
        """What it comes to, by name, the most important first."""
        raise NotImplementedError

    def _draw(self, figure: "Figure") -> None:
        raise NotImplementedError

    def _below(self) -> str:
        """What a notebook shows below the picture, as HTML."""
        return ""

    def __repr__(self) -> str:
        said = ", ".join(f"{name}: {value}" for name, value in self._tiles().items())
        return f"{type(self).__name__}({said})"

    def _repr_html_(self) -> str:
        tiles = "".join(
            f'<div style="{_TILE}"><small>{escape(name)}</small><br>{escape(str(value))}</div>'
            for name, value in self._tiles().items()
        )
        return f'<div style="{_TILES}">{tiles}</div>{self._picture()}{self._below()}'

    def _picture(self) -> str:
        from matplotlib.figure import Figure  # slow to load, and only notebooks need it

        figure, file = Figure((_WIDTH, _HEIGHT), layout="constrained"), BytesIO()
        self._draw(figure)
        figure.savefig(file, dpi=_DPI)
        return f'<img src="data:image/png;base64,{b64encode(file.getvalue()).decode()}">'


def new_figure() -> "Figure":
    from matplotlib import pyplot as plt  # a third of a second, and most draw nothing

    return plt.figure(layout="constrained")


def stacked(labels: Iterable[str], below: str, figure: "Figure | None" = None) -> "list[Axes]":
    """Axes one above the other, in a new figure if none is given."""
    figure, labels = figure or new_figure(), list(labels)
    axes: list[Axes] = list(figure.subplots(len(labels), sharex=True))
    for ax, label in zip(axes, labels, strict=True):
        ax.set_ylabel(label)
    axes[-1].set_xlabel(below)
    figure.align_ylabels()
    return axes


def with_unit(name: str, beam: Beam) -> str:
    units = [unit for start, unit in _SI.items() if name.startswith(start)]
    return f"{name} [{units[0]}]" if beam.si else name


def described(beam: Beam) -> str:
    return f"length {beam.length:g}, EI {beam.base_rigidity:g}, radius {beam.radius:g}"


def draw_ends(ax: "Axes", feet: Pose, unloaded: Unloaded, beam: Beam) -> None:
    """The way of the foot, and the vibrissa at rest where it starts and ends."""
    s = np.linspace(0, 1, 33)
    ax.plot(feet.foot_x, feet.foot_y, color="#999999", linewidth=0.8)
    for station, said, colour in ((0, "start", "#0072b2"), (-1, "end", "#d55e00")):
        foot_x, foot_y, angle = (part[station] for part in feet)
        x, y, _ = replace(unloaded, angle=float(angle)).at(s) * np.array(beam.length)
        ax.plot(foot_x + x, foot_y + y, color=colour, label=f"unloaded, at the {said}")
        ax.plot(foot_x, foot_y, "s", color=colour, markersize=4)
    ax.set(xlabel="x [m]" if beam.si else "x", ylabel="y [m]" if beam.si else "y")
    ax.set_aspect("equal", adjustable="datalim")
    ax.legend(fontsize="small")
