"""One step of Newton's method on MuJoCo's own balance of moments.

Each step minimises the quadratic model of the energy, with the contacts' unilateral constraints
linearised; its stiffness includes what turning levers and turning normals contribute.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs
from scipy.optimize import nnls

from analytic.problem.arrays import Floats
from mujoco_models.errors import DivergedError
from mujoco_models.model.balance import Balance
from mujoco_models.model.contacts import Contacts
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.state import State, turned


class Touch(NamedTuple):
    """Where a bead is, and which way the obstacle faces it.

    Attributes
    ----------
    normal_angle : float
        Slope angle of the contour there [rad].
    position : array, shape (2,)
        Of the bead's centre [L].
    """

    normal_angle: float
    position: Floats


class Newton:
    """Newton's method, with what it remembers from one step to the next.

    Parameters
    ----------
    model : Balance
        Evaluated at the state that a step starts from.
    numerics : Numerics
        Constants.
    """

    def __init__(self, model: Balance, numerics: Numerics) -> None:
        self._model = model
        self._numerics = numerics
        self._last: dict[int, Touch] = {}

    def step(self, state: State, contacts: Contacts, inertia: float = 0.0) -> State:
        """The next iterate.

        Parameters
        ----------
        state : State
            The configuration in which the model is.
        contacts : Contacts
            MuJoCo's, of that configuration.
        inertia : float
            Makes the step shorter, in units of each joint's stiffness.

        Returns
        -------
        State
            With the imbalance of `state`: its own is not known yet.

        Raises
        ------
        DivergedError
            If the stiffness is not finite.
        """
        model, numerics = self._model, self._numerics
        contacts = contacts.nearest(numerics.at_once)
        curvature = self._curvature(contacts)
        layout = model.layout
        count = len(layout.joints)
        normal, distance = contacts.normal, contacts.distance
        slides = model.slides(contacts)
        on_side = contacts.on_side | slides
        lever = contacts.point[:, None] - model.joint_positions()
        carried = np.arange(count) <= contacts.link[:, None]
        along = (lever[:, :, 0] * normal[:, 1:] - lever[:, :, 1] * normal[:, :1]) * carried
        across = (lever[:, :, 0] * normal[:, :1] + lever[:, :, 1] * normal[:, 1:]) * carried
        force = self._forces(state, contacts)
        loaded = force > 0
        levers = along.copy()
        if slides.any():
            # Beads that slide stay about the point of tangency: all come nearer as it does.
            along[slides] = along[np.where(slides, distance, np.inf).argmin()]

        stiffness = np.diag((1 + inertia) * model.stiffness(state.angles))
        # The lever of a force turns with every joint below the outer one of two ...
        outer = np.maximum.outer(np.arange(count), np.arange(count))
        at_bead = np.where(on_side, 0.0, force)
        stiffness += (at_bead @ across)[outer]
        # ... and the normal turns as the bead slides along the contour.
        stiffness -= (at_bead * curvature * across.T) @ across
        # A corner stays where it is and the normal turns with the link: the inner joint counts.
        # So it does where beads slide, about the contour's centre of curvature.
        centre = across.copy()
        centre[slides] -= 1 / model.contact_curvature(contacts.slope[slides])[:, None]
        for i in np.flatnonzero(on_side & loaded):
            n = contacts.link[i] + 1
            stiffness[:n, :n] -= force[i] * centre[i, np.minimum.outer(np.arange(n), np.arange(n))]

        # Loaded contacts convexify the model; their slack is zero at rest, and so is the effect.
        held, slack = along[loaded], (distance + force / model.contact_stiffness)[loaded]
        stiffness += numerics.stiffening * held.T @ held
        gradient = -model.elastic_moments() + numerics.stiffening * held.T @ slack
        gradient += (along - levers).T @ np.maximum(-model.contact_stiffness * distance, 0)
        factor = _cholesky(stiffness, float(count))
        solved, _ = dpotrs(factor, np.column_stack([-gradient, along.T]), lower=1)
        free, compliance = solved[:, 0], solved[:, 1:]
        softness = np.eye(len(force)) / model.contact_stiffness
        forces = _unilateral(along @ compliance + softness, distance + along @ free)
        step = free + compliance @ forces
        turn = turned(step, np.zeros(count))
        return State(
            state.angles + step * min(1.0, numerics.largest_turn / max(turn, 1e-300)),
            {int(i): float(f) for i, f in zip(contacts.touch, forces, strict=True) if f > 0},
            state.imbalance,
        )

    def _forces(self, state: State, contacts: Contacts) -> Floats:
        """The forces of `state` at these contacts, shape (n,) [EI/L^2].

        As the beam slides, a corner passes from link to joint to link: what has lost it leaves its
        force to the nearest contact at the same corner or the same joint.
        """
        touch = np.where(contacts.fused, -1, contacts.touch)
        force = np.array([state.forces.get(i, 0.0) for i in touch.tolist()])
        slides = self._model.slides(contacts)
        if (slides & contacts.loaded).any() and not force[slides].any():
            force[np.where(slides, contacts.distance, np.inf).argmin()] = state.load
        if len(self._model.obstacle.corners) == 0:
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
        found = self._model.contact_curvature(angles)
        if not self._model.obstacle.faceted or len(self._model.obstacle.corners):
            return found
        now = {
            bead: Touch(float(angle), point.copy())
            for bead, angle, point in zip(
                contacts.touch.tolist(), angles, contacts.point, strict=True
            )
        }
        for i, (bead, touch) in enumerate(now.items()):
            before = self._last.get(bead)
            if before is not None:
                turn = touch.normal_angle - before.normal_angle
                slid = float(np.hypot(*(touch.position - before.position)))
                same = abs(turn) < self._numerics.same_normal
                found[i] = 0.0 if same else abs(turn) / slid
        self._last = now
        return found


def _cholesky(stiffness: Floats, scale: float) -> Floats:
    """Factor of the stiffness, or of the least shifted one that is positive definite."""
    if not np.isfinite(stiffness).all():
        raise DivergedError("the stiffness is not finite")
    shift = 0.0
    while True:
        factor, info = dpotrf(stiffness + shift * np.eye(len(stiffness)), lower=1)
        if info == 0:
            return np.asarray(factor)
        shift = max(2 * shift, 0.02 * scale)


def _unilateral(compliance: Floats, gap: Floats) -> Floats:
    """Contact forces f >= 0 that minimise f.compliance.f/2 + gap.f, shape (n,)."""
    if len(gap) == 0:
        return np.zeros(0)
    root = np.linalg.cholesky(compliance)
    return np.asarray(nnls(root.T, -np.linalg.solve(root, gap))[0])
