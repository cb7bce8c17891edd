"""Where the beam will rest, before the engine is asked.

In the rest solver's surrogate of links, springs and polygon Newton's method comes to rest at a
fraction of the cost, the slide of the contact from bead to bead and from facet to facet included,
and the engine has only to confirm what was found. Nothing of it is in a reading: what the engine
does not confirm, its own balance corrects.
"""

import numpy as np

from analytic.problem.clamp_path import Pose
from mujoco_models.model.balance import Balance
from mujoco_models.sweep.newton import Newton
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.state import State, turned
from mujoco_models.sweep.surrogate import Surrogate


def forecast(model: Balance, pose: Pose, start: State, numerics: Numerics) -> State | None:
    """Where the beam will rest in a pose of the clamp, near `start`."""
    if len(model.obstacle.corners):
        return None
    surrogate = Surrogate(model, start.forces, numerics.ahead)
    newton, state, lookout = Newton(surrogate, numerics), start, model.lookout
    for _ in range(numerics.forecasts):
        contacts = surrogate.look(pose, state.angles)
        if contacts is None or surrogate.is_inside(contacts):
            return None
        touching = contacts.loaded
        if model.obstacle.faceted or not np.count_nonzero(touching):
            touching = contacts.distance == contacts.distance.min()
        slope = float(contacts.slope[touching].mean())  # one circle is best amid all that touch
        seen = lookout.window
        lookout.face(slope)
        before, state = state, newton.step(state, contacts)
        # What was seen by another window is not quite the obstacle that the engine has.
        if lookout.window == seen and turned(state.angles, before.angles) < numerics.foreseen:
            return State(state.angles, state.forces, slope=slope)
    return None
