r"""A vibrissa that slides along a body in space, or sticks to it, at rest.

One dead force F = f (n + rub), n the body's normal and rub, along its surface, friction over the
normal force, bends a thin, straight, isotropic vibrissa in one plane, that of its clamp's tangent t
and F, wherever friction points. In that plane it is the elastica of `analytic.space.solver.contact`
with the direction of F in the place of the normal. Where F is along t, which sweeps pass, it does
not say in which plane: so the direction e, in it and across t, is of the state.

The force acts on the axis. With a radius r the body is thicker by it, and what that leaves out is a
moment of at most r f |rub|, a part of which twists.
"""

from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.numerics.vectors import cross
from analytic.space.problem.bodies.body import across
from analytic.space.solver.contact import APART, Contact, Loaded, Plane, Scene, loaded_part

RUB, PSI, ROTATION, LENGTH, TRAVEL = slice(2, 4), 4, 5, 6, 7
"""Among rates: of friction along `across` the normal, e's turn, and what `State` calls so; the
first two are those of the place on the parallel surface, along the same."""
TURNED = 9  # the rotation's place in a state's vector
BY_TRAVEL = np.eye(12)[-1]


class Leg(NamedTuple):
    """A straight part of the foot's way, as if it had no end."""

    begin: Floats  # the foot's place, shape (3,)
    onward: Floats  # direction, of length 1
    travel: float  # up to there [L]

    def foot(self, travel: float) -> Floats:
        return np.asarray(self.begin + (travel - self.travel) * self.onward)


class Sliding(NamedTuple):
    """A state, and what it is made of."""

    contact: Contact  # its plane's normal is the direction of the force
    rub: Floats  # shape (3,)
    rotation: float  # of the loaded part's end, from the clamp's tangent towards e [rad]
    travel: float  # of the foot [L]
    end: Floats  # direction of the vibrissa at the contact, shape (3,)
    sides: Floats  # along the body, shape (2, 3)
    beside: Floats  # normal to the plane, shape (3,)
    turned: Floats  # how the normal turns with the place, by `sides`, shape (3, 2)
    moved: Floats  # how the vibrissa's axis moves with it, likewise

    @property
    def vector(self) -> Floats:
        """All of it, shape (12,): place on the parallel surface, rub, e, and three numbers."""
        contact = self.contact
        numbers = self.rotation, contact.arc_length, self.travel
        return np.concatenate(
            [contact.on_parallel, self.rub, contact.plane.lateral, np.array(numbers)]
        )

    @property
    def leans_in(self) -> float:
        """How far the vibrissa points into the body at the contact: 0 if it is tangential."""
        return -float(self.end @ self.contact.spot.normal)


def state_of(scene: Scene, vector: Floats, tangent: bool) -> Sliding:
    """The state of such a vector; what must be across another is made so."""
    rotation, arc_length, travel = vector[9:].tolist()
    spot, t = scene.body.nearest(vector[:3], APART), scene.tangent
    rub, lateral = _across(vector[3:6], spot.normal), _across(vector[6:9], t)
    lateral = lateral / np.sqrt(lateral @ lateral)
    force = (spot.normal + rub) / np.sqrt(1 + rub @ rub)
    alpha = float(np.arctan2(force @ lateral, -(force @ t)))
    excess = rotation - max(0.0, -2 * alpha)
    loaded = loaded_part(excess, alpha) if excess != 0 else _STRAIGHT
    centre = spot.point + scene.radius * spot.normal
    plane = Plane(t, force, lateral, alpha)
    contact = Contact(spot, plane, loaded, excess, arc_length, tangent, centre)
    end = np.cos(rotation) * t + np.sin(rotation) * lateral
    sides = across(spot.normal)
    turned = spot.turning @ sides.T
    moved = sides.T - (APART - scene.radius) * turned
    return Sliding(contact, rub, rotation, travel, end, sides, cross(t, lateral), turned, moved)


def changed(state: Sliding, rates: Floats) -> Floats:
    """Rate of a state's vector."""
    place, turned = rates[:2] @ state.sides, state.turned @ rates[:2]
    rub = rates[RUB] @ state.sides - (state.rub @ turned) * state.contact.spot.normal
    lateral = rates[PSI] * state.beside
    return np.concatenate([place, rub, lateral, rates[[ROTATION, LENGTH, TRAVEL]]])


def _across(vector: Floats, normal: Floats) -> Floats:
    """The part of a vector that is across a normal."""
    return np.asarray(vector - (vector @ normal) * normal)


def equations(state: Sliding, onward: Floats) -> Floats:
    """Rates of what vanishes at rest, shape (5, 8)."""
    contact = state.contact
    plane, loaded, s = contact.plane, contact.loaded, contact.arc_length
    normal, t, e, rub = contact.spot.normal, plane.tangent, plane.lateral, state.rub
    turned, beside, size = state.turned, state.beside, np.sqrt(1 + rub @ rub)
    force = np.empty((3, 4))  # how its direction turns with the place and friction
    force[:, :2] = (turned - np.outer(normal, rub @ turned)) / size
    force[:, 2:] = (state.sides.T - np.outer(plane.normal, state.sides @ rub) / size) / size
    by_alpha = loaded.by_alpha if plane.alpha >= 0 else loaded.by_alpha + 2 * loaded.by_rotation
    both = np.stack([t, e], axis=1)
    found = np.zeros((5, 8))
    found[:3, :4] = -s * np.outer(both @ by_alpha, plane.along @ force)
    found[:3, :2] += state.moved
    found[:3, PSI] = -s * loaded.place[1] * beside
    found[:3, ROTATION] = -s * (both @ loaded.by_rotation)
    found[:3, LENGTH] = -(both @ loaded.place)
    found[:3, TRAVEL] = -onward
    found[3, :4] = beside @ force
    found[3, PSI] = -np.sin(plane.alpha)
    if contact.tangent:
        found[4] = normal @ end_rates(state)
        found[4, :2] = state.end @ turned
    else:
        found[4, LENGTH] = 1.0
    return found


def end_rates(state: Sliding) -> Floats:
    """Rates of the vibrissa's direction at the contact, shape (3, 8)."""
    plane, sine, cosine = state.contact.plane, np.sin(state.rotation), np.cos(state.rotation)
    found = np.zeros((3, 8))
    found[:, PSI] = sine * state.beside
    found[:, ROTATION] = cosine * plane.lateral - sine * plane.tangent
    return found


def grows(state: Sliding, by: Floats) -> Floats:
    """Rates of a sum of parts of the vector, shape (8,)."""
    sides, normal = state.sides, state.contact.spot.normal
    place = sides @ by[:3] - (by[3:6] @ normal) * (state.rub @ state.turned)
    return np.concatenate([place, sides @ by[3:6], [by[6:9] @ state.beside], by[9:]])


_STRAIGHT = Loaded(
    0.0, 0.0, np.array([1.0, 0.0]), np.zeros(2), np.array([0.0, 2 / 3]), 0.0, np.zeros(2)
)
"""Of a vibrissa that has just touched: its end turns by P/2, and moves across by P/3."""
