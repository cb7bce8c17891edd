"""A sweep in motion: both models' vibrissa, its curvature, its contact, and its clamp readings.

Drawn from readings alone, and without a display.
"""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from analytic import Readings
from compare.show.animation.frames import framed
from compare.show.animation.gif import save_gif
from compare.show.animation.motion import Motion
from compare.show.animation.scene import Scene
from compare.show.animation.stills import STILL_DPI, save_stills, shown

__all__ = ["write_animation"]


def write_animation(
    reference: Readings,
    candidate: Readings,
    folder: Path,
    frames: int = 60,
    advance: Callable[[], None] = lambda: None,
) -> list[Path]:
    """Draw the sweep in motion, from the sensed readings of both models alone."""
    moving = Motion.of(reference), Motion.of(candidate)
    touching = np.flatnonzero(np.isin(moving[0].phase, ("tip", "tangent")))
    chosen = framed(touching, len(reference.table), frames, reference.source)
    scene = Scene(*moving)
    film = save_gif(list(scene.images(chosen, advance)), folder / "animation.gif")
    return [film, *save_stills(scene.images(shown(touching), dpi=STILL_DPI), folder)]
