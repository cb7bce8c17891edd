"""What the vibrissa's weight does: how it hangs when it touches nothing, and what holds it."""

import math
from collections.abc import Callable

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats
from analytic.numerics.vectors import cross
from mujoco_models.beams.protocol import Beam

_LOAD = 1.0  # EI/L^3; by which gravity grows from one state at rest to the next
_ROUNDS = 50
_AT_REST = 1e-11  # EI/L


def hang(
    model: mujoco.MjModel, beam: Beam, angle: float, imbalance: Callable[[Floats], Floats]
) -> Floats:
    """Joint angles at which springs hold the weight, in a clamp that leans to the left.

    `imbalance` has what MuJoCo says of the joints. It is followed from no gravity on: what stands
    under all of it may stand in more than one way.
    """
    layout = beam.layout
    gravity, angles = model.opt.gravity.copy(), np.zeros(len(layout.joints))
    outer = np.maximum.outer(np.arange(len(angles)), np.arange(len(angles)))
    steps = math.ceil(math.hypot(*layout.vibrissa.weight) / _LOAD)
    for share in np.arange(1, steps + 1) / steps:
        model.opt.gravity = share * gravity
        for _ in range(_ROUNDS):
            missed = imbalance(angles)
            if np.abs(missed).max() < _AT_REST:
                break
            hangs = share * layout.weigh(layout.headings + angle + angles.cumsum())[1]
            stiffness = np.diag(beam.stiffness(angles)) + hangs[::-1].cumsum()[::-1][outer]
            angles = angles + np.linalg.solve(stiffness, missed)
    return angles


def holding(model: mujoco.MjModel, data: mujoco.MjData, foot: Floats, bodies: Booleans) -> Floats:
    """Force and moment at the foot that hold the weight of bodies, shape (2, 3)."""
    weight = np.outer(model.body_mass[bodies], model.opt.gravity)
    moment = cross(data.xipos[bodies] - foot, weight)
    return np.array([-weight.sum(axis=0), -moment.sum(axis=0)])
