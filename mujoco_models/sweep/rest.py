"""Coming to rest: Newton's method on MuJoCo's own balance of moments.

A station is settled when MuJoCo's springs and contacts, and nothing else, hold the beam to a
tolerance; how it got there is of no account, and time stepping to the same balance takes hundreds
of steps. Each step minimises the quadratic model of the energy, with the contacts' unilateral
constraints linearised; its stiffness includes what turning levers and turning normals contribute.
"""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg.lapack import dpotrf, dpotrs
from scipy.optimize import nnls

from analytic.problem.arrays import Floats
from mujoco_models.errors import DivergedError
from mujoco_models.model.model import BeamModel, Contacts

_ITERATIONS = 25
_STIFFENING = 1e3  # EI/L^3; loaded contacts convexify the quadratic model, without effect at rest
_LARGEST_TURN = 0.3  # rad, of any link in one step
_SAME_NORMAL = 1e-9  # rad; what rounding makes of a facet's normal
_AHEAD = 4  # beads beyond the loaded ones that take part in collisions
_MARGIN = 2  # beads beyond the loaded ones that must do so
_LEFT = 0.35  # rad; a link that has turned farther has left the branch
_FALL_REACH = 16
_FALL_STEPS = 5000
_FALL_INERTIA, _FAR_INERTIA = 100.0, 4.0  # of each joint's stiffness, before it has left and after
_FALLEN = 1e-10  # rad; a step shorter than this has come to rest


@dataclass(frozen=True)
class State:
    """A configuration of the beam.

    Attributes
    ----------
    angles : array, shape (n_joints,)
        Joint angles [rad].
    forces : dict
        Contact force by bead [EI/L^2].
    imbalance : float
        Largest moment out of balance at any joint [EI/L].
    settled : bool
        Whether that is below the tolerance, with the whole beam looking at the obstacle.
    """

    angles: Floats
    forces: dict[int, float]
    imbalance: float = np.inf
    settled: bool = False

    @classmethod
    def straight(cls, joints: int) -> "State":
        """The unloaded beam."""
        return cls(np.zeros(joints), {})

    @property
    def loaded_bead(self) -> float:
        """Mean number of the loaded beads, weighed by their forces."""
        return sum(i * f for i, f in self.forces.items()) / sum(self.forces.values())


def relax(model: BeamModel, foot_x: float, start: State, tolerance: float) -> State:
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

    Returns
    -------
    State
        Not settled if Newton's method did not get there; the caller takes smaller steps then.
    """
    state = best = start
    model.watch(_around(model, state.forces, _AHEAD) or _lookout(model))
    if state.forces:
        model.anticipate_window()
    last: dict[int, Touch] = {}
    for _ in range(_ITERATIONS):
        residual = float(np.abs(model.imbalance(foot_x, state.angles)).max())
        contacts = model.contacts()
        state = replace(state, imbalance=residual)
        best = min(best, state, key=lambda s: s.imbalance)
        if residual < tolerance:
            normals = contacts.normal[contacts.distance < 0]
            if not model.obstacle.faces(_slopes(normals)):
                break  # pushed out through the far side of the object: no state of the sweep
            loaded = model.obstacle.place(_slopes(normals))
            if _move_window(model, loaded):
                continue
            if unwatched := model.near_the_obstacle() - model.watched:
                model.watch(model.watched | unwatched)
                continue
            if (missed := model.overlooked()) is not None:
                model.use_window(model.obstacle.window_of(missed))
                continue
            if loaded.size:
                model.leave_trail(float(loaded.mean()))
            return replace(state, settled=True)
        touches = _touches(model, contacts)
        state = _newton_step(model, state, contacts, _curvatures(model, touches, last))
        last = touches
        if not _around(model, state.forces, _MARGIN) <= model.watched:
            model.watch(model.watched | _around(model, state.forces, _AHEAD))
    model.imbalance(foot_x, best.angles)  # leaves the readings with the state that is returned
    return best


def fall(model: BeamModel, foot_x: float, start: State) -> State:
    """Where the beam ends, without momentum, with the foot at `foot_x`; not yet at rest.

    Decides what Newton's method cannot: whether a vibrissa without a neighbouring equilibrium has
    let go. It goes down MuJoCo's own balance in steps as short as an inertia of a hundred times the
    stiffness makes them, until it has clearly left; ten times coarser, it lets go too early.
    """
    model.watch(_around(model, start.forces, _FALL_REACH) | _lookout(model))
    state, inertia = start, _FALL_INERTIA
    last: dict[int, Touch] = {}
    for _ in range(_FALL_STEPS):
        model.imbalance(foot_x, state.angles)
        contacts = model.contacts()
        touches = _touches(model, contacts)
        after = _newton_step(model, state, contacts, _curvatures(model, touches, last), inertia)
        if turned(after.angles, state.angles) < _FALLEN:
            break
        if turned(after.angles, start.angles) > _LEFT:
            inertia = _FAR_INERTIA
        state, last = after, touches
    left = turned(state.angles, start.angles) > _LEFT
    return State(state.angles, {} if left else start.forces)


def turned(angles: Floats, before: Floats) -> float:
    """The farthest that any link has turned [rad]."""
    return float(np.abs(np.cumsum(angles - before)).max())


def _around(model: BeamModel, loaded: dict[int, float], reach: int) -> frozenset[int]:
    count = len(model.layout.beads)
    return frozenset(
        i for bead in loaded for i in range(max(0, bead - reach), min(count, bead + reach + 1))
    )


def _lookout(model: BeamModel) -> frozenset[int]:
    """One bead a link, which see a contact coming long before it is loaded."""
    links = model.layout.links
    return frozenset(np.flatnonzero(np.diff(links, append=links[-1] + 1)).tolist())


def _move_window(model: BeamModel, loaded: Floats) -> bool:
    """See to it that all load rests on full resolution; True if the mesh had to be changed."""
    if loaded.size == 0 or model.obstacle.is_inside(model.window, loaded):
        return False
    best = model.obstacle.window_of(float(loaded.mean()))
    if best == model.window:
        return False
    model.use_window(best)
    return True


def _slopes(normal: Floats) -> Floats:
    """Slope angles of the contour with these normals, shape (n,) [rad]."""
    angles: Floats = np.arctan2(normal[:, 0], -normal[:, 1])
    return angles


class Touch(NamedTuple):
    """Where a bead is, and which way the obstacle faces it."""

    normal_angle: float
    position: Floats


def _touches(model: BeamModel, contacts: Contacts) -> dict[int, Touch]:
    angles = _slopes(contacts.normal)
    places = model.bead_positions(contacts.bead)
    return {
        bead: Touch(float(angle), place.copy())
        for bead, angle, place in zip(contacts.bead.tolist(), angles, places, strict=True)
    }


def _curvatures(model: BeamModel, now: dict[int, Touch], last: dict[int, Touch]) -> Floats:
    """How fast each contact's normal turns as the bead slides, shape (n_contacts,) [1/L].

    On a faceted obstacle a bead sees a polygon: no turn along a facet, all of it within 1e-8 L at a
    vertex. Only the secant through the last two iterates sees what is at hand; with the contour's
    mean curvature Newton's method can jump for ever between a vertex's two facets.
    """
    found = model.contact_curvature(np.array([touch.normal_angle for touch in now.values()]))
    if not model.obstacle.faceted:
        return found
    for i, (bead, touch) in enumerate(now.items()):
        before = last.get(bead)
        if before is not None:
            turn = touch.normal_angle - before.normal_angle
            slid = float(np.hypot(*(touch.position - before.position)))
            found[i] = 0.0 if abs(turn) < _SAME_NORMAL else abs(turn) / slid
    return found


def _newton_step(
    model: BeamModel, state: State, contacts: Contacts, curvature: Floats, inertia: float = 0.0
) -> State:
    """One step; `inertia`, in units of each joint's stiffness, makes it shorter."""
    layout = model.layout
    count = len(layout.joints)
    bead, normal, distance = contacts
    lever = model.bead_positions(bead)[:, None] - model.joint_positions()
    carried = np.arange(count) <= layout.links[bead][:, None]
    along = (lever[:, :, 0] * normal[:, 1:] - lever[:, :, 1] * normal[:, :1]) * carried
    across = (lever[:, :, 0] * normal[:, :1] + lever[:, :, 1] * normal[:, 1:]) * carried
    force = np.array([state.forces.get(i, 0.0) for i in bead.tolist()])
    loaded = force > 0

    stiffness = np.diag((1 + inertia) * model.beam.stiffness(state.angles))
    # The lever of a force turns with every joint below the outer one of two ...
    outer = np.maximum.outer(np.arange(count), np.arange(count))
    stiffness += (force @ across)[outer]
    # ... and the normal turns as the bead slides along the contour.
    stiffness -= (force * curvature * across.T) @ across

    # The loaded contacts convexify the model; at rest their slack is zero, and so is the effect.
    held, slack = along[loaded], (distance + force / model.contact_stiffness)[loaded]
    stiffness += _STIFFENING * held.T @ held
    gradient = -model.elastic_moments() + _STIFFENING * held.T @ slack
    factor = _cholesky(stiffness, float(count))
    solved, _ = dpotrs(factor, np.column_stack([-gradient, along.T]), lower=1)
    free, compliance = solved[:, 0], solved[:, 1:]
    forces = _unilateral(
        along @ compliance + np.eye(len(bead)) / model.contact_stiffness, distance + along @ free
    )
    step = free + compliance @ forces
    turn = turned(step, np.zeros(count))
    return State(
        state.angles + step * min(1.0, _LARGEST_TURN / max(turn, 1e-300)),
        {int(i): float(f) for i, f in zip(bead, forces, strict=True) if f > 0},
        state.imbalance,
    )


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
