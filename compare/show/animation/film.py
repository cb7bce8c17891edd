"""A film of a sweep, and stills beside it: what stands still is drawn once, the rest over it."""

import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, Protocol

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image

from analytic import InputError, Readings
from analytic.problem.arrays import Integers, Words
from analytic.problem.files import whole_file, write_whole
from analytic.space import SpatialReadings
from compare.show import style

_SIZE = (8.0, 6.4)  # inches
_DPI, _STILL_DPI = 100, 150  # pixels an inch: a still may be printed
_SHARES = (0.1, 0.4, 0.7, 1.0)  # of the stations in contact; the last is just before the snap-off
_FRAME, _LAST_FRAME = 80, 1600  # ms
_TOP = 0.955  # of the heading


class Part(Protocol):
    """A part of the figure that moves."""

    moving: list[Artist]
    """What is drawn anew at every station."""

    def show(self, station: int) -> None:
        """Move to a station."""


class Heading:
    """The phase of the station, in a strip with the case and both sources."""

    def __init__(self, reference: Readings | SpatialReadings, candidate: str, phase: Words) -> None:
        self.figure = Figure(figsize=_SIZE, dpi=_DPI)
        case = style.label(reference.provenance.get("case", ""))
        self.figure.text(0.085, _TOP, case, fontsize=12, weight="bold")
        self._text = self.figure.text(0.98, _TOP, "", ha="right", fontsize=12, weight="bold")
        line = Line2D([], [], color=style.REFERENCE, linewidth=3)
        dots = Line2D([], [], color=style.CANDIDATE, marker="o", linestyle="")
        self.figure.legend(
            [line, dots], [style.label(reference.source), style.label(candidate)],
            loc="center", bbox_to_anchor=(0.5, 0.967), ncols=2, frameon=False,
        )  # fmt: skip
        self._phase = phase
        self.moving: list[Artist] = [self._text]

    def show(self, station: int) -> None:
        """Name the phase of a station."""
        phase = str(self._phase[station])
        self._text.set_text(style.PHASE_NAMES.get(phase, "without readings to trust"))
        self._text.set_color(style.PHASE_COLOURS.get(phase, style.INK))


def framed(readings: Readings | SpatialReadings, touching: Integers, frames: int) -> Integers:
    """Which stations are frames: evenly over all of the sweep, if it touches anything."""
    if frames < 2:
        raise InputError("--frames", frames, "2 or more", "60 is usual")
    if not touching.size:
        raise InputError(f"stations in contact ({readings.source})", 0, "one or more", "sweep on")
    stations = len(readings.table)
    return np.unique(np.linspace(0, stations - 1, min(frames, stations)).astype(int))


def write_film(
    heading: Heading,
    parts: Sequence[Part],
    frames: Integers,
    touching: Integers,
    folder: Path,
    advance: Callable[[], None],
) -> list[Path]:
    """Write the GIF and the stills, each of them whole or not at all."""
    shown = [int(touching[round(share * (len(touching) - 1))]) for share in _SHARES]
    images = []
    for image in _images(heading.figure, [heading, *parts], frames, _DPI):
        images.append(image)
        advance()
    written = [_save_gif(images, folder / "animation.gif")]
    for number, image in enumerate(
        _images(heading.figure, [heading, *parts], shown, _STILL_DPI), start=1
    ):
        buffer = io.BytesIO()
        image.save(buffer, "PNG", dpi=(_STILL_DPI, _STILL_DPI))
        written.append(write_whole(folder / f"still-{number}.png", buffer.getvalue()))
    return written


def _images(
    figure: Figure, parts: Sequence[Part], stations: Iterable[int], dpi: int
) -> Iterator[Image.Image]:
    """A picture of each station."""
    moving = sorted((a for part in parts for a in part.moving), key=lambda a: a.zorder)
    for artist in moving:
        artist.set_animated(True)
    canvas: Any = FigureCanvasAgg(figure)  # its methods have no types
    figure.set_dpi(dpi)
    canvas.draw()
    still = canvas.copy_from_bbox(figure.bbox)
    for station in stations:
        canvas.restore_region(still)
        for part in parts:
            part.show(int(station))
        for artist in moving:
            figure.draw_artist(artist)
        yield Image.fromarray(np.array(canvas.buffer_rgba())).convert("RGB")


def _save_gif(images: Sequence[Image.Image], path: Path) -> Path:
    """All frames share one palette, so that nothing flickers and only what changes is stored."""
    sample = np.concatenate([np.asarray(one) for one in images[:: max(1, len(images) // 8)]])
    palette = Image.fromarray(sample).quantize(method=Image.Quantize.MAXCOVERAGE, kmeans=1)
    first, *others = (one.quantize(palette=palette, dither=Image.Dither.NONE) for one in images)
    durations = [_FRAME] * len(others) + [_LAST_FRAME]
    with whole_file(path) as unfinished:
        first.save(
            unfinished, "GIF", save_all=True, append_images=others, duration=durations, loop=0,
            optimize=False,
        )  # fmt: skip
    return path
