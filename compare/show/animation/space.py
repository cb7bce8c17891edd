"""A sweep in space in motion: both models' vibrissa at the body, and the clamp's components."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.axes3d import Axes3D

from analytic.problem.arrays import Floats
from analytic.space import Body, SpatialReadings
from compare.align.travel import travel_of
from compare.show.animation.film import Heading, Part, framed, write_film
from compare.show.figures.over_foot import in_unit
from compare.show.figures.space import COLOURS, LOADS, draw_scene, label_axes, upright
from compare.show.scene import SweepScene
from compare.show.style import CANDIDATE, INK, PHASE_COLOURS

_DOTS = 12  # of a dotted vibrissa


def write_space_animation(
    reference: SpatialReadings,
    candidate: SpatialReadings,
    folder: Path,
    body: Body | None = None,
    frames: int = 60,
    advance: Callable[[], None] = lambda: None,
) -> list[Path]:
    """Draw the sweep in motion, from the clamp readings of both models alone."""
    touching = np.flatnonzero(reference.touching)
    chosen = framed(reference, touching, frames)
    one, other = SweepScene.of(reference, body), SweepScene.of(candidate, None)
    phase = np.where(np.isfinite(one.lines).all(axis=(1, 2)), one.phase, "")
    heading = Heading(reference, candidate.source, phase)
    grid = heading.figure.add_gridspec(
        2, 2, left=0.09, right=0.98, top=0.95, bottom=0.085, hspace=0.16, wspace=0.24,
        height_ratios=[2.2, 1],
    )  # fmt: skip
    view = heading.figure.add_subplot(grid[0, :], projection="3d", computed_zorder=False)
    curves = [
        _Curves(heading.figure.add_subplot(grid[1, i]), one.readings, candidate, title)
        for i, title in enumerate(LOADS)
    ]
    parts: list[Part] = [_View(view, one, other), *curves]
    return write_film(heading, parts, chosen, touching, folder, advance)


class _View:
    """The body, both vibrissae, and the contact."""

    def __init__(self, ax: Axes3D, one: SweepScene, other: SweepScene) -> None:
        self._one, self._other = one, other
        draw_scene(ax, one)
        (self._line,) = ax.plot([], [], [], linewidth=3)
        (self._dots,) = ax.plot([], [], [], color=CANDIDATE, marker="o", markersize=4, ls="")
        (self._contact,) = ax.plot([], [], [], color=INK, marker="o", markersize=5, ls="")
        self.moving: list[Artist] = [self._line, self._dots, self._contact]

    def show(self, station: int) -> None:
        one, other = self._one, self._other
        self._line.set_data_3d(*upright(one.lines[station]).T)
        self._line.set_color(PHASE_COLOURS.get(str(one.phase[station]), INK))
        points = len(other.lines[station])
        beads = np.linspace(0, points - 1, _DOTS + 1)[1:].round().astype(int)
        self._dots.set_data_3d(*upright(other.lines[station][beads]).T)
        self._contact.set_data_3d(*upright(one.contact[station : station + 1]).T)


class _Curves:
    """The components of force or moment: the reference's drawn out, the candidate's by a mark."""

    def __init__(self, ax: Axes, one: SpatialReadings, other: SpatialReadings, title: str) -> None:
        self._travel = travel_of(one) / one.beam.length
        self._values: list[Floats] = []
        self._marks: list[Line2D] = []
        for name, colour in zip(LOADS[title], COLOURS, strict=True):
            ax.plot(self._travel, in_unit(one, name), color=colour, linewidth=1, label=name[-1])
            (mark,) = ax.plot([], [], color=colour, marker="o", markersize=6, ls="")
            self._values.append(in_unit(other, name))
            self._marks.append(mark)
        label_axes(ax, title)
        self.moving: list[Artist] = [*self._marks]

    def show(self, station: int) -> None:
        for mark, values in zip(self._marks, self._values, strict=True):
            mark.set_data([self._travel[station]], [values[station]])
