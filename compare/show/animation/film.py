"""A film of a sweep, and stills beside it."""

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np
from PIL import Image

from analytic import InputError, Readings
from analytic.problem.arrays import Integers
from analytic.problem.files import write_whole
from analytic.space import SpatialReadings
from compare.show.animation.gif import save_gif
from compare.show.animation.stage import Stage
from compare.show.style import PNG_LEVEL

_STILL_DPI = 150  # pixels an inch: a still may be printed
_SHARES = (0.1, 0.4, 0.7, 1.0)  # of the stations in contact; the last is just before the snap-off


def framed(readings: Readings | SpatialReadings, touching: Integers, frames: int) -> Integers:
    """Which stations are frames: evenly over all of the sweep, if it touches anything."""
    if frames < 2:
        raise InputError("--frames", frames, "2 or more", "60 is usual")
    if not touching.size:
        raise InputError(f"stations in contact ({readings.source})", 0, "one or more", "sweep on")
    stations = len(readings.table)
    return np.unique(np.linspace(0, stations - 1, min(frames, stations)).astype(int))


def write_film(
    stage: Stage, frames: Integers, touching: Integers, folder: Path, advance: Callable[[], None]
) -> list[Path]:
    """Write the GIF and the stills, each of them whole or not at all."""
    written = [save_gif(list(stage.images(frames, advance)), folder / "animation.gif")]
    shown = [int(touching[round(share * (len(touching) - 1))]) for share in _SHARES]
    for number, image in enumerate(stage.images(shown, dpi=_STILL_DPI), start=1):
        written.append(write_whole(folder / f"still-{number}.png", _png(image)))
    return written


def _png(image: Image.Image) -> bytes:
    buffer = io.BytesIO()
    image.save(buffer, "PNG", dpi=(_STILL_DPI, _STILL_DPI), compress_level=PNG_LEVEL)
    return buffer.getvalue()
