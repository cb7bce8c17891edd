"""Measure the beam that a user's model is: stiffness, mass, clamp, sensors, contacts."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Literal, cast

import mujoco
import numpy as np
from threadpoolctl import threadpool_limits

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from mujoco_models.inspect.ahead import ahead, on_its_way
from mujoco_models.inspect.axes import is_planar, lean_of, sweep_axes
from mujoco_models.inspect.beside import check_constraints, check_tendons
from mujoco_models.inspect.drive import (
    damping_at,
    drive_of,
    friction_loss,
    holders,
    joints_of,
    movable,
    name_of,
    rail_of,
    reach_of,
)
from mujoco_models.inspect.hand import measure_hand, on_weld
from mujoco_models.inspect.held import BEYOND, lengths
from mujoco_models.inspect.held_chain import HeldChain
from mujoco_models.inspect.held_rod import HeldRod
from mujoco_models.inspect.load import load, spec_of
from mujoco_models.inspect.measured import Joint, MeasuredBeam
from mujoco_models.inspect.parts import Names, Parts, find, masses_of
from mujoco_models.inspect.probe import probe_of
from mujoco_models.inspect.sensors import Held, readings_of
from mujoco_models.inspect.touching import (
    beside_it,
    name_of_geom,
    of_its_hand,
    self_contacts,
    thickness,
    touching,
)
from mujoco_models.inspect.unloaded import unloaded
from mujoco_models.inspect.unsolved import unsolved
from mujoco_models.motion import IntegratorKind
from mujoco_models.quiet import unlogged

# EI/L^2; up to a tip turned by 82 degrees, and so close that one that curves by 2/L comes to rest.
_LOADS = (0.01, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0)
_MOST_LOADS = (0.0, *_LOADS, 20.0)  # as the catenary bends it, 6.2/L at the clamp
_TURN, _SWEEP = 5.0, 40.0  # rad and T1; of all joints together in a sweep at 0.05 L/T1
_WAY = 2.0  # L; of the foot in it
_PRESSES = 3.0  # EI/L^2; the largest force of it
_SHARES = (0.01, 0.1, 1.0)  # of gravity
_TWISTS = 1e-6  # of a bend by as large a moment; what twists less, only rounding twists
_TINY = 1e-11  # of the longest cell or largest bend; what is less, only rounding has
_LONGEST = 1e60  # a first period: its fourth power is a number, too
_REAL = 1e-6  # of a root: what is not real is more off it
_FARTHEST = 3.0  # from zero, of all at which Runge and Kutta's steps do not grow


def inspect_model(path: Path, names: Names) -> MeasuredBeam:
    """Load a model, find its vibrissa, and measure it."""
    model = load(path, names.site)
    with unlogged(), threadpool_limits(1):  # the matrices are small
        return measure(model, find(model, names), path, names.site)


def hold(model: mujoco.MjModel, parts: Parts) -> Held:
    return HeldChain(model, parts) if parts.rod is None else HeldRod(model, parts, parts.rod)


def measure(
    model: mujoco.MjModel, parts: Parts, path: Path, site: str | None = None
) -> MeasuredBeam:
    """Measure the vibrissa of a model.

    All of it is MuJoCo's: the foot is held, loads are put on the tip, and Newton's method finds the
    rest. The axes of the sweep are x against the sweep, y along the vibrissa, z the axis of its
    hinges.
    """
    check_constraints(model, parts)
    check_tendons(model, parts)
    held = hold(model, parts)
    held.unload()
    axes = sweep_axes(held)
    nodes = np.vstack([held.clamp, held.joints, held.tip])
    s = np.cumsum(lengths(nodes))
    length = float(s[-1])
    bending, chain = held.bending(axes), parts.rod is None
    slowest = float(np.sqrt(bending.squares[bending.first]))
    period = 2 * np.pi / slowest
    rate = _TURN / len(parts.chain) / (_SWEEP * period)
    dampers = damping_at(model, held.dofs, rate)
    if chain and (dampers != model.dof_damping[held.dofs]).any():
        held.model.dof_damping[held.dofs] = dampers
        bending = held.bending(axes)
    squares, damping = bending.squares, bending.damping
    tip_rigidity = length**3 / (3 * bending.tip_compliance)
    joints = _joints(held, s[:-1], bending.compliances, nodes, axes)
    longest = float(2 * np.pi / np.sqrt(squares[0]))
    if not 1 / _LONGEST < longest < _LONGEST:
        raise InputError(
            "model", f"with a first period of {longest:g}", "one with a mass that its springs move",
            "correct the masses of the vibrissa and of what holds it",
        )  # fmt: skip
    welded = on_weld(model, parts, -axes[0]) if chain else None
    force, torque = readings_of(welded or held, axes, tip_rigidity, length)
    thick = thickness(model, parts)
    probe, unit = probe_of(path, thick), tip_rigidity / length**2
    loads, bent, in_the_way = _bent(held, model, axes, unit)
    sag, weight = _sag(held, axes)
    drive = drive_of(model, parts.foot, -axes[0])
    rail = rail_of(model, parts.foot, -axes[0])
    whole = np.diag(squares), np.diag(damping), np.eye(len(squares))
    if chain:
        beside = np.flatnonzero(~np.isin(model.dof_bodyid, parts.chain))
        whole = HeldChain(model, parts, beside).slopes()
    return MeasuredBeam(
        model=_model_name(model),
        foot=name_of(model.body(parts.foot), "body"),
        body=parts.foot,
        body_mass=float(model.body_mass[parts.foot]),
        leads=_on(model, parts),
        frame=np.vstack([held.clamp - held.data.xpos[parts.foot], axes]) @ held.axes_of(parts.foot),
        springs=_springs(parts),
        drive=drive,
        rail=None if rail is None else replace(rail, way=axes @ rail.way),
        reach=reach_of(model, parts.foot, -axes[0], _WAY * length / (_SWEEP * period)),
        switched=_switched(model, tied=welded is not None or not chain),
        objects=movable(model, {*parts.chain, *holders(model, parts.foot)}),
        hand=measure_hand(model, parts, axes, length, period) if chain else None,
        length=length,
        joints=joints,
        geoms=touching(model, parts, held.data, (nodes, axes), probe, _PRESSES * unit),
        tip_rigidity=tip_rigidity,
        stretch=bending.stretch,
        loads=loads,
        bent=bent,
        out_of_plane=float(np.abs((nodes - nodes[0]) @ axes[2]).max()),
        mass=float(masses_of(model, parts.chain).sum()),
        period=period,
        period_without_armature=float(2 * np.pi / np.sqrt(bending.slowest_without_armature)),
        stable_step=_stable_step(model, *whole),
        unsolved=unsolved(
            spec_of(path, site), parts, held.data.qpos, (nodes, axes), thick, tip_rigidity, period
        ),
        unloaded=unloaded(model, parts, held.data.qpos, axes, length, period, (force, torque)),
        damping_ratio=float(damping[bending.first] / (2 * slowest)),
        medium=(model.opt.density, model.opt.viscosity, float(np.linalg.norm(model.opt.wind))),
        gravity=tuple((axes @ held.gravity).tolist()),
        sag=sag,
        weight=weight,
        force=force,
        torque=torque,
        planar=is_planar(held, axes[2]),
        lean=lean_of(held, axes[1]),
        torsion=_torsion(held, axes[1], length / float(bending.compliances.sum()), length),
        self_contacts=self_contacts(model, parts),
        in_the_way=tuple(sorted(in_the_way | beside_it(model, parts, held.data, axes, length))),
        on_its_way=tuple(
            name_of_geom(model, one)
            for one in (on_its_way(model, parts, held.data, nodes, axes) if drive else ())
        ),
        ahead=ahead(model, parts, held.data, nodes, axes),
        timestep=float(model.opt.timestep),
        integrator=cast(
            IntegratorKind,
            mujoco.mjtIntegrator(model.opt.integrator).name.removeprefix("mjINT_").lower(),
        ),
        cone="elliptic" if model.opt.cone == mujoco.mjtCone.mjCONE_ELLIPTIC else "pyramidal",
        friction_loss=friction_loss(model, held.dofs, rate),
        **{
            name: _moved(held, model, field, axes[0] * unit)
            for name, field in zip(("limits", "stiffening"), BEYOND, strict=True)
        },
    )


def _on(model: mujoco.MjModel, parts: Parts) -> int:
    """The body on the foot that is the first link, or holds that."""
    body = parts.chain[0]
    while model.body_parentid[body] != parts.foot:
        body = int(model.body_parentid[body])
    return body


def _torsion(held: Held, along: Floats, rigidity: float, length: float) -> float:
    """GJ over EI, by the turn of its tip under a moment along it; infinite if it cannot twist."""
    if isinstance(held, HeldRod):  # MuJoCo's flex has no torsion: its vertices do not turn
        return math.inf
    moment = held.small * rigidity / length * along
    twist = float(held.turn_by(lambda: held.load(np.zeros(3), moment)) @ along) / held.small
    return 1 / twist if twist > _TWISTS else math.inf


def _joints(
    held: Held, s: Floats, compliance: Floats, nodes: Floats, axes: Floats
) -> tuple[Joint, ...]:
    length = float(lengths(nodes).sum())
    bounds = np.concatenate([[0.0], (s[1:] + s[:-1]) / 2, [length]])
    ways = np.diff(nodes, axis=0)[1:]
    slopes = np.arctan2(-ways @ axes[0], ways @ axes[1])
    angles = np.diff(np.unwrap(slopes), prepend=0.0)
    bodies = held.parts.chain
    names = [name_of(held.model.body(body), "body") for body in bodies]
    damping = [held.model.dof_damping[held.model.dof_bodyid == body].max() for body in bodies]
    refs = [max(_springrefs(held.model, body), key=abs, default=0.0) for body in bodies]
    masses = masses_of(held.model, bodies)
    cells = np.diff(bounds)
    for name, cell, bends in zip(names, cells, compliance, strict=True):
        if not (cell > _TINY * length and bends > _TINY * compliance.max()):
            raise InputError(
                f"body {name!r} of the vibrissa", "without a bend in the plane of the others'",
                "hinged across the same plane as they, at a place of its own",
                "turn its hinge or add one, or say which is the vibrissa with --foot",
            )  # fmt: skip
    figures = np.stack([s, cells, compliance, angles, refs, damping, masses], axis=1).tolist()
    return tuple(
        Joint(name, (*joints_of(held.model, body),), _rigid(held.model, body, after), *row)
        for name, body, after, row in zip(names, bodies, (*bodies[1:], 0), figures, strict=True)
    )


def _springrefs(model: mujoco.MjModel, body: int) -> list[float]:
    hinges = [j for j in joints_of(model, body) if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE]
    places = model.jnt_qposadr[hinges]
    found: list[float] = (model.qpos_spring[places] - model.qpos0[places]).tolist()
    return found


def _rigid(model: mujoco.MjModel, body: int, after: int) -> tuple[str, ...]:
    """The bodies from one to the next that are fixed to the first."""
    found = []
    while (after := int(model.body_parentid[after])) != body and model.body_weldid[after] == body:
        found.append(name_of(model.body(after), "body"))
    return tuple(found)


def _bent(
    held: Held, model: mujoco.MjModel, axes: Floats, unit: float
) -> tuple[Floats, Floats, set[int]]:
    """Tip displacements under forces across the beam, ever larger ones, and what it meets then."""
    start, met = held.tip, set[int]()
    loads = unit * np.array(_LOADS)
    bent = []
    for load_ in loads:
        held.load(load_ * axes[0], np.zeros(3))
        held.rest()
        moved = held.tip - start
        bent.append([moved @ axes[0], -moved @ axes[1]])
        met |= of_its_hand(model, held.parts, held.data.qpos)
    held.unload()
    return loads, np.array(bent), met


def _sag(held: Held, axes: Floats) -> tuple[float, float]:
    """How far gravity moves the tip, and what the force sensor reads of it in the plane."""
    gravity = axes @ held.gravity
    start, sensor = held.tip, held.parts.force
    mass = float(held.model.body_mass[list(held.parts.chain)].sum())
    sag, weight = float(np.linalg.norm(held.tip - held.clamp)), mass * np.hypot(*gravity[:2])
    try:
        for share in _SHARES:  # what hangs by far comes to rest from how it hung by less
            held.model.opt.gravity[:] = share * held.gravity
            held.rest()
        sag = float(np.linalg.norm(held.tip - start))
        if sensor is not None:
            _, turn = held.site(sensor)
            weight = float(np.linalg.norm(axes[:2] @ turn @ held.sensed(sensor)))
    except InputError:  # so heavy that it hangs like a chain
        pass
    held.model.opt.gravity[:] = 0
    held.unload()
    return sag, 0.0 if sensor is None else weight


def _springs(parts: Parts) -> Literal["joints", "plugin", "flex"]:
    if parts.rod is not None:
        return "flex"
    return "plugin" if parts.plugin else "joints"


def _moved(held: Held, model: mujoco.MjModel, field: str, force: Floats) -> tuple[float, float]:
    """How far what is beyond linear springs moves the tip, bent by a force, and the other way."""
    own, joints = getattr(model, field, None), np.isin(model.jnt_bodyid, held.parts.chain)
    if own is None or not own[joints].any():
        return 0.0, 0.0
    stated = hold(model, held.parts)
    getattr(stated.model, field)[:] = own
    found = []
    for sense in (1, -1):
        found.append(max(_apart(held, stated, load_ * sense * force) for load_ in _MOST_LOADS))
        held.unload()
        stated.set_back()
    return found[0], found[1]


def _apart(held: Held, stated: Held, force: Floats) -> float:
    """How far the tips of two are from each other; infinite if the second comes to no rest."""
    for one in (held, stated):
        one.load(force, np.zeros(3))
    held.rest()
    try:
        stated.rest()
    except InputError:
        return math.inf
    return float(np.linalg.norm(held.tip - stated.tip))


def _switched(model: mujoco.MjModel, tied: bool) -> tuple[tuple[str, str], ...]:
    """Flags by which it is not what it states, of equality constraints if one holds it."""
    off, on = mujoco.mjtDisableBit, mujoco.mjtEnableBit
    disabled = {"constraint": off.mjDSBL_CONSTRAINT, "contact": off.mjDSBL_CONTACT,
                "actuation": off.mjDSBL_ACTUATION, "spring": off.mjDSBL_SPRING,
                "sensor": off.mjDSBL_SENSOR}  # fmt: skip
    if tied:
        disabled["equality"] = off.mjDSBL_EQUALITY
    found = [(name, "enable") for name, bit in disabled.items() if model.opt.disableflags & bit]
    overrides = model.opt.enableflags & on.mjENBL_OVERRIDE
    return (*found, *([("override", "disable")] if overrides else []))


def _stable_step(
    model: mujoco.MjModel, stiffness: Floats, damping: Floats, inertia: Floats
) -> float:
    """The longest step at which no vibration grows, for integrators explicit in the springs.

    With (M + dt B) v1 = (M - dt (C - B)) v0 - dt K q0 and q1 = q0 + dt v1, of the dampers C those
    in B implicit, one first turns over at each step where 4 M + 2 dt (2 B - C) - dt^2 K is
    singular; Runge and Kutta's fourth order, with the dampers explicit too, has its polynomial.
    """
    kinds, none = mujoco.mjtIntegrator, np.zeros_like(inertia)
    runge_kutta = model.opt.integrator == kinds.mjINT_RK4
    implicit = damping
    if model.opt.integrator == kinds.mjINT_EULER:  # its motors' and a flex's are explicit
        off = model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_EULERDAMP
        off |= len(damping) < model.nv
        implicit = none if off else np.minimum(damping, np.diag(model.dof_damping))
    of_place, of_speed = (
        (-stiffness, -damping) if runge_kutta else (stiffness / 4, damping / 2 - implicit)
    )
    rows = np.linalg.solve(inertia, np.hstack([of_place, of_speed]))
    roots = np.linalg.eigvals(np.vstack([np.eye(len(rows), len(rows.T), len(rows)), rows]))
    if not runge_kutta:
        turning = roots.real[np.abs(roots.imag) <= _REAL * np.abs(roots)]
        return float(1 / turning.max())
    falling = roots[roots.real < 0]
    low, high = 0.0, float(_FARTHEST / np.abs(falling).max())
    while high - low > _REAL * high:
        z = falling * (low + high) / 2
        grows = (np.abs(1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)))) > 1 + _REAL).any()
        low, high = (low, (low + high) / 2) if grows else ((low + high) / 2, high)
    return low


def _model_name(model: mujoco.MjModel) -> str:
    return bytes(model.names[: model.names.find(b"\0")]).decode(errors="replace")
