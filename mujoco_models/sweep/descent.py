"""Where a beam without a neighbouring state at rest goes: down, on MuJoCo's own balance.

It decides what Newton's method cannot: whether the vibrissa has let go. The descent ends where
MuJoCo's moments balance. What the solver knows of the stiffness only scales its steps, so that each
turns the beam by little: a beam 1e-4 L before its fold stays, one as far beyond it leaves.
"""

import numpy as np

from analytic.problem.clamp_path import Pose
from mujoco_models.model.balance import Balance
from mujoco_models.sweep.newton import Newton
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.rest import around, one_bead_a_link
from mujoco_models.sweep.state import State, turned

_SHORTER, _LONGER = 2.0, 0.25  # the most by which inertia changes from one step to the next


def descend(model: Balance, pose: Pose, start: State, numerics: Numerics, steps: int) -> State:
    """Let the beam go down, in a pose of the clamp, until it is free or rests."""
    model.lookout.watch(around(model, start.forces, numerics.reach) | one_bead_a_link(model))
    if start.slope is not None:
        model.lookout.face(start.slope)
    newton = Newton(model, numerics)
    state, inertia, unloaded = start, numerics.inertia, 0
    for _ in range(steps):
        model.imbalance(pose, state.angles)
        contacts = model.contacts()
        if model.slide_beads(contacts):
            model.imbalance(pose, state.angles)
            contacts = model.contacts()
        model.lookout.follow_contact(contacts)
        after = newton.step(state, contacts, inertia)
        turn = turned(after.angles, state.angles)
        unloaded = 0 if after.forces else unloaded + 1
        state = after
        if not around(model, state.forces, numerics.margin) <= model.lookout.watched:
            model.lookout.watch(model.lookout.watched | around(model, state.forces, numerics.reach))
        if unloaded > numerics.unloaded_steps or turn < numerics.fallen:
            break
        inertia *= float(np.clip(turn / numerics.gentle_turn, _LONGER, _SHORTER))
    return state
