"""How far the solver of a user's model is from one that goes on to the end, past an object.

The model is swept a little way past a round object, once as it is and once with MuJoCo's strictest
solver; what its sensors read is averaged as a station's readings are.
"""

import math

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from mujoco_models.inspect.moved import SPEED, Drive, drive_to, readings
from mujoco_models.inspect.parts import Parts

STRICT = (("solver", "Newton"), ("iterations", "100"), ("ls_iterations", "50"),
          ("tolerance", "1e-15"), ("ls_tolerance", "0.01"))  # fmt: skip
"""Attributes of a file's option: as MuJoCo has them, but for a tolerance that is never met."""
_WAY = 0.2  # L; of the foot
_AT, _ROUND, _DEPTH = 0.8, 0.2, 1.5  # L; of the object: where it is met, its radius, half its depth
_STATION = 0.6  # T1; from one of 60 stations to the next
_FEWEST_STEPS, _MOST_STEPS = 8, 2000


def unsolved(
    spec: mujoco.MjSpec,
    parts: Parts,
    rest: Floats,
    frame: tuple[Floats, Floats],
    radius: float,
    rigidity: float,
    period: float,
) -> float:
    """By how much its readings are off, relative to the largest; infinite if they diverge.

    Zero where nothing can be compared: without sensors, or with a model that diverges even so.
    """
    nodes, axes = frame
    length = float(np.linalg.norm(np.diff(nodes, axis=0), axis=1).sum())
    if not spec.option.timestep > 0:
        return 0.0
    _put_object(spec, nodes, axes, radius)
    try:
        model = spec.compile()
        drive = _drive(model, parts, axes)
    except (ValueError, mujoco.FatalError, InputError):  # as other remarks say
        return 0.0
    wanted = math.ceil(_WAY / SPEED * period / model.opt.timestep)
    steps = min(max(wanted, _FEWEST_STEPS), _MOST_STEPS)
    own = readings(model, rest, drive, length, period, steps)
    model.opt.solver = mujoco.mjtSolver.mjSOL_NEWTON
    for name, text in STRICT[1:]:
        setattr(model.opt, name, float(text) if "tolerance" in name else int(text))
    meant = readings(model, rest, drive, length, period, steps)
    if meant is None or own is None:
        return 0.0 if meant is None else math.inf
    width = max(1, min(round(_STATION * period / model.opt.timestep), steps // 4))
    own, meant = (_means(rows, width) for rows in (own, meant))
    units = {parts.force: rigidity / length**2, parts.torque: rigidity / length}

    found = 0.0
    for sensor, least in units.items():
        if sensor is not None:
            mine = model.sensor_adr[sensor] + np.arange(3)
            by = np.linalg.norm((own - meant)[len(own) // 2 :, mine], axis=1)
            most = max(least, np.linalg.norm(meant[:, mine], axis=1).max())
            found = max(found, float(np.sqrt(np.mean(by**2)) / most))
    return found


def _means(rows: Floats, width: int) -> Floats:
    sums = np.cumsum(rows, axis=0)
    return np.asarray((sums[width:] - sums[:-width]) / width)


def _put_object(spec: mujoco.MjSpec, nodes: Floats, axes: Floats, radius: float) -> None:
    """A rod across the plane of the sweep, which the vibrissa just touches from its right."""
    s = np.append(0.0, np.cumsum(np.linalg.norm(np.diff(nodes, axis=0), axis=1)))
    length = s[-1]
    before, place = (
        np.array([np.interp(share * length, s, along) for along in nodes.T])
        for share in (_AT - 0.01, _AT)
    )
    left = np.cross(axes[2], place - before)
    away = (radius + _ROUND * length) / float(np.linalg.norm(left)) * left
    deep = _DEPTH * length * axes[2]
    body = spec.worldbody.add_body(name="vibrissa-object", mocap=True, pos=place + away)
    body.add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE, size=[_ROUND * length, 0, 0], fromto=[*-deep, *deep],
        mass=0, contype=1, conaffinity=1, priority=-1,
    )  # fmt: skip


def _drive(model: mujoco.MjModel, parts: Parts, axes: Floats) -> Drive:
    """The foot goes to the left, or, if nothing moves it, the object to the right."""
    try:
        return drive_to(model, parts.foot, -axes[0])
    except InputError:
        start = np.array(mujoco.MjData(model).mocap_pos[-1])

        def move(data: mujoco.MjData, way: float, speed: float) -> None:
            data.mocap_pos[-1] = start + way * axes[0]

        return move
