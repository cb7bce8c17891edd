"""What the sensors of a user's vibrissa read of loads on its tip."""

from typing import TypeAlias

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from mujoco_models.inspect.drive import name_of
from mujoco_models.inspect.held_chain import HeldChain
from mujoco_models.inspect.held_rod import HeldRod
from mujoco_models.inspect.measured import Sensed, nearest_axes
from mujoco_models.inspect.parts import masses_of

Held: TypeAlias = HeldChain | HeldRod


def readings_of(held: Held, axes: Floats, rigidity: float, length: float) -> list[Sensed | None]:
    """The readings of both sensors of small forces and moments on the tip, one after the other."""
    sensors = held.parts.force, held.parts.torque
    if sensors == (None, None):
        return [None, None]
    zeros = [np.zeros(3) if sensor is None else held.sensed(sensor) for sensor in sensors]
    by_force, by_moment = np.zeros((2, 2, 3, 3))
    force, moment = held.small * rigidity / length**2, held.small * rigidity / length
    for i, axis in enumerate(axes):
        for found, size, kind in ((by_force, force, 0), (by_moment, moment, 1)):
            loads = [np.zeros(3), np.zeros(3)]
            loads[kind] = size * axis
            held.load(*loads)
            held.rest()
            for turned, sensor, zero in zip(found, sensors, zeros, strict=True):
                if sensor is not None:
                    turned[:, i] = -(held.sensed(sensor) - zero) / size
    arm = axes @ (held.tip - held.clamp)
    held.unload()
    return [
        None if sensor is None else _seen(held, sensor, axes, arm, by_force[i], by_moment[i])
        for i, sensor in enumerate(sensors)
    ]


def _seen(
    held: Held,
    sensor: int,
    axes: Floats,
    arm: Floats,
    by_force: Floats,
    by_moment: Floats,
) -> Sensed:
    """What a sensor is by its readings of forces and of moments, in columns; at rest."""
    is_force = held.model.sensor_type[sensor] == mujoco.mjtSensor.mjSENS_FORCE
    turned = by_force if is_force else by_moment
    # Of the moment of a force on the tip about the sensor: M = r x F gives r, by columns of skew.
    skew = np.zeros((3, 3)) if is_force else np.linalg.pinv(turned) @ by_force
    seen = np.array([skew[2, 1], skew[0, 2], skew[1, 0]])
    place, _ = held.site(sensor)
    name = name_of(held.model.sensor(sensor), "sensor")
    offset = axes @ (place - held.clamp)
    lever = offset if is_force else arm - seen
    cutoff = held.cutoffs[sensor] or np.inf
    site = int(held.model.sensor_objid[sensor])
    body = int(held.model.site_bodyid[site])
    on_body = held.axes_of(body)
    upright = on_body.T @ axes.T @ nearest_axes(turned).T
    quaternion = np.empty(4)
    mujoco.mju_mat2Quat(quaternion, upright.ravel())
    clamp = on_body.T @ (held.clamp - held.data.xpos[body])
    joints = held.model.jnt_type[held.model.jnt_bodyid == body]
    return Sensed(
        name,
        sensor,
        site,
        body,
        clamp,
        quaternion,
        on_body.T @ axes[1],
        turned,
        offset,
        lever,
        _feels_contacts(held, sensor),
        cutoff,
        bool((joints == mujoco.mjtJoint.mjJNT_FREE).any()),
        int(held.model.body_weldid[body]) in held.parts.chain,
        float(held.model.body_subtreemass[body] - masses_of(held.model, held.parts.chain).sum()),
        float(held.late[sensor]),
    )


def _feels_contacts(held: Held, sensor: int) -> bool:
    """MuJoCo does not count those of a flex among the forces on the bodies of its vertices."""
    model = held.model
    body = int(model.site_bodyid[model.sensor_objid[sensor]])
    tree = held.parts.chain[0]
    while tree > 0 and tree != body:
        tree = int(model.body_parentid[tree])
    return held.parts.rod is None or tree != body
