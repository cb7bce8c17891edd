"""Where the beam is relative to the object: what of a sweep has happened."""

from enum import Enum

import numpy as np

from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts

_POKES = -0.05  # cosine; a tip that pokes at right angles is on neither side


class Side(Enum):
    """Where a beam, whose clamp goes to the left, is relative to the object."""

    AHEAD = "free, the object is ahead"
    NEAR = "touches, with its left side"
    FAR = "touches, with its right side"
    PASSED = "free, the object is behind"


def contact_side(model: Balance, contacts: Contacts) -> Side:
    """The side of the last evaluated configuration.

    A sweep goes from AHEAD to NEAR, and by snap-off to FAR or PASSED. Any other change of side is
    no neighbour in a sweep: the beam was let through the object.
    """
    tip = model.bead_positions(np.array([len(model.layout.beads) - 1]))
    axis = np.concatenate([model.joint_positions(), tip])
    loaded = np.flatnonzero(contacts.loaded)
    if loaded.size:
        link, load = contacts.link[loaded], contacts.distance[loaded]
        x, y = (axis[link + 1] - axis[link]).T
        normal_x, normal_y = contacts.normal[loaded].T
        side = load @ ((normal_x * y - normal_y * x) / np.hypot(x, y)) / load.sum()
        return Side.NEAR if side > _POKES else Side.FAR
    x, y = model.pose.seen(*np.array(model.obstacle.lowest))
    if y < 0:  # behind the foot: how far the clamp has turned says on which side it went there
        right, up = np.array(model.obstacle.lowest) - [model.pose.foot_x, model.pose.foot_y]
        return Side.AHEAD if np.arctan2(-right, up) > model.pose.angle else Side.PASSED
    along, up = model.pose.seen(*axis.T)
    beside = float(np.interp(y, np.maximum.accumulate(up), along))
    return Side.AHEAD if beside > x else Side.PASSED
