"""Coming to rest, and falling where there is no rest nearby.

A station is settled when MuJoCo's springs and contacts, and nothing else, hold the beam to a
tolerance; how it got there does not matter, and time stepping to the same balance takes hundreds
of steps.
"""

from dataclasses import replace

import numpy as np

from mujoco_models.model.model import BeamModel
from mujoco_models.sweep.newton import Newton
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.state import State, turned


def relax(
    model: BeamModel, foot_x: float, start: State, tolerance: float, numerics: Numerics
) -> State:
    """Bring the beam to rest with its foot at `foot_x`, from `start`.

    Parameters
    ----------
    model : BeamModel
        The beam and the obstacle; left in the returned state.
    foot_x : float
        Foot position [L].
    start : State
        Where to start from.
    tolerance : float
        Largest moment out of balance at rest [EI/L].
    numerics : Numerics
        Constants of the way there.

    Returns
    -------
    State
        Not settled if Newton's method did not get there; the caller takes smaller steps then.
    """
    lookout, obstacle = model.lookout, model.obstacle
    newton = Newton(model, numerics)
    state = best = start
    lookout.watch(_around(model, state.forces, numerics.ahead) or _one_bead_a_link(model))
    if state.forces:
        lookout.anticipate_window()
    for _ in range(numerics.iterations):
        residual = float(np.abs(model.imbalance(foot_x, state.angles)).max())
        contacts = model.contacts()
        state = replace(state, imbalance=residual)
        best = min(best, state, key=lambda s: s.imbalance)
        if residual < tolerance:
            if contacts.passed or lookout.is_crossed(model.joint_positions()):
                break  # a corner has gone through a link
            slopes = contacts.slope[contacts.loaded]
            if not obstacle.faces(slopes):
                break  # pushed out through the far side of the object: no state of the sweep
            loaded = obstacle.place(slopes)
            if lookout.move_window(loaded):
                continue
            if unwatched := lookout.near_the_obstacle() - lookout.watched:
                lookout.watch(lookout.watched | unwatched)
                continue
            if (missed := lookout.overlooked(contacts)) is not None:
                lookout.use_window(obstacle.window_of(missed))
                continue
            if loaded.size:
                lookout.leave_trail(float(loaded.mean()))
            return replace(state, settled=True)
        state = newton.step(state, contacts)
        if not _around(model, state.forces, numerics.margin) <= lookout.watched:
            lookout.watch(lookout.watched | _around(model, state.forces, numerics.ahead))
    model.imbalance(foot_x, best.angles)  # leaves the readings with the state that is returned
    return best


def fall(model: BeamModel, foot_x: float, start: State, numerics: Numerics) -> State:
    """Where the beam ends, without momentum, with the foot at `foot_x`; not yet at rest.

    Decides what Newton's method cannot: whether a vibrissa without a neighbouring equilibrium has
    let go. It goes down MuJoCo's own balance in steps as short as an inertia of a hundred times the
    stiffness makes them, until it has clearly left; ten times coarser, it lets go too early.

    Parameters
    ----------
    model : BeamModel
        The beam and the obstacle.
    foot_x : float
        Foot position [L].
    start : State
        The last state at rest.
    numerics : Numerics
        Constants of the way down.

    Returns
    -------
    State
        Without forces if the beam has left `start`.
    """
    model.lookout.watch(_around(model, start.forces, numerics.fall_reach) | _one_bead_a_link(model))
    newton = Newton(model, numerics)
    state, inertia = start, numerics.fall_inertia
    for _ in range(numerics.fall_steps):
        model.imbalance(foot_x, state.angles)
        after = newton.step(state, model.contacts(), inertia)
        if turned(after.angles, state.angles) < numerics.fallen:
            break
        if turned(after.angles, start.angles) > numerics.branch_turn:
            inertia = numerics.far_inertia
        state = after
    left = turned(state.angles, start.angles) > numerics.branch_turn
    return State(state.angles, {} if left else start.forces)


def _around(model: BeamModel, loaded: dict[int, float], reach: int) -> frozenset[int]:
    """The loaded beads and as many on either side; all past corners, where they are few."""
    count = len(model.layout.beads)
    if len(model.obstacle.corners):
        return frozenset(range(count) if loaded else ())
    return frozenset(
        i for bead in loaded for i in range(max(0, bead - reach), min(count, bead + reach + 1))
    )


def _one_bead_a_link(model: BeamModel) -> frozenset[int]:
    """They see a contact coming long before it is loaded."""
    links = model.layout.links
    return frozenset(np.flatnonzero(np.diff(links, append=links[-1] + 1)).tolist())
