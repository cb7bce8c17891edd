"""Newton's method on MuJoCo's own balance in space, and stability.

The vibrissa touches in one place, a bead on its axis at the arc length s. Let d be the distance of
the bead from the body and f the force; unknown are the joints' turns q, f and, unless the bead is
at the tip or at a joint that protrudes, s:

    springs(q) = f d_q,    d = -f/k,    d_s = 0.

The last line says that the bead is the point of its link nearest to the body, so that the rigid
link touches tangentially. Eliminating f and s leaves the second derivative of the energy of the
vibrissa and its elastic contact; where that is positive the equilibrium is stable.
"""

from typing import NamedTuple

import mujoco
import numpy as np
from scipy.linalg import eigh
from scipy.linalg.lapack import dgesv, dpotrf, dpotrs

from analytic.numerics.arrays import Floats
from analytic.numerics.vectors import cross
from mujoco_models.space.model import SpaceModel, Touch
from mujoco_models.space.surface import Surface

_ITERATIONS, _QUICK = 30, 14  # on one face or edge, which is smooth
SHARE = 0.3
"""Of the tolerance, that Newton's method may leave; the rest is for MuJoCo's own rounding."""
_LARGEST_TURN = 0.1  # rad, of a link in one step
_OUTWARD = 1e-12  # cosine; rounding of what is tangential
_SAME = 1e-13  # L
_FLATTEST = 1e-9  # 1/L, curvature given to a flat face along the vibrissa
_NEAR = (
    1e-3  # L off the body, beyond which a bead stays where it is on its link, or goes on sliding
)
_ROUNDING = 4e-15  # L, of a distance
_POWER_STEPS = 8
_STRAIGHT = 1e-14  # EI/L, of a spring: rounding


class State(NamedTuple):
    """A configuration, and the contact that Newton's method has for it; lengths in L."""

    configuration: Floats  # MuJoCo's coordinates, shape (nq,)
    link: int  # the link that carries the bead
    s: float  # arc length of the bead [L]
    force: float  # of the contact [EI/L^2]
    # Whether the bead is where its link is tangential, or at the tip or a joint that protrudes
    sliding: bool


class Linearised(NamedTuple):
    """The equations of balance and their derivatives at a state; lengths in L."""

    touch: Touch
    turning: Floats
    push: Floats  # d_q, shape (nv,)
    moved: Floats  # how the bead moves with the turns, shape (nv, 3) [L]
    slope: float  # d_s
    rolling: Floats  # d_qs, shape (nv,)
    along: float  # d_ss
    stiffness: Floats  # second derivative of the Lagrangian, shape (nv, nv)
    springs: Floats
    own: Floats  # of the stiffness, what a velocity's own spring has, shape (nv,) [EI/L]

    def curvature(self, state: State) -> Floats:
        """The same with the bead where its link is nearest to the body, if it slides."""
        if not state.sliding:
            return self.stiffness
        share = state.force / max(self.along, _FLATTEST)
        return np.asarray(self.stiffness + share * np.outer(self.rolling, self.rolling))


class Balance:
    """The equations of balance on a model."""

    def __init__(self, model: SpaceModel, tolerance: float) -> None:
        self.model, self._tolerance = model, tolerance
        self._k = model.contact_stiffness
        # Half of what counts twice: a joint's own, of velocities that turn about shared axes.
        joint, size = model.joint_of, len(model.joint_of)
        self._each = size // len(model.ends)  # velocities of a joint
        before = np.triu(np.ones((size, size)), 1) + np.eye(size) / 2
        if model.shared:
            before[joint[:, None] == joint] = 0.5
        self._before = before

    def converge(self, state: State, surface: Surface, foot: Floats) -> tuple[State, Touch] | None:
        """The equilibrium to which Newton's method leads."""
        model = self.model
        for _ in range(_ITERATIONS if surface.feature is None else _QUICK):
            state, touch = self.seen(state, surface, foot)
            slope = float(touch.normal @ model.direction(state.link))
            push = self.push(state.link, touch)
            out_of_balance = float(np.abs(model.springs + state.force * push).max())
            missed = self._k * abs(touch.distance + state.force / self._k)
            skewed = abs(slope) * state.force if state.sliding else 0.0
            if not np.isfinite(out_of_balance + missed + skewed):
                return None
            allowed = SHARE * self._tolerance + model.shape.blur * state.force
            if (
                max(out_of_balance, skewed) < allowed + _ROUNDING * self._k
                and missed < allowed + (_ROUNDING + model.shape.off) * self._k
            ):
                return state, touch
            step = self._step(state, self._derivatives(state, touch, surface))
            if step is None:
                return None
            state = step
        return None

    def along(self, state: State, surface: Surface, by: Floats) -> State:
        """The first step, as the foot moves, by the equations at the start."""
        model = self.model
        touch = surface.touch(state.link, state.s)
        system = self._derivatives(state, touch, surface)
        turned = system.turning @ by
        moved = system._replace(
            touch=touch._replace(distance=touch.distance + float(touch.normal @ by)),
            springs=system.springs + state.force * (system.moved @ turned),
            slope=system.slope + float(turned @ model.direction(state.link)),
        )
        return self._step(state, moved) or state

    def seen(self, state: State, surface: Surface, foot: Floats) -> tuple[State, Touch]:
        """Where the bead of a state is."""
        self.model.place(foot, state.configuration)
        state = self._inward(state)
        touch = surface.touch(state.link, state.s)
        if abs(touch.distance + state.force / self._k) < _NEAR and state.force > 0:
            slope = float(touch.normal @ self.model.direction(state.link))
            state = self._slid_or_held(state, touch, slope)
        return state, touch

    def _derivatives(self, state: State, touch: Touch, surface: Surface) -> Linearised:
        slope = float(touch.normal @ self.model.direction(state.link))
        return self.linearised(state, touch, slope, surface.turning(state.link, touch))

    def _slid_or_held(self, state: State, touch: Touch, slope: float) -> State:
        """Whether the bead slides: not at the tip, nor at a joint that protrudes."""
        model = self.model
        if state.s - model.layout.joints[0] < _SAME:
            return state._replace(sliding=False)
        if model.ends[state.link] - state.s > _SAME or slope > _OUTWARD:
            return state._replace(sliding=True)
        if state.link == len(model.ends) - 1:
            return state._replace(sliding=False)
        beyond = float(touch.normal @ model.direction(state.link + 1))
        if beyond > -_OUTWARD:
            return state._replace(sliding=False)
        return state._replace(link=state.link + 1, sliding=True)

    def _inward(self, state: State) -> State:
        """A joint is the end of the link before it."""
        if state.link > 0 and state.s - self.model.layout.joints[state.link] < _SAME:
            return state._replace(link=state.link - 1, s=float(self.model.ends[state.link - 1]))
        return state

    def linearised(self, state: State, touch: Touch, slope: float, turning: Floats) -> Linearised:
        """The equations of balance at a state in which the model has been placed."""
        model, force, n = self.model, state.force, touch.normal
        moved, carry = self.moved(state.link, touch.centre), self._carriers(state.link)
        swung = -(model.axes[:carry] @ _crossed_by(n))
        near = moved[:carry]
        # n . (a_i x (a_k x r)) for joints i before k; of one joint's, the symmetric part.
        bent = self._before[:carry, :carry] * (swung @ near.T)
        bent += bent.T
        bent += near @ turning @ near.T
        tangent = model.direction(state.link)
        rolling, stiffness = np.zeros(len(moved)), np.zeros((len(moved), len(moved)))
        rolling[:carry] = near @ (turning @ tangent) + swung @ tangent
        stiffness[:carry, :carry] = -force * bent
        own = model.blocks()
        count, size = own.shape[:2]
        blocks, index = stiffness.reshape(count, size, count, size), np.arange(count)
        blocks[index, :, index, :] += own
        return Linearised(
            touch,
            turning,
            moved @ n,
            moved,
            slope,
            rolling,
            float(tangent @ turning @ tangent),
            stiffness,
            model.springs.copy(),
            own.diagonal(axis1=1, axis2=2).ravel(),
        )

    def moved(self, link: int, centre: Floats) -> Floats:
        """How a place of a link moves with the joints' turns."""
        model, carry = self.model, self._carriers(link)
        found = np.zeros((len(model.joint_of), 3))
        found[:carry] = cross(model.axes[:carry], centre - model.anchors[:carry])
        return found

    def push(self, link: int, touch: Touch) -> Floats:
        """How the distance of a bead changes with the joints' turns, shape (nv,) [L]."""
        model, carry = self.model, self._carriers(link)
        found = np.zeros(len(model.joint_of))
        moments = (touch.centre - model.anchors[:carry]) @ _crossed_by(touch.normal)
        np.einsum("ij,ij->i", model.axes[:carry], moments, out=found[:carry])
        return found

    def _carriers(self, link: int) -> int:
        """How many velocities move a link: those of the joints up to its own."""
        return (link + 1) * self._each

    def _step(self, state: State, system: Linearised) -> State | None:
        """One step of Newton's method."""
        model, force = self.model, state.force
        # The joints beyond the contact feel their own springs only.
        count = self._carriers(state.link)
        push, springs = system.push[:count], system.springs
        size = count + 1 + state.sliding
        matrix, right = np.zeros((size, size)), np.zeros(size)
        matrix[:count, :count] = system.stiffness[:count, :count]
        matrix[:count, count] = matrix[count, :count] = -push
        matrix[count, count] = -1 / self._k
        right[:count] = springs[:count] + force * push
        right[count] = system.touch.distance + force / self._k
        if state.sliding:
            rolling = system.rolling[:count]
            matrix[:count, -1] = matrix[-1, :count] = -force * rolling
            matrix[count, -1] = matrix[-1, count] = -system.slope
            matrix[-1, -1] = -force * max(system.along, _FLATTEST)
            right[-1] = force * system.slope
        *_, found, failed = dgesv(matrix, right)
        if failed or not np.isfinite(found).all():
            return None
        turns = np.zeros(len(springs))
        turns[:count] = found[:count]
        if np.abs(springs[count:]).max(initial=0.0) > _STRAIGHT:
            turns[count:] = np.linalg.solve(system.stiffness[count:, count:], springs[count:])
        share = min(1.0, _LARGEST_TURN / max(float(np.abs(turns).max()), 1e-300))
        configuration = state.configuration.copy()
        mujoco.mj_integratePos(model.model, configuration, share * turns, 1.0)
        link, s = state.link, state.s
        if state.sliding:
            link, s = self._slid(link, s, share * float(found[-1]))
        return State(configuration, link, s, force + share * float(found[count]), state.sliding)

    def _slid(self, link: int, s: float, by: float) -> tuple[int, float]:
        """No farther than the next joint."""
        model = self.model
        if s + by >= model.ends[link]:
            return link, float(model.ends[link])
        low = float(model.layout.joints[link])
        if s + by > low:
            return link, s + by
        return (link - 1, low) if link > 0 else (link, low)

    def is_stable(self, state: State, touch: Touch, surface: Surface) -> bool:
        """Whether the energy is least at an equilibrium in which the model has been placed."""
        system = self._derivatives(state, touch, surface)
        return not dpotrf(self._whole(state, system), lower=1)[1]

    def _whole(self, state: State, system: Linearised) -> Floats:
        """The energy's second derivative, shape (nv, nv)."""
        return np.asarray(system.curvature(state) + self._k * np.outer(system.push, system.push))

    def softest(self, state: State, touch: Touch, surface: Surface) -> tuple[float, Floats]:
        """How stable an equilibrium is in which the model has been placed."""
        system = self._derivatives(state, touch, surface)
        scale = 1 / np.sqrt(system.own)
        whole = self._whole(state, system) * scale[:, None] * scale
        factor, failed = dpotrf(whole, lower=1)
        if failed:
            values, vectors = eigh(whole, subset_by_index=(0, 0))
            return float(values[0]), scale * vectors[:, 0]
        vector = scale.copy()
        for _ in range(_POWER_STEPS):
            vector = vector / np.linalg.norm(vector)
            vector, _ = dpotrs(factor, vector, lower=1)
        size = float(np.linalg.norm(vector))
        return 1 / size, scale * vector / size


def _crossed_by(vector: Floats) -> Floats:
    """The matrix C with a C = a x v for a row a."""
    x, y, z = vector.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
