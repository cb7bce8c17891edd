"""A film of a sweep, and stills beside it: what stands still is drawn once, the rest over it."""

import io
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from matplotlib.artist import Artist
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from PIL import Image
from PIL.PngImagePlugin import PngInfo

from analytic import InputError, Readings
from analytic.numerics.arrays import Integers, Words
from analytic.problem.files import SOFTWARE, whole_file, write_whole
from analytic.space import SpatialReadings
from compare.show import style

_SIZE = (8.0, 6.4)  # inches
_DPI, _STILL_DPI = 100, 150  # pixels an inch: a still may be printed
_SHARES = (0.1, 0.4, 0.7, 1.0)  # of the stations in contact; the last is just before the snap-off
_FRAME, _LAST_FRAME = 80, 1600  # ms
_TOP = 0.955  # of the heading


class Part(NamedTuple):
    moving: list[Artist]  # what is drawn anew at every station
    show: Callable[[int], None]  # moves to a station


def heading(
    reference: Readings | SpatialReadings, candidate: str, phase: Words
) -> tuple[Figure, Part]:
    """A figure with a strip on top: the case, both sources, and the phase of the station."""
    figure = Figure(figsize=_SIZE, dpi=_DPI)
    case = style.label(reference.provenance.get("case", ""))
    figure.text(0.085, _TOP, case, fontsize=12, weight="bold")
    text = figure.text(0.98, _TOP, "", ha="right", fontsize=12, weight="bold")
    line = Line2D([], [], color=style.REFERENCE, linewidth=3)
    dots = Line2D([], [], color=style.CANDIDATE, marker="o", linestyle="")
    figure.legend(
        [line, dots], [style.label(reference.source), style.label(candidate)],
        loc="center", bbox_to_anchor=(0.5, 0.967), ncols=2, frameon=False,
    )  # fmt: skip

    def show(station: int) -> None:
        here = str(phase[station])
        text.set_text(style.PHASE_NAMES.get(here, "without readings to trust"))
        text.set_color(style.PHASE_COLOURS.get(here, style.INK))

    return figure, Part([text], show)


def framed(readings: Readings | SpatialReadings, touching: Integers, frames: int) -> Integers:
    """Which stations are frames: evenly over all of the sweep, if it touches anything."""
    if frames < 2:
        raise InputError("--frames", frames, "2 or more", "60 is usual")
    if not touching.size:
        raise InputError(f"stations in contact ({readings.source})", 0, "one or more", "sweep on")
    stations = len(readings.table)
    return np.unique(np.linspace(0, stations - 1, min(frames, stations)).astype(int))


def write_film(
    figure: Figure,
    parts: Sequence[Part],
    frames: Integers,
    touching: Integers,
    folder: Path,
    advance: Callable[[], None],
) -> list[Path]:
    """Write the GIF and the stills, each of them whole or not at all."""
    images = []
    for image in _images(figure, parts, frames, _DPI):
        images.append(image)
        advance()
    written = [_save_gif(images, folder / "animation.gif")]
    own = PngInfo()
    own.add_text("Software", SOFTWARE)
    shown = [touching[round(share * (len(touching) - 1))] for share in _SHARES]
    for number, image in enumerate(_images(figure, parts, shown, _STILL_DPI), start=1):
        buffer = io.BytesIO()
        image.save(buffer, "PNG", dpi=(_STILL_DPI, _STILL_DPI), pnginfo=own)
        written.append(write_whole(folder / f"still-{number}.png", buffer.getvalue()))
    return written


def _images(
    figure: Figure, parts: Sequence[Part], stations: Iterable[int], dpi: int
) -> Iterator[Image.Image]:
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
            optimize=False, comment=SOFTWARE.encode(),
        )  # fmt: skip
    return path
