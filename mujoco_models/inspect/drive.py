"""What can move the foot of a user's model."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.errors import InputError

_ALONG = 0.999  # cosine; a slide that is turned by 2.5 degrees goes elsewhere
_FOLLOWS = mujoco.mjtBias.mjBIAS_AFFINE  # of a position or velocity actuator
_FREE, _SLIDE = int(mujoco.mjtJoint.mjJNT_FREE), int(mujoco.mjtJoint.mjJNT_SLIDE)


@dataclass(frozen=True)
class Mover:
    """A mocap body, or a slide joint with or without an actuator."""

    mocap: int | None = None  # the mocap body
    joint: int | None = None  # the slide, or the free joint that is welded to the mocap body
    actuator: int | None = None  # of the slide


@dataclass(frozen=True)
class Reach:
    """How far, how fast and how hard a slide can go along the sweep; infinite without a limit."""

    joint: int
    actuator: int | None
    way: float  # to where its own range ends [length]
    placed: float  # to where a position actuator's ctrlrange ends [length]
    speed: float  # of a velocity actuator
    force: float  # of an actuator
    joint_force: float  # of all actuators on the slide
    follows: bool  # whether it does what it is given at once
    stiffness: float  # of a spring on the slide itself
    damping: float  # of the slide itself, and the force of its friction at a sweep's speed
    friction: float
    inertia: float  # of all that it moves
    gain: float = 0.0  # of an actuator: its force for a length behind, or for a speed
    by_place: bool = False


@dataclass(frozen=True, eq=False)
class Rail:
    """A slide of the foot."""

    joint: int
    name: str
    way: Floats  # its direction, of the world or, in a measured beam, of the sweep


def reach_of(model: mujoco.MjModel, foot: int, left: Floats, speed: float) -> Reach | None:
    """What limits the slide that moves a body along the sweep; None of another drive."""
    mover = mover_of(model, foot, left)
    if mover is None or mover.mocap is not None or mover.joint is None:
        return None
    joint, actuator = mover.joint, mover.actuator
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    sense = float(np.sign(data.xaxis[joint] @ left))
    spring = float(model.jnt_stiffness[joint])
    start = float(model.qpos0[model.jnt_qposadr[joint]])
    dof, inf = model.jnt_dofadr[[joint]], math.inf
    row, unit = np.zeros((2, model.nv))
    unit[dof] = 1.0
    mujoco.mj_mulM(model, data, row, unit)
    damping = float(damping_at(model, dof, speed)[0])
    held = damping, friction_loss(model, dof, speed), float(row[dof[0]])

    def ahead(limited: bool, ends: Floats, at: float) -> float:
        return float(max((ends - at) * sense)) if limited else inf

    way = ahead(bool(model.jnt_limited[joint]), model.jnt_range[joint], start)
    if actuator is None or model.actuator_biastype[actuator] != _FOLLOWS:
        return Reach(joint, actuator, way, inf, inf, inf, inf, True, spring, *held)
    by_place = model.actuator_biasprm[actuator, 1] != 0
    gear = float(model.actuator_gear[actuator, 0])
    given = model.actuator_ctrlrange[actuator] / gear
    most = ahead(bool(model.actuator_ctrllimited[actuator]), given, start if by_place else 0.0)

    def limit(limited: bool, ends: Floats) -> float:
        return float(np.abs(ends).min()) if limited else inf

    return Reach(
        joint=joint,
        actuator=actuator,
        way=way,
        placed=most if by_place else inf,
        speed=inf if by_place else most,
        force=limit(
            model.actuator_forcelimited[actuator], model.actuator_forcerange[actuator] * gear
        ),
        joint_force=limit(model.jnt_actfrclimited[joint], model.jnt_actfrcrange[joint]),
        follows=bool(model.actuator_dyntype[actuator] == mujoco.mjtDyn.mjDYN_NONE),
        stiffness=spring,
        damping=held[0],
        friction=held[1],
        inertia=held[2],
        gain=-float(model.actuator_biasprm[actuator, 1 if by_place else 2]) * gear**2,
        by_place=bool(by_place),
    )


def mover_of(model: mujoco.MjModel, foot: int, left: Floats) -> Mover | None:
    """What can move a body along the sweep: what is driven rather than a slide that is not."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    welded, passive = None, None
    for body in holders(model, foot):
        if model.body_mocapid[body] >= 0:
            return Mover(mocap=body, joint=welded)
        for joint in joints_of(model, body):
            if model.jnt_type[joint] == _FREE:
                welded = joint
            along = abs(float(data.xaxis[joint] @ left))
            if model.jnt_type[joint] == _SLIDE and along > _ALONG:
                _refuse_other_drives(model, joint)
                found = Mover(joint=joint, actuator=_actuator_of(model, joint))
                if found.actuator is not None:
                    return found
                passive = passive or found
    return passive


def rail_of(model: mujoco.MjModel, foot: int, left: Floats) -> Rail | None:
    """The slide that moves a body, or, if nothing does, the one that is nearest to doing so."""
    mover, data = mover_of(model, foot, left), mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    joint = mover.joint if mover is not None and mover.mocap is None else None
    if mover is None:
        ways = {one: abs(float(data.xaxis[one] @ left)) for one in slides(model, foot)}
        joint = max(ways, key=ways.__getitem__, default=None)
    if joint is None:
        return None
    return Rail(joint, name_of(model.joint(joint), "joint"), np.array(data.xaxis[joint]))


def slides(model: mujoco.MjModel, foot: int) -> Iterator[int]:
    """Slide joints that carry a body, the innermost first."""
    for body in holders(model, foot):
        yield from (j for j in joints_of(model, body) if model.jnt_type[j] == _SLIDE)


def holders(model: mujoco.MjModel, body: int) -> Iterator[int]:
    """A body and all that hold it, but for the world; what is free is held by its weld."""
    seen: set[int] = set()
    while body > 0 and body not in seen:
        yield body
        seen.add(body)
        free = any(model.jnt_type[joint] == _FREE for joint in joints_of(model, body))
        body = _welded_to(model, body) if free else int(model.body_parentid[body])


def drive_of(model: mujoco.MjModel, foot: int, left: Floats) -> str | None:
    """What can move a body along the sweep, in words."""
    mover = mover_of(model, foot, left)
    if mover is None:
        return None
    joint = None if mover.joint is None else name_of(model.joint(mover.joint), "joint")
    if mover.mocap is not None:
        hand = f"mocap body {name_of(model.body(mover.mocap), 'body')!r}"
        return hand if joint is None else f"free joint {joint!r} on {hand}, by a weld"
    if mover.actuator is None:
        return f"slide {joint!r} without an actuator"
    how = "" if model.actuator_biastype[mover.actuator] == _FOLLOWS else ", which is a force"
    actuator = name_of(model.actuator(mover.actuator), "actuator")
    return f"slide {joint!r} with actuator {actuator!r}{how}"


def name_of(one: Any, kind: str) -> str:  # noqa: ANN401  # a view of MuJoCo's of some kind
    """Its own, or as ``"joint 3"``."""
    return one.name or f"{kind} {one.id}"


def movable(model: mujoco.MjModel, mine: set[int]) -> tuple[str, ...]:
    """Bodies that touch and that a mocap body, a slide or a free joint moves, but for mine."""
    found = []
    for body in range(1, model.nbody):
        moves = model.body_mocapid[body] >= 0 or any(
            model.jnt_type[joint] in (_FREE, _SLIDE) for joint in joints_of(model, body)
        )
        on_it = np.flatnonzero(model.body_rootid[model.geom_bodyid] == model.body_rootid[body])
        touches = (model.geom_contype[on_it] | model.geom_conaffinity[on_it]).any()
        if moves and touches and body not in mine:
            found.append(model.body(body).name or f"body {body}")
    return tuple(found)


def joints_of(model: mujoco.MjModel, body: int) -> range:
    first = int(model.body_jntadr[body])
    return range(first, first + int(model.body_jntnum[body]))


def _welded_to(model: mujoco.MjModel, body: int) -> int:
    """What a weld ties a free body to; the world if none does."""
    welds = welds_of(model, body)
    if not welds:
        return 0
    ends = bodies_of_constraint(model, welds[0])
    return ends[1 - ends.index(body)]


def welds_of(model: mujoco.MjModel, body: int) -> tuple[int, ...]:
    """The active welds that tie a body to another."""
    welds = np.flatnonzero((model.eq_type == mujoco.mjtEq.mjEQ_WELD) & model.eq_active0).tolist()
    return tuple(weld for weld in welds if body in bodies_of_constraint(model, weld))


def bodies_of_constraint(model: mujoco.MjModel, number: int) -> list[int]:
    """The bodies that an equality constraint ties to each other; none of a tendon or a flex."""
    ends = [int(model.eq_obj1id[number]), int(model.eq_obj2id[number])]
    if model.eq_type[number] == mujoco.mjtEq.mjEQ_JOINT:
        return [int(model.jnt_bodyid[joint]) for joint in ends if joint >= 0]
    if model.eq_objtype[number] == mujoco.mjtObj.mjOBJ_SITE:
        return [int(model.site_bodyid[site]) for site in ends]
    return ends if model.eq_objtype[number] == mujoco.mjtObj.mjOBJ_BODY else []


def _actuator_of(model: mujoco.MjModel, joint: int) -> int | None:
    at_joints = model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT
    found = np.flatnonzero(at_joints & (model.actuator_trnid[:, 0] == joint))
    return int(found[0]) if found.size else None


def _refuse_other_drives(model: mujoco.MjModel, joint: int) -> None:
    """Raise InputError where a tendon's actuator or another joint holds the slide."""
    driven = model.actuator_trnid[model.actuator_trntype == mujoco.mjtTrn.mjTRN_TENDON, 0]
    ropes = np.concatenate(
        [np.zeros(0, int), *(model.tendon_adr[t] + np.arange(model.tendon_num[t]) for t in driven)]
    )
    at_joint = model.wrap_type[ropes] == mujoco.mjtWrap.mjWRAP_JOINT
    by_tendon = joint in model.wrap_objid[ropes][at_joint]
    coupled = (model.eq_type == mujoco.mjtEq.mjEQ_JOINT) & model.eq_active0
    if by_tendon or joint in np.append(model.eq_obj1id[coupled], model.eq_obj2id[coupled]):
        raise InputError(
            f"slide {model.joint(joint).name!r} of the foot",
            "held by a tendon's actuator" if by_tendon else "coupled to another joint",
            "one that can be moved by itself",
            "give the joint an actuator of position or velocity, or none",
        )


def damping_at(model: mujoco.MjModel, dofs: Integers, rate: float) -> Floats:
    """The dampers of coordinates at a rate, which since MuJoCo 4 they may change with."""
    more = getattr(model, "dof_dampingpoly", np.zeros((model.nv, 1)))[dofs]
    return np.asarray(model.dof_damping[dofs] + more @ rate ** np.arange(1, more.shape[1] + 1))


def friction_loss(model: mujoco.MjModel, dofs: Integers, rate: float) -> float:
    """The moment by which friction holds a joint that turns at a rate: the median of them.

    MuJoCo's friction of joints is a damper whose moment has a bound, `frictionloss`; how strong it
    is goes with solreffriction, in the model's own unit of time.
    """
    if not model.dof_frictionloss[dofs].any():
        return 0.0
    data = mujoco.MjData(model)
    data.qvel[dofs] = rate
    mujoco.mj_forward(model, data)
    rubs = data.efc_type == mujoco.mjtConstraint.mjCNSTR_FRICTION_DOF
    mine = rubs & np.isin(data.efc_id, dofs)
    held = np.abs(data.efc_D * data.efc_aref)[mine]
    most = data.efc_frictionloss[mine]
    return float(np.median(np.minimum(held, most))) if mine.any() else 0.0
