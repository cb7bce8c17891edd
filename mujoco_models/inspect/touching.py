"""What of a user's vibrissa can touch an object: geoms, or the edges of a flex."""

from collections.abc import Iterator

import mujoco
import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.inspect.measured import Geom
from mujoco_models.inspect.parts import Parts, axis_of, radius_of
from mujoco_models.inspect.probe import Probe
from mujoco_models.inspect.rod import Rod


def touching(
    model: mujoco.MjModel,
    parts: Parts,
    data: mujoco.MjData,
    frame: tuple[Floats, Floats],
    probe: Probe | None,
) -> tuple[Geom, ...]:
    """All that can touch, from the clamp to the tip."""
    if parts.rod is not None:
        return tuple(_edges(model, parts.rod, data, frame, probe))
    return tuple(_geoms(model, parts, data, frame, probe))


def thickness(model: mujoco.MjModel, parts: Parts) -> float:
    """Half of that of the tip."""
    if parts.rod is not None:
        return float(model.flex_radius[parts.rod.flex])
    return radius_of(model, parts.geoms[-1])


def _geoms(
    model: mujoco.MjModel,
    parts: Parts,
    data: mujoco.MjData,
    frame: tuple[Floats, Floats],
    probe: Probe | None,
) -> Iterator[Geom]:
    clamp, axes = frame
    for number in parts.geoms:
        body = int(model.geom_bodyid[number])
        turn = data.xmat[body].reshape(3, 3)
        ends = data.xpos[body] + axis_of(model, number) @ turn.T
        start, end = sorted(((ends - clamp) @ axes[1]).tolist())
        weight = float(model.body_invweight0[body, 0])  # 0 if it cannot move
        if weight and probe is not None:
            radius = radius_of(model, number)
            weight = probe.weight(number, ends.mean(axis=0), axes[0], radius) or weight
        stiffness, time_constant = _stiffness(
            model, model.geom_solref[number], model.geom_solimp[number], weight
        )
        yield Geom(
            name_of_geom(model, number),
            start,
            end,
            radius_of(model, number),
            _meets(model, model.geom_contype[number], model.geom_conaffinity[number]),
            stiffness,
            time_constant,
            float(model.geom_friction[number, 0]) if model.geom_condim[number] > 1 else 0.0,
            float(model.geom_margin[number] - model.geom_gap[number]),
        )


def _edges(
    model: mujoco.MjModel,
    rod: Rod,
    data: mujoco.MjData,
    frame: tuple[Floats, Floats],
    probe: Probe | None,
) -> Iterator[Geom]:
    (clamp, axes), flex = frame, rod.flex
    vertices = data.flexvert_xpos[list(rod.vertices)]
    bodies = model.flex_vertbodyid[list(rod.vertices)]
    radius = float(model.flex_radius[flex])
    meets = _meets(model, model.flex_contype[flex], model.flex_conaffinity[flex])
    margin = float(model.flex_margin[flex] - model.flex_gap[flex])
    friction = float(model.flex_friction[flex, 0]) if model.flex_condim[flex] > 1 else 0.0
    for i, (ends, pair) in enumerate(zip(_pairs(vertices), _pairs(bodies), strict=True)):
        start, end = sorted(((ends - clamp) @ axes[1]).tolist())
        # Each vertex takes half of a force on the middle, and moves half as far as the middle.
        weight = float(model.body_invweight0[pair, 0].sum()) / 4 if i else 0.0
        if weight and probe is not None:
            weight = probe.weight(-1, ends.mean(axis=0), axes[0], radius) or weight
        stiffness, time_constant = _stiffness(
            model, model.flex_solref[flex], model.flex_solimp[flex], weight
        )
        name = f"edge {i}"
        yield Geom(name, start, end, radius, meets, stiffness, time_constant, friction, margin)


def _meets(model: mujoco.MjModel, contype: int, conaffinity: int) -> bool:
    """Whether it collides with an object that has MuJoCo's default contype and conaffinity."""
    none_does = model.opt.disableflags & int(mujoco.mjtDisableBit.mjDSBL_CONTACT)
    return not none_does and bool((contype & 1) | (conaffinity & 1))


def _pairs(values: Floats) -> Floats:
    return np.stack([values[:-1], values[1:]], axis=1)


def _stiffness(
    model: mujoco.MjModel, solref: Floats, solimp: Floats, weight: float
) -> tuple[float, float]:
    """Force over penetration at rest, and the time constant if solref states one.

    The force is k/((1 - d) A) times the depth, with MuJoCo's k, impedance d and the body's inverse
    mass A; see MuJoCo's documentation, "Solver parameters".
    """
    time_constant, ratio = solref.tolist()
    impedance = min(float(solimp[0]), 0.9999)
    if time_constant > 0:
        stiffness = 1 / (max(time_constant, 2 * model.opt.timestep) * ratio) ** 2
    else:
        stiffness, time_constant = -time_constant, np.nan
    return float(stiffness / ((1 - impedance) * weight)) if weight else np.inf, time_constant


def name_of_geom(model: mujoco.MjModel, number: int) -> str:
    """Of a geom, or of what has none."""
    if number < 0:
        return "the flex"
    own = mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, number)
    body = int(model.geom_bodyid[number])
    return own or mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_BODY, body) or f"geom {number}"


def self_contacts(model: mujoco.MjModel, parts: Parts) -> tuple[str, ...]:
    """Pairs that touch in the model's first state, one of them the vibrissa's."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    flex = -2 if parts.rod is None else parts.rod.flex
    found = []
    for contact in data.contact:
        mine = not {*parts.geoms}.isdisjoint(contact.geom.tolist()) or flex in contact.flex
        if contact.dist < 0 and mine:
            names = [name_of_geom(model, g) for g in contact.geom.tolist()]
            found.append(" and ".join(names))
    return tuple(dict.fromkeys(found))
