"""A sweep in motion: both models' vibrissa, its contact, and the readings of its clamp.

Drawn from readings alone, and without a display.
"""

from compare.show.animation.plane import write_animation

__all__ = ["write_animation"]
