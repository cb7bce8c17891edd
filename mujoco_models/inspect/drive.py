"""What can move the foot of a user's model."""

import mujoco
import numpy as np

_FOLLOWS = int(mujoco.mjtBias.mjBIAS_AFFINE)  # of a position or velocity actuator


def drive_of(model: mujoco.MjModel, foot: int) -> str | None:
    """What can move a body, in words.

    Parameters
    ----------
    model : mujoco.MjModel
        The user's.
    foot : int
        The body.

    Returns
    -------
    str or None
        As ``"mocap body 'hand'"``; None if nothing can.
    """
    body = foot
    while body > 0:
        if model.body_mocapid[body] >= 0:
            return f"mocap body {_name(model, mujoco.mjtObj.mjOBJ_BODY, body)!r}"
        first = model.body_jntadr[body]
        for joint in range(first, first + model.body_jntnum[body]):
            found = _by_joint(model, joint)
            if found is not None:
                return found
        body = int(model.body_parentid[body])
    return None


def _by_joint(model: mujoco.MjModel, joint: int) -> str | None:
    name = _name(model, mujoco.mjtObj.mjOBJ_JOINT, joint)
    kind = model.jnt_type[joint]
    if kind == int(mujoco.mjtJoint.mjJNT_FREE):
        body = int(model.jnt_bodyid[joint])
        welds = np.flatnonzero(model.eq_type == int(mujoco.mjtEq.mjEQ_WELD))
        for other in (*model.eq_obj1id[welds], *model.eq_obj2id[welds]):
            if other != body and model.body_mocapid[other] >= 0:
                weld = _name(model, mujoco.mjtObj.mjOBJ_BODY, int(other))
                return f"free joint {name!r} on mocap body {weld!r}, by a weld"
        return f"free joint {name!r}"
    if kind != int(mujoco.mjtJoint.mjJNT_SLIDE):
        return None
    for i in range(model.nu):
        if (
            model.actuator_trntype[i] == int(mujoco.mjtTrn.mjTRN_JOINT)
            and model.actuator_trnid[i, 0] == joint
        ):
            actuator = _name(model, mujoco.mjtObj.mjOBJ_ACTUATOR, i)
            follows = model.actuator_biastype[i] == _FOLLOWS
            how = "" if follows else ", which is a force"
            return f"slide {name!r} with actuator {actuator!r}{how}"
    return f"slide {name!r} without an actuator"


def _name(model: mujoco.MjModel, kind: mujoco.mjtObj, number: int) -> str:
    return mujoco.mj_id2name(model, kind, number) or ""
