"""What holds a user's vibrissa beside its springs: constraints and tendons."""

import mujoco
import numpy as np

from analytic.problem.errors import InputError
from mujoco_models.inspect.drive import bodies_of_constraint
from mujoco_models.inspect.parts import Parts


def check_constraints(model: mujoco.MjModel, parts: Parts) -> None:
    """Raise InputError where an equality constraint holds the vibrissa beside its springs."""
    for i in np.flatnonzero(model.eq_active0).tolist():
        bodies = model.body_weldid[bodies_of_constraint(model, i)].tolist()
        for body in set(bodies).intersection(parts.chain):
            raise InputError(
                f"body {model.body(body).name!r} of the vibrissa",
                "held by an equality constraint", "one that springs alone hold",
                "remove the constraint, or set active=\"false\"",
            )  # fmt: skip


def check_tendons(model: mujoco.MjModel, parts: Parts) -> None:
    """Raise InputError where a tendon holds the vibrissa beside its springs.

    But for a linear spring on joints, which is one of theirs.
    """
    driven = model.actuator_trnid[model.actuator_trntype == mujoco.mjtTrn.mjTRN_TENDON, 0]
    coupled = (model.eq_type == mujoco.mjtEq.mjEQ_TENDON) & model.eq_active0
    ends = np.concatenate([model.eq_obj1id[coupled], model.eq_obj2id[coupled]])
    for tendon in range(model.ntendon):
        wraps = model.tendon_adr[tendon] + np.arange(model.tendon_num[tendon])
        kinds, numbers = model.wrap_type[wraps], model.wrap_objid[wraps]
        on_joints = kinds[0] == mujoco.mjtWrap.mjWRAP_JOINT
        bodies = (
            model.jnt_bodyid[numbers] if on_joints
            else model.site_bodyid[numbers[kinds == mujoco.mjtWrap.mjWRAP_SITE]]
        )  # fmt: skip
        more = getattr(model, "tendon_stiffnesspoly", np.zeros((model.ntendon, 1)))[tendon].any()
        linear = on_joints and np.ptp(model.tendon_lengthspring[tendon]) == 0 and not more
        springy = model.tendon_stiffness[tendon] != 0 and not linear
        holds = springy or model.tendon_limited[tendon] or model.tendon_frictionloss[tendon] > 0
        mine = set(model.body_weldid[bodies].tolist()).intersection(parts.chain)
        if mine and (holds or tendon in driven or tendon in ends):
            raise InputError(
                f"body {model.body(min(mine)).name!r} of the vibrissa", "held by a tendon",
                "one that springs alone hold",
                f"take tendon {model.tendon(tendon).name!r} away, or its stiffness, limits and "
                "actuator",
            )  # fmt: skip
