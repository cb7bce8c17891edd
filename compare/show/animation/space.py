"""A sweep in space in motion: both models' vibrissa at the body, and the clamp's components."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from mpl_toolkits.mplot3d.axes3d import Axes3D

from analytic.space import Body, SpatialReadings
from compare.show.animation.film import Part, framed, heading, write_film
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
    figure, strip = heading(reference, candidate.source, phase)
    grid = figure.add_gridspec(
        2, 2, left=0.09, right=0.98, top=0.95, bottom=0.085, hspace=0.16, wspace=0.24,
        height_ratios=[2.2, 1],
    )  # fmt: skip
    view = figure.add_subplot(grid[0, :], projection="3d", computed_zorder=False)
    curves = [
        _curves(figure.add_subplot(grid[1, i]), one.readings, candidate, title)
        for i, title in enumerate(LOADS)
    ]
    parts = [strip, _view(view, one, other), *curves]
    return write_film(figure, parts, chosen, touching, folder, advance)


def _view(ax: Axes3D, one: SweepScene, other: SweepScene) -> Part:
    """The body, both vibrissae, and the contact."""
    draw_scene(ax, one)
    (line,) = ax.plot([], [], [], linewidth=3)
    (dots,) = ax.plot([], [], [], color=CANDIDATE, marker="o", markersize=4, ls="")
    (contact,) = ax.plot([], [], [], color=INK, marker="o", markersize=5, ls="")

    def show(station: int) -> None:
        line.set_data_3d(*upright(one.lines[station]).T)
        line.set_color(PHASE_COLOURS.get(str(one.phase[station]), INK))
        points = len(other.lines[station])
        beads = np.linspace(0, points - 1, _DOTS + 1)[1:].round().astype(int)
        dots.set_data_3d(*upright(other.lines[station][beads]).T)
        contact.set_data_3d(*upright(one.contact[station : station + 1]).T)

    return Part([line, dots, contact], show)


def _curves(ax: Axes, one: SpatialReadings, other: SpatialReadings, title: str) -> Part:
    """The components of force or moment: the reference's drawn out, the candidate's by a mark."""
    travel = one.running_values / one.beam.length
    marks: list[Artist] = []
    values = []
    for name, colour in zip(LOADS[title], COLOURS, strict=True):
        ax.plot(travel, in_unit(one, name), color=colour, linewidth=1, label=name[-1])
        marks += ax.plot([], [], color=colour, marker="o", markersize=6, ls="")
        values.append(in_unit(other, name))
    label_axes(ax, title)

    def show(station: int) -> None:
        for mark, found in zip(marks, values, strict=True):
            mark.set(data=([travel[station]], [found[station]]))

    return Part(marks, show)
