"""The foot of a user's model, moved as the model has it."""

from collections.abc import Callable
from typing import TypeAlias

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from mujoco_models.inspect.drive import holders, joints_of, mover_of
from mujoco_models.quiet import has_diverged

Drive: TypeAlias = Callable[[mujoco.MjData, float, float], None]
"""Moves the foot: how far it is to be at the end of a step, and how fast."""

SPEED = 0.05  # L/T1; of the foot, which gains it in T1
_OURS = 1e4  # times the mass of the model, as the inertia of a slide that we move
_AFFINE = mujoco.mjtBias.mjBIAS_AFFINE


def drive_to(model: mujoco.MjModel, foot: int, left: Floats) -> Drive:
    """What can move a body to the left."""
    mover = mover_of(model, foot, left)
    if mover is None:
        raise _immovable(model, foot, left)
    if mover.mocap is not None:
        return _mocap(mover.mocap, model, left)
    assert mover.joint is not None
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    sense = float(np.sign(data.xaxis[mover.joint] @ left))
    if mover.actuator is None:
        return _slide(mover.joint, model, sense)
    if model.actuator_biastype[mover.actuator] != _AFFINE:
        name = model.actuator(mover.actuator).name
        raise InputError(
            "actuator", repr(name), "of position or velocity", "a force keeps no speed"
        )
    return _actuated(mover.actuator, mover.joint, model, sense)


def _immovable(model: mujoco.MjModel, foot: int, left: Floats) -> InputError:
    name = repr(model.body(foot).name)
    held_by = [model.jnt_type[j] for body in holders(model, foot) for j in joints_of(model, body)]
    if mujoco.mjtJoint.mjJNT_FREE in held_by:
        return InputError("foot", name, "held", "it is free: weld it to a mocap body")
    return InputError(
        "foot", name,
        "one that can be moved across the vibrissa, in the plane of its hinges",
        "give it a slide joint along "
        f"{np.array2string(np.abs(left), precision=3)}",
    )  # fmt: skip


def _mocap(body: int, model: mujoco.MjModel, left: Floats) -> Drive:
    """A mocap body is put there; it has no speed in MuJoCo."""
    number = int(model.body_mocapid[body])
    start = np.array(mujoco.MjData(model).mocap_pos[number])

    def move(data: mujoco.MjData, way: float, speed: float) -> None:
        data.mocap_pos[number] = start + way * left

    return move


def _slide(joint: int, model: mujoco.MjModel, sense: float) -> Drive:
    """A slide joint that nothing drives is put where the step begins, with its speed.

    Nothing may accelerate it during a step, or a sensor on a body with a mass would feel that: 9 %
    of a force, on a foot of 1 kg with an armature of 10 kg.
    """
    place, dof = int(model.jnt_qposadr[joint]), int(model.jnt_dofadr[joint])
    start = float(model.qpos0[place])
    model.dof_armature[dof] = _OURS * float(model.body_mass.sum())

    def move(data: mujoco.MjData, way: float, speed: float) -> None:
        data.qpos[place] = start + sense * (way - speed * data.model.opt.timestep)
        data.qvel[dof] = sense * speed

    return move


def _actuated(actuator: int, joint: int, model: mujoco.MjModel, sense: float) -> Drive:
    """A position or velocity actuator follows what it is given, as far as its gain lets it."""
    by_place = bool(model.actuator_biasprm[actuator, 1] != 0)
    gear = float(model.actuator_gear[actuator, 0])
    start = float(model.qpos0[model.jnt_qposadr[joint]])

    def move(data: mujoco.MjData, way: float, speed: float) -> None:
        data.ctrl[actuator] = gear * (start + sense * way if by_place else sense * speed)

    return move


def readings(
    model: mujoco.MjModel, rest: Floats, drive: Drive, length: float, period: float, steps: int
) -> Floats | None:
    """Of all sensors, a row a step; None if they do not stay finite."""
    data, step = mujoco.MjData(model), model.opt.timestep
    data.qpos[:] = rest
    rows = np.empty((steps, model.nsensordata))
    for i in range(steps):
        time = (i + 1) * step / period
        way = time**2 / 2 if time < 1 else time - 0.5
        speed = SPEED * min(time, 1.0) * length / period
        drive(data, SPEED * way * length, speed)
        mujoco.mj_step(model, data)
        rows[i] = data.sensordata
    if has_diverged(data):
        return None
    return rows
