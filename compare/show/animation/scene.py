"""The whole picture: the object from afar, the vibrissa from near, and the clamp readings."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from analytic import CLAMP_READINGS
from compare.show.animation.motion import Motion
from compare.show.animation.moving import pictures
from compare.show.animation.views import Curve, View
from compare.show.style import CANDIDATE, INK, PHASE_COLOURS, PHASE_NAMES, REFERENCE, label

_SIZE, _DPI = (8.0, 6.4), 100  # inches and pixels an inch


class Scene:
    """The picture: what stays is drawn once, what moves is drawn over it frame by frame."""

    def __init__(self, reference: Motion, candidate: Motion) -> None:
        self.reference = reference
        motions = reference, candidate
        self._nearest = np.abs(reference.foot_x[:, None] - candidate.foot_x).argmin(axis=1)
        self._figure = Figure(figsize=_SIZE, dpi=_DPI)
        self._canvas: Any = FigureCanvasAgg(self._figure)  # its methods have no types
        grid = self._figure.add_gridspec(
            2, 2, left=0.085, right=0.985, top=0.915, bottom=0.085, hspace=0.24, wspace=0.3,
            height_ratios=[1, 2.1], width_ratios=[1.3, 1],
        )  # fmt: skip
        far = View(self._figure.add_subplot(grid[0, :]), motions, follows=False)
        near = View(self._figure.add_subplot(grid[1, 0]), motions, follows=True)
        plots = grid[1, 1].subgridspec(3, 1, hspace=0.12)
        curves = [
            Curve(self._figure.add_subplot(plots[i]), motions, name, last=i == 2)
            for i, name in enumerate(CLAMP_READINGS)
        ]
        self._parts: tuple[View | Curve, ...] = (far, near, *curves)
        self._add_colour_bar(near)
        for view in (far, near):
            view.frame(_SIZE)
        self._add_header(motions)
        self._phase = self._figure.text(0.985, 0.955, "", ha="right", fontsize=12, weight="bold")
        self._moving = [a for part in self._parts for a in part.moving]

    def images(
        self,
        stations: Iterable[int],
        advance: Callable[[], None] = lambda: None,
        dpi: int = _DPI,
    ) -> Iterator[Image.Image]:
        """A picture of each station."""
        moving = sorted(self._moving, key=lambda artist: artist.zorder)
        return pictures(self._canvas, moving, self._phase, self._show, stations, advance, dpi)

    def _show(self, station: int) -> None:
        for part in self._parts:
            part.show(station, int(self._nearest[station]))
        phase = str(self.reference.phase[station])
        self._phase.set_text(PHASE_NAMES.get(phase, "not to be trusted"))
        self._phase.set_color(PHASE_COLOURS.get(phase, INK))

    def _add_header(self, motions: tuple[Motion, Motion]) -> None:
        case = label(motions[0].readings.provenance.get("case", ""))
        self._figure.text(0.085, 0.955, case, fontsize=12, weight="bold")
        line = Line2D([], [], color=REFERENCE, linewidth=3)
        dots = Line2D([], [], color=CANDIDATE, marker="o", linestyle="")
        self._figure.legend(
            [line, dots],
            [label(motion.readings.source) for motion in motions],
            loc="center",
            bbox_to_anchor=(0.5, 0.967),
            ncols=2,
            frameon=False,
        )

    def _add_colour_bar(self, view: View) -> None:
        bar = self._figure.colorbar(view.line, ax=view.ax, aspect=32, pad=0.03)
        bar.set_label(r"curvature $|\kappa|$ / ($1/L$)")
        largest = self.reference.force.max()
        steps = np.outer(10.0 ** np.arange(-6, 9), [1, 2, 5]).ravel()
        unit = steps[steps <= max(largest / 2.5, steps[0])][-1]
        view.ax.quiverkey(
            view.force, 0.36, 0.055, unit, f"contact force {unit:g} $EI/L^2$",
            labelpos="E", coordinates="axes", fontproperties={"size": 9},
        )  # fmt: skip
