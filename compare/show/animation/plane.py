"""A sweep in the plane in motion: the object from afar, the vibrissa from near, the readings."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from analytic import CLAMP_READINGS, Readings
from compare.show.animation.film import framed, write_film
from compare.show.animation.motion import Motion, Motions
from compare.show.animation.stage import SIZE, Stage
from compare.show.animation.views import Curve, View


def write_animation(
    reference: Readings,
    candidate: Readings,
    folder: Path,
    frames: int = 60,
    advance: Callable[[], None] = lambda: None,
) -> list[Path]:
    """Draw the sweep in motion, from the sensed readings of both models alone."""
    motions = Motions(Motion.of(reference), Motion.of(candidate))
    touching = np.flatnonzero(np.isin(motions.reference.phase, ("tip", "tangent")))
    chosen = framed(reference, touching, frames)
    return write_film(_stage(motions), chosen, touching, folder, advance)


def _stage(motions: Motions) -> Stage:
    readings = [motion.readings for motion in (motions.reference, motions.candidate)]
    case = readings[0].provenance.get("case", "")
    stage = Stage(case, [one.source for one in readings], motions.reference.phase, (0.085, 0.985))
    figure = stage.figure
    grid = figure.add_gridspec(
        2, 2, left=0.085, right=0.985, top=0.915, bottom=0.085, hspace=0.24, wspace=0.3,
        height_ratios=[1, 2.1], width_ratios=[1.3, 1],
    )  # fmt: skip
    far = View(figure.add_subplot(grid[0, :]), motions, follows=False)
    near = View(figure.add_subplot(grid[1, 0]), motions, follows=True)
    plots = grid[1, 1].subgridspec(3, 1, hspace=0.12)
    curves = [
        Curve(figure.add_subplot(plots[i]), motions, name, last=i == 2)
        for i, name in enumerate(CLAMP_READINGS)
    ]
    _add_colour_bar(near, float(motions.reference.force.max()))
    for view in (far, near):
        view.frame(SIZE)
    stage.parts = (far, near, *curves)
    return stage


def _add_colour_bar(view: View, largest: float) -> None:
    """The curvature's colours, and an arrow of a round force."""
    bar = view.ax.figure.colorbar(view.line, ax=view.ax, aspect=32, pad=0.03)
    bar.set_label(r"curvature $|\kappa|$ / ($1/L$)")
    steps = np.outer(10.0 ** np.arange(-6, 9), [1, 2, 5]).ravel()
    unit = steps[steps <= max(largest / 2.5, steps[0])][-1]
    view.ax.quiverkey(
        view.force, 0.36, 0.055, unit, f"contact force {unit:g} $EI/L^2$",
        labelpos="E", coordinates="axes", fontproperties={"size": 9},
    )  # fmt: skip
