"""A sweep in space in motion: both models' vibrissa at the body, and the clamp's components."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d.axes3d import Axes3D
from PIL import Image

from analytic.problem.arrays import Floats
from analytic.space import Body, SpatialReadings
from analytic.space.problem.readings import FORCE, MOMENT
from compare.align.travel import travel_of
from compare.show.animation.frames import framed
from compare.show.animation.gif import save_gif
from compare.show.animation.moving import pictures
from compare.show.animation.stills import STILL_DPI, save_stills, shown
from compare.show.figures.space import draw_scene, upright
from compare.show.scene import SweepScene
from compare.show.style import (
    BLUE,
    CANDIDATE,
    FAINT,
    GREEN,
    INK,
    ORANGE,
    PHASE_COLOURS,
    PHASE_NAMES,
    REFERENCE,
    label,
)

_SIZE, _DPI = (8.0, 6.4), 100  # inches and pixels an inch
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
    chosen = framed(touching, len(reference.table), frames, reference.source)
    moving = _Moving(SweepScene.of(reference, body), SweepScene.of(candidate, None))
    film = save_gif([*moving.images(chosen, advance)], folder / "animation.gif")
    return [film, *save_stills(moving.images(shown(touching), dpi=STILL_DPI), folder)]


class _Moving:
    """The picture: what stays is drawn once, what moves is drawn over it frame by frame."""

    def __init__(self, reference: SweepScene, candidate: SweepScene) -> None:
        self._scenes = reference, candidate
        self._figure = Figure(figsize=_SIZE, dpi=_DPI)
        self._canvas: Any = FigureCanvasAgg(self._figure)  # its methods have no types
        grid = self._figure.add_gridspec(
            2, 2, left=0.09, right=0.98, top=0.95, bottom=0.085, hspace=0.16, wspace=0.24,
            height_ratios=[2.2, 1],
        )  # fmt: skip
        view: Axes3D = self._figure.add_subplot(grid[0, :], projection="3d", computed_zorder=False)
        draw_scene(view, reference)
        (self._line,) = view.plot([], [], [], linewidth=3)
        (self._dots,) = view.plot([], [], [], color=CANDIDATE, marker="o", markersize=4, ls="")
        (self._contact,) = view.plot([], [], [], color=INK, marker="o", markersize=5, ls="")
        beam = reference.readings.beam
        self._travel = travel_of(reference.readings) / beam.length
        self._marks: list[tuple[Any, Floats]] = []
        for i, (names, unit, title) in enumerate(
            (
                (FORCE, beam.force_unit, "$F$ / ($EI/L^2$)"),
                (MOMENT, beam.moment_unit, "$M$ / ($EI/L$)"),
            )
        ):
            self._add_curves(self._figure.add_subplot(grid[1, i]), names, unit, title)
        case = label(reference.readings.provenance.get("case", ""))
        self._figure.text(0.09, 0.955, case, fontsize=12, weight="bold")
        self._figure.legend(
            [Line2D([], [], color=REFERENCE, linewidth=3),
             Line2D([], [], color=CANDIDATE, marker="o", linestyle="")],
            [label(scene.readings.source) for scene in self._scenes],
            loc="center", bbox_to_anchor=(0.5, 0.967), ncols=2, frameon=False,
        )  # fmt: skip
        self._phase = self._figure.text(0.98, 0.955, "", ha="right", fontsize=12, weight="bold")
        self._artists: list[Artist] = [
            self._line, self._dots, self._contact, *(mark for mark, _ in self._marks),
        ]  # fmt: skip

    def images(
        self,
        stations: Iterable[int],
        advance: Callable[[], None] = lambda: None,
        dpi: int = _DPI,
    ) -> Iterator[Image.Image]:
        """A picture of each station."""
        return pictures(
            self._canvas, self._artists, self._phase, self._show, stations, advance, dpi
        )

    def _add_curves(self, ax: Axes, names: tuple[str, ...], unit: float, title: str) -> None:
        for name, colour in zip(names, (BLUE, ORANGE, GREEN), strict=True):
            for scene, style in zip(self._scenes, ("-", ""), strict=True):
                values = scene.readings.values(name) / unit
                values[~scene.readings.trusted] = np.nan
                if style:
                    ax.plot(self._travel, values, color=colour, linewidth=1, label=name[-1])
                else:
                    (mark,) = ax.plot([], [], color=colour, marker="o", markersize=6, ls="")
                    self._marks.append((mark, values))
        ax.axhline(0, color=FAINT, linewidth=0.8, zorder=0)
        ax.set_xlabel("way of the foot / $L$")
        ax.set_ylabel(title)
        ax.legend(fontsize=8, frameon=False, ncols=3)

    def _show(self, station: int) -> None:
        one, other = self._scenes
        phase = str(one.phase[station])
        lost = not np.isfinite(one.lines[station]).all()
        self._line.set_data_3d(*upright(one.lines[station]).T)
        self._line.set_color(PHASE_COLOURS.get(phase, INK))
        points = len(other.lines[station])
        beads = np.linspace(0, points - 1, _DOTS + 1)[1:].round().astype(int)
        self._dots.set_data_3d(*upright(other.lines[station][beads]).T)
        self._contact.set_data_3d(*upright(one.contact[station : station + 1]).T)
        for mark, values in self._marks:
            mark.set_data([self._travel[station]], [values[station]])
        self._phase.set_text("without readings" if lost else PHASE_NAMES.get(phase, ""))
        self._phase.set_color(INK if lost else PHASE_COLOURS.get(phase, INK))
