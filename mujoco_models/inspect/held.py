"""The vibrissa of a user's model with its foot held: what chains of links and rods share."""

from copy import copy
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.inspect.parts import Parts, masses_of

_TURNS = int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_BALL)
_PLACES = 2  # the last of a free joint's coordinates that slide
_ON_PIECE = 0.05  # of its length, by which a site may be aside of the first piece
_OFF = mujoco.mjtDisableBit
_STATED = int(
    _OFF.mjDSBL_CONSTRAINT | _OFF.mjDSBL_EQUALITY | _OFF.mjDSBL_SPRING | _OFF.mjDSBL_SENSOR
)
BEYOND = "jnt_limited", "jnt_stiffnesspoly"
"""What a joint has beyond a linear spring; the latter since MuJoCo 4."""
_HEAVY = 1e12  # times the mass of the vibrissa, as the inertia of whatever is held


@dataclass(frozen=True, eq=False)
class Bending:
    """Small displacements about a state at rest."""

    # Shape (n_joints,); Turn over moment of each joint, about the axis across the sweep [1/(force
    # length)].
    compliances: Floats
    # Displacement of the tip over a force on it, both along the sweep [length/force].
    tip_compliance: float
    # Shape (n,); Squares of the angular frequencies of free vibration, ascending [1/time^2].
    squares: Floats
    # Shape (n,); Rates at which dampers slow these vibrations: twice the damping ratio times the
    # angular frequency [1/time].
    damping: Floats
    # Of the slowest that bends it, without the joints' own inertia [1/time^2].
    slowest_without_armature: float
    # Strain of its edges over a pull along them; 0 for what cannot stretch [1/force].
    stretch: float = 0.0
    first: int = 0  # of the vibrations: the slowest that bends it along the sweep


class HeldModel:
    """A model whose foot is held, without contacts and gravity, and loads on the tip.

    Its springs are linear and have no ends. Springs, constraints and sensors that a flag switches
    off are on: the flag is a fault itself.
    """

    small: float  # EI/L^2 and EI/L; the loads by which sensors are probed

    def __init__(
        self, model: mujoco.MjModel, parts: Parts, dofs: Integers, heavy: Integers
    ) -> None:
        """With the coordinates that move, and what is not to move made too heavy for that."""
        self.model, self.parts, self.dofs = copy(model), parts, dofs
        self.gravity = np.array(model.opt.gravity)
        self.model.opt.gravity[:] = 0
        self.model.opt.disableflags &= ~_STATED
        self.model.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_CONTACT
        for field in set(BEYOND).intersection(dir(model)):
            getattr(self.model, field)[:] = 0
        self.cutoffs = np.array(model.sensor_cutoff)
        self.model.sensor_cutoff[:] = 0
        self.model.sensor_noise[:] = 0
        self.late = np.zeros(model.nsensor)
        if hasattr(model, "sensor_delay"):  # since MuJoCo 3.5
            kept = model.sensor_history[:, 0] > 0  # nothing is late without
            self.late += kept * (model.sensor_delay + model.sensor_interval[:, 0])
            self.model.sensor_delay[:] = self.model.sensor_interval[:] = 0
        self._masses = masses_of(model, parts.chain)
        # A length for what slides, and 1 for what turns.
        self.units = np.where(
            np.isin(model.jnt_type[model.dof_jntid], _TURNS) | _turns_freely(model), 1.0,
            np.linalg.norm(model.body_pos[list(parts.chain)], axis=1).sum(),
        )  # fmt: skip
        length = float(self.units.max())
        with np.errstate(over="ignore"):  # what is without bounds is refused as it vibrates
            heaviest = _HEAVY * self._masses.sum() * (length / self.units[heavy]) ** 2
        self.model.dof_armature[heavy] += heaviest
        self.data = mujoco.MjData(self.model)
        self._force, self._torque = np.zeros((2, 3))

    def set_back(self) -> None:
        """Take loads away and put the model into its own first state."""
        mujoco.mj_resetData(self.model, self.data)
        self.load(np.zeros(3), np.zeros(3))
        mujoco.mj_forward(self.model, self.data)

    def load(self, force: Floats, torque: Floats) -> None:
        self._force[:], self._torque[:] = force, torque

    def begin(self, first: Floats, second: Floats) -> Floats:
        """Where the vibrissa begins: at the torque sensor, if its first piece goes past that."""
        if self.parts.torque is None:
            return first
        way = second - first
        place, _ = self.site(self.parts.torque)
        share = (place - first) @ way / (way @ way)
        aside = np.linalg.norm(place - first - share * way)
        there = 0 < share < 1 and aside < _ON_PIECE * np.linalg.norm(way)
        return np.asarray(first + share * way if there else first)

    def axes_of(self, body: int) -> Floats:
        """How a body is turned: its axes in columns."""
        return np.array(self.data.xmat[body].reshape(3, 3))

    def sensed(self, sensor: int) -> Floats:
        first = self.model.sensor_adr[sensor]
        return np.array(self.data.sensordata[first : first + 3])

    def site(self, sensor: int) -> tuple[Floats, Floats]:
        """Where the site of a sensor is, and how it is turned."""
        site = self.model.sensor_objid[sensor]
        return np.array(self.data.site_xpos[site]), self.data.site_xmat[site].reshape(3, 3).copy()


def _turns_freely(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """The last three coordinates of a free joint."""
    free = model.jnt_type[model.dof_jntid] == mujoco.mjtJoint.mjJNT_FREE
    return np.asarray(free & (np.arange(model.nv) - model.jnt_dofadr[model.dof_jntid] > _PLACES))


def lengths(points: Floats) -> Floats:
    """Of the line through points, piece by piece."""
    return np.asarray(np.linalg.norm(np.diff(points, axis=0), axis=1))
