"""Coming to rest: Newton's method on MuJoCo's own balance of moments.

A station is settled when MuJoCo's springs and contacts, and nothing else, hold the beam to a
tolerance; how it got there does not matter, and time stepping to the same balance takes hundreds
of steps.
"""

from dataclasses import replace

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.clamp_path import Pose
from mujoco_models.model.balance import Balance
from mujoco_models.model.contact_side import contact_side
from mujoco_models.sweep.newton import Newton
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.secant import Secant
from mujoco_models.sweep.state import State, turned


def relax(
    model: Balance,
    pose: Pose,
    start: State,
    tolerance: float,
    numerics: Numerics,
    *,
    leave: State | None = None,
    stay: float | None = None,
    held: bool = False,
) -> State:
    """Bring the beam to rest in a pose of the clamp, from `start`."""
    lookout, obstacle = model.lookout, model.obstacle
    newton, secant = Newton(model, numerics), Secant()
    state = best = State(start.angles, start.forces)
    lookout.watch(around(model, state.forces, numerics.ahead) or one_bead_a_link(model))
    if start.slope is not None:
        lookout.face(start.slope)
    nearly, residual, vain, astray = numerics.nearly * tolerance, np.inf, 0, 0
    window = lookout.window
    for _ in range(numerics.iterations):
        if lookout.window != window:  # what came to rest by another one does not count
            window, best, vain = lookout.window, State(state.angles, state.forces), 0
        before, residual = residual, _largest(model.imbalance(pose, state.angles))
        contacts = model.contacts()
        if not held and model.slide_beads(contacts):
            residual = _largest(model.imbalance(pose, state.angles))
            contacts = model.contacts()
        imbalance = residual
        if tolerance <= residual < nearly:
            imbalance = _largest(model.relieved())
        state = State(state.angles, state.forces, imbalance)
        if state.imbalance < best.imbalance:
            best, vain = state, 0
        elif (vain := vain + 1) > numerics.in_vain:
            break
        if stay is not None:
            on = np.abs(contacts.slope - stay) < numerics.same_facet
            astray = 0 if (on & contacts.loaded).any() else astray + 1
            if astray > 1:
                break
        if state.imbalance < tolerance:
            if contacts.passed or lookout.is_crossed(model.joint_positions()):
                break  # a corner has gone through a link
            slopes = contacts.slope[contacts.loaded]
            if not obstacle.faces(slopes):
                break  # pushed out through the far side of the object: no state of the sweep
            twice = len(contacts.places(model.layout)) > 1
            if lookout.move_window(obstacle.place(slopes)):
                continue
            if unwatched := lookout.unwatched():
                # Twice as many each time: on a stiff contact all of them may carry a load.
                most = max(numerics.at_once, len(lookout.watched))
                lookout.watch(lookout.watched | spread(unwatched, most))
                best, vain = State(state.angles, state.forces), 0  # fewer beads' rest is none
                continue
            if (missed := lookout.overlooked(contacts)) is not None:
                lookout.use_window(obstacle.window_of(missed))
                continue
            if not twice and lookout.belied(contacts):
                continue
            depths = contacts.distance[contacts.loaded]
            slope = float(depths @ slopes / depths.sum()) if slopes.size else None
            return replace(state, settled=True, side=contact_side(model, contacts), slope=slope)
        stepped = newton.step(state, contacts)
        near = min(before, numerics.learns * (1 + state.load))
        if numerics.slow * before < residual < near:
            step = secant.better(state.angles, stepped.angles - state.angles)
            stepped = replace(stepped, angles=state.angles + step)
        else:
            secant = Secant()
        state = stepped
        if leave is not None and turned(state.angles, leave.angles) > numerics.left_turn:
            break
        if not around(model, state.forces, numerics.margin) <= lookout.watched:
            lookout.watch(lookout.watched | graded(model, state.forces, numerics.ahead))
    model.imbalance(pose, best.angles)  # leaves the readings with the state that is returned
    imbalance = min(best.imbalance, _largest(model.relieved()))
    return replace(best, imbalance=imbalance, side=contact_side(model, model.contacts()))


def _largest(moments: Floats) -> float:
    return float(np.abs(moments).max())


def around(model: Balance, loaded: dict[int, float], reach: int) -> frozenset[int]:
    """The loaded beads, and as many on either side; all past corners, where they are few."""
    count = len(model.layout.beads)
    if len(model.obstacle.corners):
        return frozenset(range(count) if loaded else ())
    return frozenset(
        i for bead in loaded for i in range(max(0, bead - reach), min(count, bead + reach + 1))
    )


def graded(model: Balance, loaded: dict[int, float], reach: int) -> frozenset[int]:
    """Those `around` the loaded beads, and ever fewer ones farther out.

    A load that has to pass over hundreds of beads is then in a few steps where it belongs.
    """
    count = len(model.layout.beads)
    first, last = min(loaded), max(loaded)
    out = 2 ** np.arange(count.bit_length())
    out = out[out > reach]
    far = np.concatenate([first - out, last + out])
    return around(model, loaded, reach) | frozenset(far[(far >= 0) & (far < count)].tolist())


def spread(beads: frozenset[int], count: int) -> frozenset[int]:
    """So many of these beads, from the first one to the last.

    A beam that has sprung through the obstacle touches with thousands, and rests on a few of them.
    """
    every = -(-len(beads) // count)
    return frozenset(sorted(beads)[::every])


def one_bead_a_link(model: Balance) -> frozenset[int]:
    """The last bead of each link: they see a contact coming long before it is loaded."""
    links = model.layout.links
    return frozenset(np.flatnonzero(np.diff(links, append=links[-1] + 1)).tolist())
