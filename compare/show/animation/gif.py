"""Pictures to an animated GIF."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from analytic.problem.files import whole_file
from compare.show.animation.views import CURVATURE_COLOURS

_FRAME, _LAST_FRAME = 80, 1600  # ms
_CURVATURE_SHARE = 80  # of the 256 colours that a GIF can have


def save_gif(images: list[Image.Image], path: Path) -> Path:
    """Write an animation, whole or not at all.

    All frames share one palette, so that nothing flickers and only what changes is stored.
    """
    palette = Image.new("P", (1, 1))
    palette.putpalette(_palette(images[:: max(1, len(images) // 8)]).tobytes())
    first, *others = (image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images)
    durations = [_FRAME] * len(others) + [_LAST_FRAME]
    with whole_file(path) as unfinished:
        first.save(
            unfinished, "GIF", save_all=True, append_images=others, duration=durations, loop=0,
            optimize=False,
        )  # fmt: skip
    return path


def _palette(sample: list[Image.Image]) -> NDArray[np.uint8]:
    """The curvature's colours and the most frequent ones, shape (256, 3).

    Pillow looks colours up in cells of four values a channel, so one colour a cell is enough, and a
    second would be mistaken for it: white for the nearly white.
    """
    pixels = np.stack([np.asarray(image.convert("RGBA")) for image in sample])
    packed, counts = np.unique(pixels.view(np.uint32), return_counts=True)  # a word sorts fast
    frequent = packed[np.argsort(-counts)].view(np.uint8).reshape(-1, 4)[:, :3]
    _, first = np.unique(frequent // 4, axis=0, return_index=True)
    scale = np.rint(255 * CURVATURE_COLOURS(np.linspace(0, 1, _CURVATURE_SHARE))[:, :3])
    others = frequent[np.sort(first)[: 256 - _CURVATURE_SHARE]]
    return np.concatenate([others, scale]).astype(np.uint8)
