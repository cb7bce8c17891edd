"""A model in motion, ours or a user's: its steps, its time, and what its contacts take."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.errors import InputError
from mujoco_models.errors import DivergedError
from mujoco_models.model.stiffness import stiffen, weights_in_last_step
from mujoco_models.motion import Motion
from mujoco_models.quiet import has_diverged

# (beta L)^4 = 12.36 of the first free vibration of a cantilever gives the mass per length with
# which it takes the time 1: mass = EI (beta L)^4 (T1/2 pi)^2/L^4.
MASS = 1.8751040687119611**4 / (2 * np.pi) ** 2
# Of its coefficient that friction has at a contact that slides, at least; and of the foot's speed
# that one moves which sticks, at most.
_RUBS, _CREEPS = 0.95, 0.1
_SLIDES = 0.002  # T1; a step in which a slow foot's contact rubs as it should
CARRIAGE = 1e9  # times the vibrissa's mass: nothing the vibrissa does moves the foot


class SteppedModel(ABC):
    """MuJoCo's model and its state; what it says is dimensionless, L = EI = T1 = 1."""

    _is_mine: Booleans  # which geoms are the vibrissa's
    _is_object: Booleans  # which are the object's

    _follows_inertia = False  # whether contacts have their stiffness by `_follow_inertia`

    def __init__(self, model: mujoco.MjModel, label: str, period: float = 1.0) -> None:
        self.model, self.data, self.label = model, mujoco.MjData(model), label
        self._period = period  # T1 in the model's unit of time
        # Of the state that is reported: MuJoCo's sensors are of the beginning of a step [T1].
        self.time = 0.0

    @property
    def now(self) -> float:
        """Time of the present state [T1]."""
        return float(self.data.time) / self._period

    @property
    @abstractmethod
    def p(self) -> float:
        """Where the clamp is on its way in the state that is reported; of a sweep, the foot [L]."""

    @property
    @abstractmethod
    def touches(self) -> bool:
        """Whether a contact is loaded."""

    @property
    def touches_twice(self) -> bool | None:
        """Whether two objects are touched at once; None if it does not look."""
        return None

    @abstractmethod
    def clamp(self) -> tuple[float, ...]:
        """The clamp's action on the vibrissa."""

    @abstractmethod
    def state(self, speed: float) -> dict[str, Any]:
        """What else there is to say of the state that is reported, by column."""

    @abstractmethod
    def step(self, speed: float) -> None:
        """One step, at whose end the clamp has a speed on its way [L/T1, rad/T1].

        What the model reports afterwards is the state at the beginning of the step, as MuJoCo's
        sensors do.
        """

    def _carry(self, speeds: Floats) -> None:
        """A heavy carriage, the first degrees of freedom, is to have speeds after a step."""
        self.time = self.now
        change = speeds - self.data.qvel[: len(speeds)]
        self.data.qfrc_applied[: len(speeds)] = CARRIAGE * MASS * change / self.model.opt.timestep

    def _advance(self) -> None:
        mujoco.mj_step(self.model, self.data)
        if has_diverged(self.data):
            raise DivergedError("the motion does not stay finite")
        if self._follows_inertia and self.data.nefc:
            self._follow_inertia()

    def _set_stiffness(self, stiffness: float, impedance: float, friction: float = 0.0) -> None:
        """Force over penetration of contacts with the object; what may move is as stiff now."""
        self._stiffness, self._impedance, self._friction = stiffness, impedance, friction
        geoms = np.flatnonzero(self._is_mine)
        moves = self.model.body_invweight0[self.model.geom_bodyid[geoms], 0] > 0
        stiffen(self.model, geoms[moves], stiffness, impedance)

    def _set_contacts(self, motion: Motion, geoms: Integers, corners: bool = False) -> None:
        """Give the vibrissa's geoms the stiffness that is stated, or MuJoCo's own, and friction.

        Raise InputError for a step in which MuJoCo's friction overshoots: it accelerates a contact
        that slides at v by -b v, as far as its cone lets it, also with the integrator that treats
        springs and normals implicitly. With b times the step of 7, the tip flies off and comes back
        for ever.
        """
        self._is_mine = np.isin(np.arange(self.model.ngeom), geoms)
        self._set_stiffness(motion.stiffness, motion.solimp, motion.friction or 0.0)
        self._follows_inertia = motion.solref is None and motion.integrator == "discrete"
        if motion.solref is not None:
            self.model.geom_solref[geoms] = motion.solref
        if not motion.friction:
            return
        stiffness, damping = self.model.geom_solref[geoms].T
        direct = stiffness < 0
        decay = np.where(direct, -damping, 2 / (motion.solimp * np.where(direct, 1.0, stiffness)))
        longest = 1 / float(decay.max())
        if motion.timestep > longest:
            # On an edge 1e3 let a vibrissa of 0.0033 L sink by 2.3 radii: readings were off by 36
            # to 85 %, with 2e4 by 0.6.
            holds = 2e4 if corners else 1e3
            slides = _SLIDES * (1e3 / holds) ** 0.5
            # Critical: damping by its root.
            soft = 0.9 * longest * (motion.stiffness / holds) ** 0.5
            # So slow and damped, of 24 stations past three objects 23 rest, readings within 7e-3.
            slow = 'speed = 0.025, damping_ratio = 0.2, average = 0.2, cone = "elliptic"'
            step = f"timestep = {min(soft, slides):.2g}"
            hard = f"contact_stiffness = {holds:.0e}".replace("e+0", "e")
            slowly = f"state [motion] {slow}, {hard}, {step}"
            raise InputError(
                "motion.timestep",
                motion.timestep,
                f"at most {longest:.2g} T1 with friction and contacts as stiff as these",
                slowly if motion.solref is None else "shorten it, or give a slower solref",
            )
        self.model.geom_condim[geoms] = 3
        self.model.geom_friction[geoms, 0] = motion.friction

    def _forces(self, contacts: Sequence[int]) -> Floats:
        """Of contacts, along the normal and to two sides, shape (n, 3)."""
        wrenches = np.zeros((len(contacts), 6))
        for i, wrench in zip(contacts, wrenches, strict=True):
            mujoco.mj_contactForce(self.model, self.data, i, wrench)
        return wrenches[:, :3]

    def _creeps(self, speed: float) -> bool:
        """Whether a contact slides, and MuJoCo's friction is less than its coefficient says.

        It is a damper up to what the cone allows: where the foot is slow [length/time], all that it
        would have to rub is not there, and what should stick creeps along with the foot.
        """
        wrench, elliptic = np.zeros(6), self.model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC
        for i, contact in enumerate(self.data.contact):
            if contact.dim < 3 or contact.efc_address < 0 or not contact.friction[0]:
                continue
            mujoco.mj_contactForce(self.model, self.data, i, wrench)
            along = self.data.efc_vel[contact.efc_address :][: 3 if elliptic else 4]
            across = (
                along[1:] if elliptic else (along[::2] - along[1::2]) / contact.friction[:2] / 2
            )
            rubs = float(np.hypot(*wrench[1:3]))
            less = rubs < _RUBS * contact.friction[0] * wrench[0]
            if less and np.hypot(*across) > _CREEPS * abs(speed):
                return True
        return False

    def _follow_inertia(self) -> None:
        """Make contacts as stiff as stated with the inertia that MuJoCo took in the last step."""
        pairs, weight = weights_in_last_step(self.model, self.data, self._friction)
        met = self._is_object[pairs].any(axis=1) & (weight > 0)
        mine = self._is_mine[pairs] & met[:, None]
        weights = np.repeat(weight, mine.sum(axis=1))
        stiffen(self.model, pairs[mine], self._stiffness, self._impedance, weights)

    def _share_of_kinetic(self, speeds: Floats, dofs: Integers | slice, elastic: float) -> float:
        """Kinetic energy of the vibrissa's velocities over kinetic and elastic energy."""
        product = np.zeros_like(speeds)
        mujoco.mj_mulM(self.model, self.data, product, speeds)
        kinetic = float(speeds[dofs] @ product[dofs]) / 2
        total = kinetic + elastic
        return kinetic / total if total > 0 else 0.0
