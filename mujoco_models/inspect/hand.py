"""What carries the foot of a user's model: joints, servos and welds between drive and vibrissa."""

from dataclasses import dataclass

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.inspect.drive import holders, joints_of, rail_of, welds_of
from mujoco_models.inspect.held_chain import HeldChain
from mujoco_models.inspect.parts import Parts

_SWEEP = 40.0  # T1; two lengths at 0.05 L/T1
_SHARE = 0.05  # of what clamp or tip give way by; what has less is not named
_NOTHING = 1e-300
_HARD = 0.999  # impedance
_FREE = int(mujoco.mjtJoint.mjJNT_FREE)
_COORDINATES = {_FREE: 6, int(mujoco.mjtJoint.mjJNT_BALL): 3}  # of a joint; of others 1


@dataclass(frozen=True, eq=False)
class Hand:
    """How far the clamp gives way while the drive itself is held."""

    joints: tuple[str, ...]  # those that do, the most first
    numbers: tuple[int, ...]  # of these joints in the model
    loose: bool  # whether a free body carries it that no weld holds
    slides: tuple[bool, ...]  # which of them
    arms: tuple[float, ...]  # how far from the clamp each is [length]
    welds: tuple[int, ...]  # of the first of them, if it is free
    time_constant: float  # of the weld as MuJoCo takes it; NaN if it is not as hard as it can be
    rotation: float  # of the clamp about the axis of the sweep, over a moment [1/(force length)]
    displacement: float  # of the clamp in the plane of the sweep, over a force [length/force]


def joints_of_hand(model: mujoco.MjModel, parts: Parts, left: Floats) -> list[int]:
    """The joints between drive and vibrissa."""
    rail = rail_of(model, parts.foot, left)
    drive = None if rail is None else rail.joint
    bodies = holders(model, parts.foot)
    return [j for body in bodies for j in joints_of(model, body) if j != drive]


def on_weld(model: mujoco.MjModel, parts: Parts, left: Floats) -> HeldChain | None:
    """The chain on a free body that a weld holds; None if there is no such body."""
    free = [
        j for j in joints_of_hand(model, parts, left)
        if model.jnt_type[j] == _FREE and welds_of(model, int(model.jnt_bodyid[j]))
    ]  # fmt: skip
    return HeldChain(model, parts, _dofs_of(model, free)) if free else None


def measure_hand(
    model: mujoco.MjModel, parts: Parts, axes: Floats, length: float, period: float
) -> Hand | None:
    """How the clamp gives way; None if the drive holds it without a joint in between.

    What no spring, servo or weld holds, a damper or an inertia may hold for the time of a sweep.
    """
    joints = sorted(joints_of_hand(model, parts, -axes[0]))  # as coordinates are
    if not joints:
        return None
    hand = _dofs_of(model, joints)
    held = HeldChain(model, parts, hand)
    stiffness, damping, inertia = held.slopes()
    resists = stiffness + damping / (_SWEEP * period) + inertia / (_SWEEP * period) ** 2
    mine = np.isin(held.dofs, hand)
    inner, across = resists[np.ix_(~mine, ~mine)], resists[np.ix_(~mine, mine)]
    ground = resists[np.ix_(mine, mine)] - across.T @ np.linalg.solve(inner, across)
    way, rotation = np.zeros((2, 3, model.nv))
    mujoco.mj_jac(held.model, held.data, way, rotation, held.clamp, parts.foot)
    # Shares of the coordinates in motions along x and y, a rotation, and the tip's along x.
    shares = np.array([axes[0] @ way, axes[1] @ way, axes[2] @ rotation])[:, hand]
    shares = np.vstack([shares, shares[0] - length * shares[2]])
    given = np.linalg.lstsq(ground, shares.T, rcond=None)[0]
    compliances = np.einsum("ij,ji->i", shares, given)
    each = np.abs(shares * given.T / np.maximum(np.abs(compliances), _NOTHING)[:, None])
    of_it = {j: float(each[:, np.isin(hand, _dofs_of(model, [j]))].sum(axis=1).max())
             for j in joints}  # fmt: skip
    giving = [
        j for j in sorted(joints, key=of_it.__getitem__, reverse=True)
        if of_it[j] > _SHARE
    ]  # fmt: skip
    free = bool(giving) and model.jnt_type[giving[0]] == _FREE
    welds = welds_of(model, int(model.jnt_bodyid[giving[0]])) if free else ()
    return Hand(
        joints=tuple(model.joint(j).name or f"joint {j}" for j in giving),
        numbers=tuple(giving),
        loose=any(
            model.jnt_type[j] == _FREE and not welds_of(model, int(model.jnt_bodyid[j]))
            for j in joints
        ),
        slides=tuple(bool(model.jnt_type[j] == mujoco.mjtJoint.mjJNT_SLIDE) for j in giving),
        arms=tuple(np.linalg.norm(held.data.xanchor[giving] - held.clamp, axis=1).tolist()),
        welds=welds,
        time_constant=_time_constant(model, welds),
        rotation=float(compliances[2]),
        displacement=float(compliances[:2].max()),
    )


def _dofs_of(model: mujoco.MjModel, joints: list[int]) -> Integers:
    counts = [_COORDINATES.get(int(model.jnt_type[j]), 1) for j in joints]
    return np.concatenate(
        [model.jnt_dofadr[j] + np.arange(n) for j, n in zip(joints, counts, strict=True)]
    )


def _time_constant(model: mujoco.MjModel, welds: tuple[int, ...]) -> float:
    if not welds or model.eq_solimp[welds[0], 0] < _HARD or model.eq_solref[welds[0], 0] <= 0:
        return np.nan
    return max(float(model.eq_solref[welds[0], 0]), 2 * float(model.opt.timestep))
