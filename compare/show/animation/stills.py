"""Pictures of single stations, beside the animation."""

import io
from collections.abc import Iterable
from pathlib import Path

from PIL import Image

from analytic.problem.arrays import Integers
from analytic.problem.files import write_whole
from compare.show.style import PNG_LEVEL

STILL_DPI = 150
"""Pixels an inch: a still may be printed."""

_SHARES = (0.1, 0.4, 0.7, 1.0)  # of the stations in contact; the last is just before the snap-off


def shown(touching: Integers) -> list[int]:
    """The stations of which there are stills."""
    return [int(touching[round(share * (len(touching) - 1))]) for share in _SHARES]


def save_stills(images: Iterable[Image.Image], folder: Path) -> list[Path]:
    """Write PNGs, each of them whole or not at all."""
    written = []
    for number, image in enumerate(images, start=1):
        buffer = io.BytesIO()
        image.save(buffer, "PNG", dpi=(STILL_DPI, STILL_DPI), compress_level=PNG_LEVEL)
        written.append(write_whole(folder / f"still-{number}.png", buffer.getvalue()))
    return written
