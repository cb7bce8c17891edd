"""Where a beam will rest whose beads share the load of a sharp contour.

There the beam slides along the contour almost freely, and each facet has a state at rest of its
own: Newton's method goes past one after the other. The solver's own surrogate knows its energy, and
so what is a step down.
"""

from dataclasses import replace

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.clamp_path import Pose
from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts
from mujoco_models.sweep.newton import Newton
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.secant import Secant
from mujoco_models.sweep.state import State, turned
from mujoco_models.sweep.surrogate import Surrogate

_STEPS = 40  # twelve are usual, and more than forty as dear as the engine's own way
_AT_REST = 1e-11  # rad; the step is what the energy still asks for, and rounding is 1e-15
_ON_A_FACET = 1e-5  # rad; nearer than that, steps change from facet to facet no more
_STRIDE = 1e-3  # rad; up to that a step may double: facet by facet it takes ten times as many
_SHORTER = (1.0, 0.25, 0.0625)  # steps that are tried in turn
_ROUNDING = 4e-16  # of the energy


class _OnFacets(Newton):
    """Newton's method as if the facets that beads are on went on for ever.

    At a vertex the energy is less than that: a step that goes down there goes down here.
    """

    def _curvature(self, contacts: Contacts) -> Floats:
        return np.zeros(len(contacts.distance))


def minimum(model: Balance, pose: Pose, start: State, numerics: Numerics) -> State | None:
    """The minimum of the energy that is down from `start`, in a pose of the clamp."""
    if len(model.obstacle.corners):
        return None
    surrogate = Surrogate(model, start.forces, numerics.ahead, follow=True)
    newton, secant = _OnFacets(surrogate, numerics), Secant()
    angles = start.angles
    for _ in range(_STEPS):
        contacts = surrogate.look(pose, angles)
        if contacts is None:
            return None
        slope = float(contacts.slope[contacts.distance.argmin()])
        # On the side that is foreseen it is pushed out where it has come from, however deep it is.
        elsewhere = start.slope is None or abs(slope - start.slope) > numerics.largest_shift
        if elsewhere and surrogate.is_inside(contacts):
            return None
        model.lookout.follow_contact(contacts)
        pressed = np.flatnonzero(contacts.loaded)
        force = (-surrogate.contact_stiffness * contacts.distance[pressed]).tolist()
        state = State(angles, dict(zip(contacts.touch[pressed].tolist(), force, strict=True)))
        step = newton.step(state, contacts).angles - angles
        turn = turned(step, np.zeros(len(step)))
        near = replace(state, slope=slope)
        if turn < _AT_REST:
            if model.lookout.move_window(model.obstacle.place(contacts.slope[pressed])):
                continue  # all that share the load are to be seen as the engine will see them
            return near
        places = [angles + scale * step for scale in _SHORTER]
        if turn < _ON_A_FACET:
            places.insert(0, angles + secant.better(angles, step))
        most = surrogate.energy(contacts) * (1 + _ROUNDING)
        tried = ((place, _energy(surrogate, pose, place)) for place in places)
        lower = next(((place, energy) for place, energy in tried if energy <= most), None)
        if lower is None:
            return near if turn < _ON_A_FACET else None
        there, energy = lower
        while _ON_A_FACET <= turn < _STRIDE:
            beyond = 2 * there - angles
            farther = _energy(surrogate, pose, beyond)
            if farther >= energy:
                break
            turn, there, energy = 2 * turn, beyond, farther
        angles = there
        if turned(angles, start.angles) > numerics.left_turn:
            return State(angles, {})  # it lets go, if the engine says so
    return near


def _energy(surrogate: Surrogate, pose: Pose, angles: Floats) -> float:
    contacts = surrogate.look(pose, angles)
    return np.inf if contacts is None else surrogate.energy(contacts)
