"""What can move the foot of a user's model."""

from collections.abc import Iterator
from dataclasses import dataclass

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.errors import InputError

_ALONG = 0.999  # cosine; a slide that is turned by 2.5 degrees goes elsewhere
_FOLLOWS = int(mujoco.mjtBias.mjBIAS_AFFINE)  # of a position or velocity actuator
_FREE, _SLIDE = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_SLIDE)


@dataclass(frozen=True)
class Mover:
    """A mocap body, or a slide joint with or without an actuator."""

    mocap: int | None = None  # the mocap body
    joint: int | None = None  # the slide, or the free joint that is welded to the mocap body
    actuator: int | None = None  # of the slide


def mover_of(model: mujoco.MjModel, foot: int, left: Floats) -> Mover | None:
    """What can move a body along the sweep."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    welded = None
    for body in holders(model, foot):
        if model.body_mocapid[body] >= 0:
            return Mover(mocap=body, joint=welded)
        for joint in _joints(model, body):
            if model.jnt_type[joint] == _FREE:
                welded = joint
            along = abs(float(data.xaxis[joint] @ left))
            if model.jnt_type[joint] == _SLIDE and along > _ALONG:
                _refuse_other_drives(model, joint)
                return Mover(joint=joint, actuator=_actuator_of(model, joint))
    return None


def slides(model: mujoco.MjModel, foot: int) -> Iterator[int]:
    """Slide joints that carry a body, the innermost first."""
    for body in holders(model, foot):
        yield from (j for j in _joints(model, body) if model.jnt_type[j] == _SLIDE)


def holders(model: mujoco.MjModel, body: int) -> Iterator[int]:
    """A body and all that hold it, but for the world; what is free is held by its weld."""
    seen: set[int] = set()
    while body > 0 and body not in seen:
        yield body
        seen.add(body)
        free = any(model.jnt_type[joint] == _FREE for joint in _joints(model, body))
        body = _welded_to(model, body) if free else int(model.body_parentid[body])


def drive_of(model: mujoco.MjModel, foot: int, left: Floats) -> str | None:
    """What can move a body along the sweep, in words."""
    mover = mover_of(model, foot, left)
    if mover is None:
        return None
    joint = None if mover.joint is None else _name(model, mujoco.mjtObj.mjOBJ_JOINT, mover.joint)
    if mover.mocap is not None:
        hand = f"mocap body {_name(model, mujoco.mjtObj.mjOBJ_BODY, mover.mocap)!r}"
        return hand if joint is None else f"free joint {joint!r} on {hand}, by a weld"
    if mover.actuator is None:
        return f"slide {joint!r} without an actuator"
    actuator = _name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, mover.actuator)
    how = "" if model.actuator_biastype[mover.actuator] == _FOLLOWS else ", which is a force"
    return f"slide {joint!r} with actuator {actuator!r}{how}"


def _joints(model: mujoco.MjModel, body: int) -> range:
    first = int(model.body_jntadr[body])
    return range(first, first + int(model.body_jntnum[body]))


def _welded_to(model: mujoco.MjModel, body: int) -> int:
    """What a weld ties a free body to; the world if none does."""
    welds = (model.eq_type == int(mujoco.mjtEq.mjEQ_WELD)) & model.eq_active0
    for weld in np.flatnonzero(welds):
        ends = [int(model.eq_obj1id[weld]), int(model.eq_obj2id[weld])]
        if model.eq_objtype[weld] == int(mujoco.mjtObj.mjOBJ_SITE):
            ends = [int(model.site_bodyid[site]) for site in ends]
        if body in ends:
            return ends[1 - ends.index(body)]
    return 0


def _actuator_of(model: mujoco.MjModel, joint: int) -> int | None:
    for i in range(model.nu):
        at_joint = model.actuator_trntype[i] == int(mujoco.mjtTrn.mjTRN_JOINT)
        if at_joint and model.actuator_trnid[i, 0] == joint:
            return i
    return None


def _refuse_other_drives(model: mujoco.MjModel, joint: int) -> None:
    """Raise InputError where a tendon's actuator or another joint holds the slide."""
    ropes = [
        model.tendon_adr[t] + i for t in range(model.ntendon) for i in range(model.tendon_num[t])
        if model.actuator_trntype.size
        and t in model.actuator_trnid[model.actuator_trntype == int(mujoco.mjtTrn.mjTRN_TENDON), 0]
    ]  # fmt: skip
    is_joint = int(mujoco.mjtWrap.mjWRAP_JOINT)
    by_tendon = any(model.wrap_type[w] == is_joint and model.wrap_objid[w] == joint for w in ropes)
    coupled = (model.eq_type == int(mujoco.mjtEq.mjEQ_JOINT)) & model.eq_active0
    by_joint = joint in model.eq_obj1id[coupled] or joint in model.eq_obj2id[coupled]
    if by_tendon or by_joint:
        raise InputError(
            f"slide {_name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)!r} of the foot",
            "held by a tendon's actuator" if by_tendon else "coupled to another joint",
            "one that can be moved by itself",
            "give the joint an actuator of position or velocity, or none",
        )


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, number: int) -> str:
    return mujoco.mj_id2name(model, kind, number) or ""
