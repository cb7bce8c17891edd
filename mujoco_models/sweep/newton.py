"""One step of Newton's method on MuJoCo's own balance of moments.

Each step minimises the quadratic model of the energy, with the contacts' unilateral constraints
linearised; its stiffness includes what turning levers and turning normals contribute. Unknown are
the turns of the links, not of the joints between them, which makes a step linear in the segments.
"""

from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Booleans, Complexes, Floats, Integers
from mujoco_models.model.balance import Mechanics
from mujoco_models.model.contacts import Contacts
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.state import State
from mujoco_models.sweep.stiffness import Stiffness
from mujoco_models.sweep.unilateral import unilateral


class Touch(NamedTuple):
    """Where beads are, and which way the obstacle faces them."""

    bead: Integers  # shape (n,); Their numbers
    normal_angle: Floats  # shape (n,); Slope angles of the contour there [rad]
    position: Floats  # shape (n, 2); Of their centres [L]


class Newton:
    """Newton's method, with what it remembers from one step to the next."""

    def __init__(self, model: Mechanics, numerics: Numerics) -> None:
        self._model = model
        self._numerics = numerics
        self._cornered = len(model.obstacle.corners) > 0
        self._last: Touch | None = None
        self._doubled = 0  # of the addition to the springs in the last step

    def step(self, state: State, contacts: Contacts, inertia: float = 0.0) -> State:
        """The next iterate."""
        model, numerics = self._model, self._numerics
        contacts = contacts.nearest(max(numerics.at_once, 2 * len(state.forces)))
        curvature = self._curvature(contacts)
        along, across = levers(contacts, model.joint_positions())
        slides = model.slides(contacts)
        sliding = np.count_nonzero(slides) > 0
        distance, force = contacts.distance, self._forces(state, contacts, slides)
        comes = along
        if sliding:
            # Beads that slide stay about the point of tangency: all come nearer as it does.
            comes = along.copy()
            comes[slides] = along[np.where(slides, distance, np.inf).argmin()]

        # A part of each loaded contact's stiffness convexifies the model, the rest is compliance.
        loaded = force > 0
        faceted = model.obstacle.faceted
        part = numerics.stiffening_of_facets if faceted else numerics.stiffening
        part = min(part, model.contact_stiffness / 2)
        rest = model.contact_stiffness - part * loaded
        pressed = loaded.nonzero()[0]
        held = comes.take(pressed, axis=0)
        moments = of_links(model.elastic_moments()) - part * distance.take(pressed) @ held
        layout, heavy = model.layout, any(model.layout.vibrissa.weight)
        if heavy:
            headings = layout.headings + (model.pose.angle + state.angles.cumsum())
            weight, hangs = layout.weigh(headings)
            moments += weight
        if sliding:
            moments -= np.maximum(-model.contact_stiffness * distance, 0) @ (comes - along)
        springs = (1 + inertia) * model.stiffness(state.angles)
        stiffness = self._stiffness(springs, contacts, slides, force, curvature, across, held, part)
        if heavy:
            stiffness.links[:] += hangs
        rows = np.concatenate([moments[None], comes])
        turns, self._doubled = stiffness.solve(rows, self._doubled)
        freely, by_force = turns[0], turns[1:]
        forces = unilateral(comes, by_force, 1 / rest, distance + comes @ freely, loaded)
        step = freely + forces @ by_force
        whole = forces * model.contact_stiffness / rest
        shorter = min(1.0, numerics.largest_turn / max(step.max(), -step.min(), 1e-300))
        step[1:] -= step[:-1].copy()
        return State(
            state.angles + shorter * step,
            {i: f for i, f in zip(contacts.touch.tolist(), whole.tolist(), strict=True) if f > 0},
            state.imbalance,
        )

    def _stiffness(
        self,
        springs: Floats,
        contacts: Contacts,
        slides: Booleans,
        force: Floats,
        curvature: Floats,
        across: Floats,
        held: Floats,
        stiff: float,
    ) -> Stiffness:
        """That of the springs, of turning levers and normals, and of what is held in contact."""
        on_side = contacts.on_side | slides
        # The lever of a force turns with each link ...
        links = force @ across
        # ... and the normal turns as a bead slides along the contour.
        turns = -force * curvature
        turning = np.where(on_side, 0.0, turns).nonzero()[0]
        directions = [held, across.take(turning, axis=0)]
        weights = [stiff] * len(held) + turns.take(turning).tolist()
        # A corner stays where it is and the normal turns with its link; so it does where beads
        # slide, about the contour's centre of curvature.
        for i in (on_side & (force > 0)).nonzero()[0]:
            own, couple = int(contacts.link[i]), -force[i] * across[i]
            links[own] += 2 * couple[own]
            if slides[i]:
                links[own] += force[i] / self._model.contact_curvature(contacts.slope[[i]])[0]
            couple[own:] = 0.0
            if size := float(np.linalg.norm(couple)):
                link = np.zeros(len(couple))
                link[own] = size
                directions += [(couple + link)[None], (couple - link)[None]]
                weights += [0.5 / size, -0.5 / size]
        return Stiffness(springs, links, np.concatenate(directions), np.array(weights))

    def _forces(self, state: State, contacts: Contacts, slides: Booleans) -> Floats:
        """The forces of `state` at these contacts, shape (n,) [EI/L^2].

        As the beam slides, a corner passes from link to joint to link: what has lost it leaves its
        force to the nearest contact at the same corner or the same joint.
        """
        touch = np.where(contacts.fused, -1, contacts.touch) if self._cornered else contacts.touch
        force = np.array([state.forces.get(i, 0.0) for i in touch.tolist()])
        if not self._cornered:
            if np.count_nonzero(slides & contacts.loaded) and not force[slides].any():
                force[np.where(slides, contacts.distance, np.inf).argmin()] = state.load
            return force
        beads, links = len(self._model.layout.beads), len(self._model.layout.joints)
        corner, link = np.divmod(touch - beads, links)
        is_bead, is_side = (touch >= 0) & (touch < beads), touch >= beads
        for lost in state.forces.keys() - set(touch.tolist()):
            if lost < beads:  # the bead at the end of that link
                heirs = is_side & ((link == lost) | (link == lost + 1))
            else:
                at, on = divmod(lost - beads, links)
                heirs = is_side & (corner == at) | is_bead & ((touch == on) | (touch == on - 1))
            if heirs.any():
                nearest = np.where(heirs, contacts.distance, np.inf).argmin()
                force[nearest] += state.forces[lost]
        return force

    def _curvature(self, contacts: Contacts) -> Floats:
        """How fast each contact's normal turns as the bead slides, shape (n_contacts,) [1/L].

        On a faceted obstacle a bead sees a polygon: no turn along a facet, all of it within 1e-8 L
        at a vertex. Only the secant through the last two iterates sees what is at hand; with the
        contour's mean curvature Newton's method can jump for ever between a vertex's two facets.
        Sharp corners are known to the obstacle.
        """
        angles = contacts.slope
        if not self._model.obstacle.faceted or self._cornered:
            return self._mean_curvature(contacts.distance, angles)
        before = self._last
        now = self._last = Touch(contacts.touch, angles, contacts.point)
        if before is None or len(before.bead) == 0:
            return self._mean_curvature(contacts.distance, angles)
        known: Booleans | bool = True
        if now.bead is not before.bead:
            row = {bead: i for i, bead in enumerate(before.bead.tolist())}
            old = np.array([row.get(bead, -1) for bead in now.bead.tolist()], dtype=int)
            known, before = old >= 0, Touch(*(part[old] for part in before))
        turn = np.abs(angles - before.normal_angle)
        turn *= turn >= self._numerics.same_normal
        slid = np.abs(in_plane(now.position - before.position))
        moved = known & (slid > 0)  # or another window shows the same place
        if np.count_nonzero(moved) == len(moved):
            return np.asarray(turn / slid)
        found = self._mean_curvature(contacts.distance, angles)
        np.divide(turn, slid, out=found, where=moved)
        return found

    def _mean_curvature(self, distance: Floats, slope: Floats) -> Floats:
        """That of the contour about the places with these slope angles, as deep as beads are."""
        found = self._model.contact_curvature(slope)
        found /= 1 + found * np.minimum(distance, 0)
        found *= self._model.obstacle.across(slope)
        return found


def levers(contacts: Contacts, joints: Floats) -> tuple[Floats, Floats]:
    """How the contacts' points move as each link turns alone."""
    # From joint to joint, and from where a contact's link begins straight to the contact. An arrow
    # times the conjugate of the normal is what of it is along the normal, and across to the left.
    places, count = in_plane(joints), len(joints)
    beyond = np.arange(count + 1) > contacts.link[:, None]
    way = np.where(beyond, in_plane(contacts.point)[:, None], np.append(places, 0))
    arm = (way[:, 1:] - way[:, :-1]) * in_plane(contacts.normal).conj()[:, None]
    return -arm.imag, arm.real


def in_plane(vectors: Floats) -> Complexes:
    """Vectors of the plane as complex numbers."""
    return np.ascontiguousarray(vectors).view(complex)[:, 0]


def of_links(moments: Floats) -> Floats:
    """Generalised forces of the links' own angles, from those of the joints between them."""
    found = moments.copy()
    found[:-1] -= moments[1:]
    return found
