"""Whether a vibrissa has let go: a gentle descent on MuJoCo's own balance decides.

It ends where MuJoCo's moments balance, and each of its steps is as short as an inertia of a hundred
times the joints' stiffness makes it. So what the solver knows of the stiffness hardly takes part in
it. MuJoCo's own implicit steps without momentum, of 1e-3, do the same: they hold and release at the
same places, but take up to thirty times as long for the rod.
"""

from mujoco_models.model.model import BeamModel
from mujoco_models.sweep.newton import Newton
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.rest import around, one_bead_a_link
from mujoco_models.sweep.state import State, turned


def descend(model: BeamModel, foot_x: float, start: State, numerics: Numerics) -> State:
    """Let the beam go down, with the foot at `foot_x`, until it is free or rests.

    Parameters
    ----------
    model : BeamModel
        The beam and the obstacle.
    foot_x : float
        Foot position [L].
    start : State
        The last state at rest, or nearly.
    numerics : Numerics
        Constants of the way down.

    Returns
    -------
    State
        Without forces if the beam has lost its contact; else where it came to rest, or where it was
        after `Numerics.descent_steps`.
    """
    model.lookout.watch(around(model, start.forces, numerics.reach) | one_bead_a_link(model))
    newton = Newton(model, numerics)
    state, inertia, unloaded = start, numerics.inertia, 0
    for _ in range(numerics.descent_steps):
        model.imbalance(foot_x, state.angles)
        after = newton.step(state, model.contacts(), inertia)
        unloaded = 0 if after.forces else unloaded + 1
        if (
            unloaded > numerics.unloaded_steps
            or turned(after.angles, state.angles) < numerics.fallen
        ):
            return after
        if turned(after.angles, start.angles) > numerics.branch_turn:
            inertia = numerics.far_inertia
        state = after
    return state
