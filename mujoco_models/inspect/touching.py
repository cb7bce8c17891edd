"""What of a user's vibrissa can touch an object: geoms, or the edges of a flex."""

import math
from collections.abc import Iterator
from typing import Any, Literal, NamedTuple

import mujoco
import numpy as np
from scipy.optimize import brentq

from analytic.numerics.arrays import Floats
from mujoco_models.inspect.measured import Geom
from mujoco_models.inspect.parts import Parts, axis_of, radius_of, size_of
from mujoco_models.inspect.probe import Probe
from mujoco_models.inspect.rod import Rod
from mujoco_models.model.solref import impedance_at, pushes

LEAST_FRICTION = float(mujoco.mjMINMU)
"""What MuJoCo takes for none, where condim is above 1."""
_NOTHING = 1e-200


def touching(
    model: mujoco.MjModel,
    parts: Parts,
    data: mujoco.MjData,
    frame: tuple[Floats, Floats],
    probe: Probe | None,
    force: float,
) -> tuple[Geom, ...]:
    """All that can touch, from the clamp to the tip, by its nodes and the axes of the sweep.

    How stiff that is, counts under a force.
    """
    return tuple(
        _geom(model, piece, frame, probe, force)
        for piece in (
            _links(model, parts, data) if parts.rod is None else _edges(model, parts.rod, data)
        )
    )


def thickness(model: mujoco.MjModel, parts: Parts) -> float:
    """Half of that of the tip."""
    if parts.rod is not None:
        return float(model.flex_radius[parts.rod.flex])
    return radius_of(model, parts.geoms[-1])


class _Piece(NamedTuple):
    """A geom or an edge; fields of MuJoCo's model begin with its kind."""

    name: str
    kind: Literal["geom", "flex"]
    number: int
    ends: Floats  # of its axis, shape (2, 3)
    radius: float
    weight: float  # the acceleration by a unit of force; 0 if it cannot move


def _links(model: mujoco.MjModel, parts: Parts, data: mujoco.MjData) -> Iterator[_Piece]:
    for number in parts.geoms:
        body = int(model.geom_bodyid[number])
        ends = data.xpos[body] + axis_of(model, number) @ data.xmat[body].reshape(3, 3).T
        weight = float(model.body_invweight0[body, 0])
        name, radius = name_of_geom(model, number), radius_of(model, number)
        yield _Piece(name, "geom", number, ends, radius, weight)


def _edges(model: mujoco.MjModel, rod: Rod, data: mujoco.MjData) -> Iterator[_Piece]:
    vertices = data.flexvert_xpos[list(rod.vertices)]
    bodies = model.flex_vertbodyid[list(rod.vertices)]
    radius = float(model.flex_radius[rod.flex])
    for i in range(len(vertices) - 1):
        # Each vertex takes half of a force on the middle, and moves half as far as the middle.
        weight = float(model.body_invweight0[bodies[i : i + 2], 0].sum()) / 4 if i else 0.0
        yield _Piece(f"edge {i}", "flex", rod.flex, vertices[i : i + 2], radius, weight)


def _geom(
    model: mujoco.MjModel,
    piece: _Piece,
    frame: tuple[Floats, Floats],
    probe: Probe | None,
    force: float,
) -> Geom:
    (nodes, axes), weight = frame, piece.weight

    def stated(field: str) -> Any:  # noqa: ANN401  # whatever MuJoCo's field holds
        return getattr(model, f"{piece.kind}_{field}")[piece.number]

    if weight and probe is not None:
        geom = piece.number if piece.kind == "geom" else -1
        middle = piece.ends.mean(axis=0)
        weight = probe.weight(geom, middle, axes[0], piece.radius) or weight
    places, beside = _along(nodes, piece.ends)
    in_plane = beside - np.outer(beside @ axes[2], axes[2])
    start, end = sorted(places.tolist())
    solref, solimp = stated("solref"), stated("solimp").tolist()
    stiffness, decay, ratio = _pushes(model, solref.tolist(), solimp, weight, force)
    off = mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    none_does = model.opt.disableflags & int(off)
    body = int(model.geom_bodyid[piece.number]) if piece.kind == "geom" else -1
    apart = 0 in kept_apart(model, body)
    return Geom(
        name=piece.name,
        number=piece.number,
        start=start,
        end=end,
        aside=float(np.linalg.norm(beside, axis=1).max()),
        aside_in_plane=float(np.linalg.norm(in_plane, axis=1).max()),
        radius=piece.radius,
        size=size_of(model, piece.number) if piece.kind == "geom" else (),
        rounded=piece.kind == "geom" and stated("type") == mujoco.mjtGeom.mjGEOM_CAPSULE,
        meets=not (none_does or apart) and bool((stated("contype") | stated("conaffinity")) & 1),
        kept_apart=apart,
        weight=weight,
        stiffness=stiffness,
        time_constant=float(solref[0]) if solref[0] > 0 else math.nan,
        decay=decay,
        damping_ratio=ratio,
        friction=max(float(stated("friction")[0]), _least(model)) if stated("condim") > 1 else 0.0,
        margin=float(stated("margin")),
    )


def _least(model: mujoco.MjModel) -> float:
    """A pyramid of so little makes contacts 1/friction^2 times as hard; an ellipse is harmless."""
    return LEAST_FRICTION if model.opt.cone == mujoco.mjtCone.mjCONE_PYRAMIDAL else 0.0


def _along(nodes: Floats, points: Floats) -> tuple[Floats, Floats]:
    """Arc lengths of what of the vibrissa is nearest to points, and the ways from it to them."""
    ways = np.diff(nodes, axis=0)
    lengths = np.linalg.norm(ways, axis=1)
    some = lengths > 0  # the clamp may be at the first hinge
    ways, lengths, starts = ways[some], lengths[some], nodes[:-1][some]
    least, most = np.zeros(len(lengths)), lengths.copy()
    least[0], most[-1] = -np.inf, np.inf
    units = ways / lengths[:, None]
    on = np.clip(np.einsum("pij,ij->pi", points[:, None] - starts, units), least, most)
    off = points[:, None] - starts - on[..., None] * units
    best = (np.arange(len(points)), np.argmin(np.linalg.norm(off, axis=-1), axis=1))
    return np.asarray((np.cumsum(lengths) - lengths + on)[best]), np.asarray(off[best])


def _pushes(
    model: mujoco.MjModel, solref: list[float], solimp: list[float], weight: float, force: float
) -> tuple[float, float, float]:
    """Force over penetration at rest under a force, the rate of the damper, and its ratio.

    As deep as that force presses it, where its impedance changes with the depth.
    """
    safe = not model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_REFSAFE)
    inverse, step = weight or 1.0, model.opt.timestep if safe else 0.0

    def at(depth: float) -> tuple[float, float]:
        stiffness, damping = pushes(solref, solimp, inverse, depth, step)
        return max(stiffness, _NOTHING), damping

    def too_deep(log_depth: float) -> float:
        return log_depth + math.log(at(math.exp(log_depth))[0] / force)

    low, high = sorted((at(0.0)[0], at(math.inf)[0]))
    depth = 0.0
    if high > low:
        depth = math.exp(brentq(too_deep, math.log(force / high) - 1, math.log(force / low) + 1))
    (stiffness, damping), d = at(depth), impedance_at(solimp, depth)
    gives = (1 - d) * inverse
    ratio = damping / 2 * math.sqrt(gives / stiffness)  # a garbled mass yields without end
    return stiffness if weight else math.inf, damping * gives / d, ratio


def name_of_geom(model: mujoco.MjModel, number: int) -> str:
    if number < 0:
        return "the flex"
    own, body = model.geom(number).name, model.body(model.geom_bodyid[number]).name
    return own or body or f"geom {number}"


def kept_apart(model: mujoco.MjModel, body: int) -> list[int]:
    """The bodies that <exclude> keeps from one."""
    ends = np.stack([model.exclude_signature >> 16, model.exclude_signature & 0xFFFF])
    found: list[int] = ends[::-1][ends == body].tolist()
    return found


def self_contacts(model: mujoco.MjModel, parts: Parts) -> tuple[str, ...]:
    """Pairs that touch in the model's first state, one of them the vibrissa's."""
    pairs = _met(model, parts, mujoco.MjData(model))
    return tuple(" and ".join(name_of_geom(model, g) for g in pair) for pair in pairs)


def of_its_hand(model: mujoco.MjModel, parts: Parts, state: Floats) -> set[int]:
    """What moves with the foot and touches the vibrissa in a state."""
    data = mujoco.MjData(model)
    data.qpos[:] = state
    others = {g for pair in _met(model, parts, data) for g in pair} - {*parts.geoms, -1}
    return others & _on_same_hand(model, parts)


def beside_it(
    model: mujoco.MjModel, parts: Parts, data: mujoco.MjData, axes: Floats, reach: float
) -> set[int]:
    """What gives way itself, as another vibrissa, in the plane and within reach of this one."""
    mine = [*parts.geoms]
    kind, meets = model.geom_contype, model.geom_conaffinity
    met = (kind & np.bitwise_or.reduce(meets[mine], initial=0)) > 0
    met |= (meets & np.bitwise_or.reduce(kind[mine], initial=0)) > 0
    away = data.geom_xpos - data.xpos[parts.chain[0]]
    near = np.linalg.norm(away, axis=1) < reach + model.geom_rbound
    thick = model.geom_size[:, 0] + model.geom_size[mine, 0].max(initial=0.0)
    in_plane = np.abs(away @ axes[2]) < thick
    moves = model.body_weldid[model.geom_bodyid] != model.body_weldid[parts.foot]
    return {*np.flatnonzero(met & near & in_plane & moves).tolist()} & _on_same_hand(model, parts)


def _on_same_hand(model: mujoco.MjModel, parts: Parts) -> set[int]:
    """Geoms of bodies that move with the foot, without the vibrissa's."""
    root = model.body_rootid[model.geom_bodyid]
    same = np.flatnonzero((root == model.body_rootid[parts.foot]) & (root != 0))
    of_chain = np.isin(model.body_weldid[model.geom_bodyid[same]], parts.chain)
    return {*same[~of_chain].tolist()}


def _met(model: mujoco.MjModel, parts: Parts, data: mujoco.MjData) -> list[tuple[int, ...]]:
    """Pairs of geoms that touch in a state, one of them the vibrissa's; -1 is a flex."""
    mujoco.mj_forward(model, data)
    flex = -2 if parts.rod is None else parts.rod.flex
    found = [
        tuple(contact.geom.tolist())
        for contact in data.contact
        if contact.efc_address >= 0
        and (not {*parts.geoms}.isdisjoint(contact.geom.tolist()) or flex in contact.flex)
    ]
    return list(dict.fromkeys(found))
