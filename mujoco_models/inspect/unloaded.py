"""What drive and hand of a user's model add to its readings where nothing touches.

The model is swept past nothing, without gravity and limits, once as it is and once on a foot that
keeps its speed. A drive that swings or stays behind, and joints that give way, set in motion what
the sensors carry, and the vibrissa.
"""

import math
from copy import copy

import mujoco
import numpy as np
from scipy.signal import lfilter

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from mujoco_models.inspect.drive import holders, mover_of
from mujoco_models.inspect.measured import Sensed
from mujoco_models.inspect.moved import Drive, drive_to, readings
from mujoco_models.inspect.parts import Parts

# T1; on its way by then is the first station in contact, after one where it touches.
_FIRST, _STATION = 1.5, 0.5
_LEAST, _LASTS = 3.0, 10.0  # T1; of a sweep past nothing
_PLANES = slice(2), slice(2, 3)  # of force and moment
_WHOLE = 39.0  # T1; of two lengths from the first station on
_MOST_STEPS = 20_000
_HEAVY = 1e4  # times the inertia of a joint; what is so heavy keeps its speed


def unloaded(
    model: mujoco.MjModel,
    parts: Parts,
    rest: Floats,
    axes: Floats,
    length: float,
    period: float,
    sensors: tuple[Sensed | None, Sensed | None],
) -> tuple[float, float]:
    """By how much they make the rms of force and moment in the plane larger, over two lengths.

    Zero without a slide, where steps lead nowhere or leap over all, and where it diverges.
    """
    step, left = model.opt.timestep, -axes[0]
    ends = min(_LASTS, _MOST_STEPS * step / period)
    if ends < _LEAST or step > period:
        return 0.0, 0.0
    stated = copy(model)
    stated.opt.gravity[:] = 0
    for met in (mujoco.mjtDisableBit.mjDSBL_CONTACT, mujoco.mjtDisableBit.mjDSBL_LIMIT):
        stated.opt.disableflags |= int(met)
    heavy = copy(stated)
    try:
        mover, drive = mover_of(model, parts.foot, left), drive_to(stated, parts.foot, left)
    except InputError:  # as other remarks say
        return 0.0, 0.0
    if mover is None or mover.joint is None or mover.mocap is not None:
        return 0.0, 0.0
    found = []
    for swept, moved in ((stated, drive), (heavy, _steadily(heavy, parts.foot, mover.joint, left))):
        rows = readings(swept, rest, moved, length, period, round(ends * period / step))
        if rows is None:
            return 0.0, 0.0
        # As a mean over a station leaves what is periodic, whatever its period.
        follows = -math.expm1(-2 * step / (_STATION * period))
        means = lfilter([follows], [1, follows - 1], rows[round(_FIRST * period / step) :], axis=0)
        found.append([_rms(model, means, *one) for one in zip(sensors, _PLANES, strict=True)])
    force, moment = (max(own - steady, 0.0) for own, steady in zip(*found, strict=True))
    return force, moment


def _steadily(model: mujoco.MjModel, foot: int, joint: int, left: Floats) -> Drive:
    """A slide that keeps its speed, where no other joint of the hand moves."""
    hand = np.isin(model.dof_bodyid, [*holders(model, foot)])
    model.dof_armature[hand] += _HEAVY * model.dof_M0[hand]
    model.opt.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ACTUATION)
    dof, data = int(model.jnt_dofadr[joint]), mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    sense = float(np.sign(data.xaxis[joint] @ left))
    inertia = (1 + _HEAVY) * model.dof_M0[dof]

    def move(data: mujoco.MjData, way: float, speed: float) -> None:
        behind = sense * speed - data.qvel[dof]
        data.qfrc_applied[dof] = inertia * behind / model.opt.timestep

    return move


def _rms(model: mujoco.MjModel, means: Floats, sensor: Sensed | None, plane: slice) -> float:
    """Of the whole way, of which the second half of this goes on."""
    if sensor is None:
        return 0.0
    own = means[:, model.sensor_adr[sensor.number] + np.arange(3)] @ sensor.axes[:, plane]
    begins, goes_on = (half.mean() for half in np.array_split((own**2).sum(axis=1), 2))
    share = (_LASTS - _FIRST) / 2 / _WHOLE
    return math.sqrt(share * begins + (1 - share) * goes_on)
