"""The foot of a user's model, moved as the model has it."""

from abc import ABC, abstractmethod

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError

_ALONG = 0.999  # cosine; a slide that is turned by 2.5 degrees goes elsewhere
_AFFINE = int(mujoco.mjtBias.mjBIAS_AFFINE)


class Drive(ABC):
    """What moves the foot."""

    @abstractmethod
    def move(self, data: mujoco.MjData, way: float, speed: float) -> None:
        """Say where the foot is to be at the end of a step.

        Parameters
        ----------
        data : mujoco.MjData
            Changed in place.
        way, speed : float
            To the left, since the start [length, length/time].
        """


class Mocap(Drive):
    """A mocap body is put there."""

    def __init__(self, body: int, model: mujoco.MjModel, left: Floats) -> None:
        self._number, self._left = int(model.body_mocapid[body]), left
        self._start = np.array(mujoco.MjData(model).mocap_pos[self._number])

    def move(self, data: mujoco.MjData, way: float, speed: float) -> None:
        """It has no speed in MuJoCo."""
        data.mocap_pos[self._number] = self._start + way * self._left


class Slide(Drive):
    """A slide joint that nothing drives is put there, with its speed."""

    def __init__(self, joint: int, model: mujoco.MjModel, sense: float) -> None:
        self._place, self._speed = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
        self._start, self._sense = float(model.qpos0[self._place]), sense

    def move(self, data: mujoco.MjData, way: float, speed: float) -> None:
        """At the beginning of the step; what acts on it during one step, moves it a little."""
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
    """What can move a body to the left.

    Parameters
    ----------
    model : mujoco.MjModel
        The user's.
    foot : int
        The body.
    left : array, shape (3,)
        The direction of the sweep in the world.

    Returns
    -------
    Drive
        The innermost one that there is.

    Raises
    ------
    InputError
        If nothing moves it along the sweep.
    """
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    body = foot
    while body > 0:
        if model.body_mocapid[body] >= 0:
            return Mocap(body, model, left)
        first = int(model.body_jntadr[body])
        for joint in range(first, first + int(model.body_jntnum[body])):
            if model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_FREE):
                return _by_weld(model, body, left)
            if model.jnt_type[joint] == int(mujoco.mjtJoint.mjJNT_SLIDE):
                sense = float(data.xaxis[joint] @ left)
                if abs(sense) > _ALONG:
                    return _along(model, joint, float(np.sign(sense)))
        body = int(model.body_parentid[body])
    name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, foot)
    raise InputError(
        "foot", repr(name), "one that can be moved across the vibrissa, in the plane of its hinges",
        "make it a mocap body, or give it a slide joint along "
        f"{np.array2string(np.abs(left), precision=3)}",
    )  # fmt: skip


def _along(model: mujoco.MjModel, joint: int, sense: float) -> Drive:
    for i in range(model.nu):
        at_joint = model.actuator_trntype[i] == int(mujoco.mjtTrn.mjTRN_JOINT)
        if not (at_joint and model.actuator_trnid[i, 0] == joint):
            continue
        if model.actuator_biastype[i] != _AFFINE:
            name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i)
            raise InputError(
                "actuator", repr(name), "of position or velocity", "a force keeps no speed"
            )
        return Actuated(i, joint, model, sense)
    return Slide(joint, model, sense)


def _by_weld(model: mujoco.MjModel, body: int, left: Floats) -> Drive:
    welds = np.flatnonzero(model.eq_type == int(mujoco.mjtEq.mjEQ_WELD))
    for pair in zip(model.eq_obj1id[welds], model.eq_obj2id[welds], strict=True):
        for one, other in (pair, pair[::-1]):
            if one == body and model.body_mocapid[other] >= 0:
                return Mocap(int(other), model, left)
    name = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body)
    raise InputError("foot", repr(name), "held", "it is free: weld it to a mocap body")
