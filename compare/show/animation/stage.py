"""A figure whose parts move: what stands still is drawn once, what moves is drawn over it."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Protocol

from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from analytic.problem.arrays import Words
from compare.show.style import CANDIDATE, INK, PHASE_COLOURS, PHASE_NAMES, REFERENCE, label

SIZE, DPI = (8.0, 6.4), 100  # inches and pixels an inch
_TOP = 0.955  # of the heading


class Mover(Protocol):
    """A part of the figure that moves."""

    @property
    def moving(self) -> Sequence[Artist]:
        """What is drawn anew at every station."""

    def show(self, station: int) -> None:
        """Move to a station."""


class Stage:
    """The figure, headed by the case, both sources, and the phase of the station that it shows."""

    def __init__(
        self, case: object, sources: Sequence[str], phase: Words, edges: tuple[float, float]
    ) -> None:
        self.figure = Figure(figsize=SIZE, dpi=DPI)
        self._canvas: Any = FigureCanvasAgg(self.figure)  # its methods have no types
        self._phase = phase
        self.figure.text(edges[0], _TOP, label(case), fontsize=12, weight="bold")
        self._heading = self.figure.text(
            edges[1], _TOP, "", ha="right", fontsize=12, weight="bold", animated=True
        )
        line = Line2D([], [], color=REFERENCE, linewidth=3)
        dots = Line2D([], [], color=CANDIDATE, marker="o", linestyle="")
        self.figure.legend(
            [line, dots], [label(source) for source in sources],
            loc="center", bbox_to_anchor=(0.5, 0.967), ncols=2, frameon=False,
        )  # fmt: skip
        self.parts: Sequence[Mover] = ()

    def images(
        self,
        stations: Iterable[int],
        advance: Callable[[], None] = lambda: None,
        dpi: int = DPI,
    ) -> Iterator[Image.Image]:
        """A picture of each station."""
        moving = sorted((a for part in self.parts for a in part.moving), key=lambda a: a.zorder)
        for artist in moving:
            artist.set_animated(True)
        self.figure.set_dpi(dpi)
        self._canvas.draw()
        still = self._canvas.copy_from_bbox(self.figure.bbox)
        headed: dict[str, Any] = {}
        for station in stations:
            for part in self.parts:
                part.show(int(station))
            phase = str(self._phase[station])
            if phase not in headed:
                self._heading.set_text(PHASE_NAMES.get(phase, "without readings to trust"))
                self._heading.set_color(PHASE_COLOURS.get(phase, INK))
                self._canvas.restore_region(still)
                self.figure.draw_artist(self._heading)
                headed[phase] = self._canvas.copy_from_bbox(self.figure.bbox)
            self._canvas.restore_region(headed[phase])
            for artist in moving:
                self.figure.draw_artist(artist)
            pixels = self._canvas.buffer_rgba()
            high, wide, _ = pixels.shape
            yield Image.frombytes("RGB", (wide, high), pixels, "raw", "RGBX")  # all of it is opaque
            advance()
