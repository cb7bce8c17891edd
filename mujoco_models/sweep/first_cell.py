"""Contacts that the first cell from the clamp is too coarse for."""

import numpy as np

from mujoco_models.beams.layout import Layout
from mujoco_models.obstacles.protocol import Obstacle

_PLACES = 9  # of the rigid part that are looked at
_OVERLOOKED = 1e-6  # L; how deep they may be in the obstacle


def near_clamp(
    layout: Layout, obstacle: Obstacle, radius: float, foot_x: float, s: float | None
) -> str | None:
    """What is wrong with a contact at `s`, or with the obstacle, so near to the clamp."""
    first = int(layout.clamp_turns)
    begin = float(layout.joints[first])
    if s is not None and s < begin + float(layout.lengths[first]) / 2:
        return "the contact is in the first cell from the clamp, which is too coarse"
    places = np.column_stack([np.full(_PLACES, foot_x), np.linspace(0, begin, _PLACES)])
    deep = radius - _OVERLOOKED
    near = () if layout.clamp_turns else obstacle.near(places, deep)
    if any(obstacle.clearance(places[i])[0] < deep for i in near):
        return "the object is in the rigid half of the first cell from the clamp"
    return None
