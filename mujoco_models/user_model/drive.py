"""The foot of a user's model, moved as the model has it."""

from abc import ABC, abstractmethod

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError
from mujoco_models.inspect.drive import holders, mover_of

_OURS = 1e4  # times the mass of the model, as the inertia of a slide that we move
_AFFINE = int(mujoco.mjtBias.mjBIAS_AFFINE)


class Drive(ABC):
    """What moves the foot."""

    @abstractmethod
    def move(self, data: mujoco.MjData, way: float, speed: float) -> None:
        """Say where the foot is to be at the end of a step."""


class Mocap(Drive):
    """A mocap body is put there."""

    def __init__(self, body: int, model: mujoco.MjModel, left: Floats) -> None:
        self._number, self._left = int(model.body_mocapid[body]), left
        self._start = np.array(mujoco.MjData(model).mocap_pos[self._number])

    def move(self, data: mujoco.MjData, way: float, speed: float) -> None:
        """It has no speed in MuJoCo."""
        data.mocap_pos[self._number] = self._start + way * self._left


class Slide(Drive):
    """A slide joint that nothing drives is put there, with its speed.

    Nothing may accelerate it during a step, or a sensor on a body with a mass would feel that: 9 %
    of a force, on a foot of 1 kg with an armature of 10 kg.
    """

    def __init__(self, joint: int, model: mujoco.MjModel, sense: float) -> None:
        self._place, self._speed = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        self._start, self._sense = float(model.qpos0[self._place]), sense
        model.dof_armature[self._speed] = _OURS * float(model.body_mass.sum())

    def move(self, data: mujoco.MjData, way: float, speed: float) -> None:
        """At the beginning of the step."""
        data.qpos[self._place] = self._start + self._sense * (way - speed * data.model.opt.timestep)
        data.qvel[self._speed] = self._sense * speed


class Actuated(Drive):
    """A position or velocity actuator follows what it is given."""

    def __init__(self, actuator: int, joint: int, model: mujoco.MjModel, sense: float) -> None:
        self._actuator = actuator
        self._by_place = bool(model.actuator_biasprm[actuator, 1] != 0)
        self._gear = float(model.actuator_gear[actuator, 0])
        self._start, self._sense = float(model.qpos0[model.jnt_qposadr[joint]]), sense

    def move(self, data: mujoco.MjData, way: float, speed: float) -> None:
        """As far as its gain lets it."""
        wanted = self._start + self._sense * way if self._by_place else self._sense * speed
        data.ctrl[self._actuator] = self._gear * wanted


def drive_to(model: mujoco.MjModel, foot: int, left: Floats) -> Drive:
    """What can move a body to the left."""
    mover = mover_of(model, foot, left)
    if mover is None:
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, foot)
        free = int(mujoco.mjtJoint.mjJNT_FREE)
        if free in [model.jnt_type[model.body_jntadr[b]] for b in holders(model, foot)
                    if model.body_jntnum[b]]:  # fmt: skip
            raise InputError("foot", repr(name), "held", "it is free: weld it to a mocap body")
        raise InputError(
            "foot", repr(name),
            "one that can be moved across the vibrissa, in the plane of its hinges",
            "make it a mocap body, or give it a slide joint along "
            f"{np.array2string(np.abs(left), precision=3)}",
        )  # fmt: skip
    if mover.mocap is not None:
        return Mocap(mover.mocap, model, left)
    assert mover.joint is not None
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    sense = float(np.sign(data.xaxis[mover.joint] @ left))
    if mover.actuator is None:
        return Slide(mover.joint, model, sense)
    if model.actuator_biastype[mover.actuator] != _AFFINE:
        name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, mover.actuator)
        raise InputError(
            "actuator", repr(name), "of position or velocity", "a force keeps no speed"
        )
    return Actuated(mover.actuator, mover.joint, model, sense)
