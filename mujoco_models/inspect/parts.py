"""What of a user's model is the vibrissa, its foot, and the sensors at its clamp."""

from dataclasses import dataclass
from fnmatch import fnmatchcase

import mujoco
import numpy as np
from numpy.typing import NDArray

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError, unknown
from mujoco_models.inspect.drive import holders as holders_of
from mujoco_models.inspect.load import FORCE, TORQUE
from mujoco_models.inspect.rod import Chain, Rod, flexes, rod_of

_FEWEST = 3  # joints of a vibrissa; what has fewer is an arm
_BENDS = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_BALL))
_SLENDER = (int(mujoco.mjtGeom.mjGEOM_CAPSULE), int(mujoco.mjtGeom.mjGEOM_CYLINDER))
_SPHERE = int(mujoco.mjtGeom.mjGEOM_SPHERE)
_NOTHING = 1e-300
_GOES_ON = 0.8  # cosine; links of a vibrissa are bent by less
_ALIGNED = 0.03  # lengths of a link; a geom of the foot that goes on as the vibrissa, or its arc
_AS_THICK = 1.5  # radii of a link; what is thicker than that, holds it


@dataclass(frozen=True)
class Names:
    """The names that a user gives; what is None is looked for."""

    foot: str | None = None  # the body that holds the vibrissa
    force: str | None = None  # the sensors at its clamp
    torque: str | None = None  # the sensors at its clamp
    # The vibrissa's geoms: names or patterns as ``whisker*``, separated by commas.
    geoms: str | None = None
    # At the clamp, where sensors were added; they count instead of the model's own.
    site: str | None = None


@dataclass(frozen=True)
class Parts:
    """The vibrissa in a compiled model."""

    foot: int  # the outermost of the bodies that hold it without a joint in between
    chain: Chain  # its bodies with joints, from the clamp to the tip
    geoms: tuple[int, ...]  # its geoms, from the clamp to the tip
    force: int | None  # the sensors at its clamp; None if there is none
    torque: int | None  # the sensors at its clamp; None if there is none
    rod: Rod | None = None  # the flex that it is, instead of geoms on hinges
    plugin: bool = False  # whether MuJoCo 3's plugin of cables bends it


def find(model: mujoco.MjModel, names: Names) -> Parts:
    """Find the vibrissa, as far as the names leave it open.

    It is the longest row of bodies, each on the one before by hinges or a ball without an
    actuator, or the vertices of a flex of dimension 1; what holds the first of them is the foot.
    """
    asked = None if names.geoms is None else _geoms(model, names.geoms)
    rods = flexes(model)
    chains = [*_chains(model), *rods]
    if names.foot is not None:
        known = [model.body(i).name for i in range(model.nbody)]
        foot = _named("foot", names.foot, "body", known)
        chains = [chain for chain in chains if foot in _holders(model, chain[0])]
    if asked is not None:
        bodies = set(model.body_weldid[model.geom_bodyid[asked]].tolist())
        chains = [chain for chain in chains if bodies.intersection(chain)]
    if not chains:
        raise InputError(
            "model",
            "without a vibrissa" + ("" if names == Names() else " where the names say"),
            f"with a row of at least {_FEWEST} bodies on hinges or balls without actuators",
            "name the body that holds it with --foot, or its geoms with --geoms",
        )
    longest = max(map(len, chains))
    likely = [chain for chain in chains if 2 * len(chain) > longest]
    if len(likely) > 1:
        shown = ", ".join(
            f"{len(chain)} links from {model.body(chain[0]).name!r} on "
            f"{model.body(model.body_parentid[chain[0]]).name!r}"
            for chain in likely[:4]
        )
        raise InputError(
            "model", f"with {len(likely)} candidates ({shown})", "with one vibrissa",
            "say which with --foot or --geoms",
        )  # fmt: skip
    (chain,) = likely
    rod = rod_of(model, rods[chain]) if chain in rods else None
    chain = chain if rod is None else rod.chain
    holders = _holders(model, chain[0])
    geoms = asked if asked is not None else _along(model, holders[0], chain)
    if not geoms and rod is None:
        raise InputError("model", "without geoms on the vibrissa", "one that can touch", "add some")
    if rod is None:
        _check_ends(model, chain, model.body_weldid[model.geom_bodyid[geoms]].tolist())
    bodies = {*holders, *chain}
    if rod is not None:
        bodies |= {*holders_of(model, holders[-1])}
    added = (None, None) if names.site is None else (FORCE, TORQUE)
    force, torque = (
        _sensor(model, word, name, kind, bodies)
        for word, name, kind in (
            ("force", names.force or added[0], mujoco.mjtSensor.mjSENS_FORCE),
            ("torque", names.torque or added[1], mujoco.mjtSensor.mjSENS_TORQUE),
        )
    )
    plugin = bool(_plugins(model)[chain[0]])
    return Parts(holders[-1], chain, tuple(geoms), force, torque, rod, plugin)


def _check_ends(model: mujoco.MjModel, chain: Chain, bodies: list[int]) -> None:
    """Raise InputError where the first or the last link has none of the geoms."""
    for link, end in ((chain[0], bodies[0]), (chain[-1], bodies[-1])):
        if end != link and (link != chain[0] or end in chain):
            raise InputError(
                f"body {model.body(link).name!r} of the vibrissa", "without a geom",
                "one with a geom: the first and the last are where it begins and ends",
                "add one, without mass if need be, or name its own in --geoms",
            )  # fmt: skip


def axis_of(model: mujoco.MjModel, geom: int) -> Floats:
    kind = int(model.geom_type[geom])
    centre, half = np.zeros(3), np.zeros(3)
    if kind in _SLENDER:
        half[2] = model.geom_size[geom, 1]
    elif kind != _SPHERE:
        box = model.geom_aabb[geom]
        centre, axis = box[:3], _axis_of_box(model, geom)
        half[axis] = box[3 + axis]
    ends = np.array([centre - half, centre + half])
    return np.asarray(model.geom_pos[geom] + ends @ _turn(model.geom_quat[geom]).T)


def _axis_of_box(model: mujoco.MjModel, geom: int) -> int:
    """Which of its axes is along the vibrissa: the last link may be thicker than it is long."""
    body, turn = model.geom_bodyid[geom], _turn(model.geom_quat[geom])
    longest = int(np.argmax(model.geom_aabb[geom, 3:]))
    if model.body_jntnum[body] == 0:
        return longest
    # A link is ahead of its joint, or goes on as it comes from its parent, but for how it is bent.
    ahead = (
        model.geom_pos[geom]
        + turn @ model.geom_aabb[geom, :3]
        - model.jnt_pos[model.body_jntadr[body]]
    )
    for way in (ahead @ turn, model.body_pos[body] @ _turn(model.body_quat[body]) @ turn):
        along = np.abs(way) / max(float(np.linalg.norm(way)), _NOTHING)
        if along.max() > _GOES_ON:
            return int(np.argmax(along))
    return longest


def _turn(quaternion: Floats) -> Floats:
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, quaternion)
    return turn.reshape(3, 3)


def masses_of(model: mujoco.MjModel, chain: Chain) -> Floats:
    """Of its links, with all that is fixed to them."""
    masses = np.bincount(model.body_weldid, model.body_mass, model.nbody)
    return np.asarray(masses[list(chain)], dtype=float)


def radius_of(model: mujoco.MjModel, geom: int) -> float:
    """Half the thickness of a geom."""
    if int(model.geom_type[geom]) in (*_SLENDER, _SPHERE):
        return float(model.geom_size[geom, 0])
    return float(np.sort(model.geom_aabb[geom, 3:])[:2].mean())


def size_of(model: mujoco.MjModel, geom: int) -> tuple[float, ...]:
    """A file's `size` of a sphere, capsule or cylinder; of others empty."""
    kind = int(model.geom_type[geom])
    count = 2 * (kind in _SLENDER) + (kind == _SPHERE)
    return tuple(model.geom_size[geom, :count].tolist())


def _plugins(model: mujoco.MjModel) -> NDArray[np.bool_]:
    """Which bodies a plugin bends."""
    return np.asarray(getattr(model, "body_plugin", np.full(model.nbody, -1))) >= 0


def _chains(model: mujoco.MjModel) -> list[Chain]:
    """Rows of bodies that bend, none part of a longer one."""
    driven = model.actuator_trnid[model.actuator_trntype == mujoco.mjtTrn.mjTRN_JOINT, 0]
    bends = np.isin(model.jnt_type, _BENDS)
    bends[driven] = False
    others = model.jnt_bodyid[~np.isin(model.jnt_type, _BENDS)]  # what slides, too, is a hand
    bending = {*model.jnt_bodyid[bends].tolist()} - {*others.tolist()}
    plugin = _plugins(model)
    holder = model.body_weldid[model.body_parentid]  # what is fixed to a link is part of it
    inner = {*holder[[*bending]].tolist()}
    chains = []
    for body in sorted(bending - inner):
        row = [body]
        while (parent := int(holder[row[-1]])) in bending and plugin[parent] == plugin[row[-1]]:
            row.append(parent)
        if len(row) >= _FEWEST:
            chains.append(tuple(reversed(row)))
    return chains


def _holders(model: mujoco.MjModel, link: int) -> list[int]:
    """What holds the first link, and what that is fixed to, but for the world."""
    found = [int(model.body_parentid[link])]
    while model.body_jntnum[found[-1]] == 0 and model.body_parentid[found[-1]] != 0:
        found.append(int(model.body_parentid[found[-1]]))
    return found


def _along(model: mujoco.MjModel, foot: int, chain: Chain) -> list[int]:
    """The geoms of the chain, and of the foot what goes on as the first link does."""
    found = [geom for body in chain for geom in _touchable(model, body)]
    if not found:
        return []
    # The first of them may be a ball on its joint.
    ways = np.array([np.diff(axis_of(model, geom), axis=0)[0] for geom in found])
    way = next((way for way in ways if way.any()), np.zeros(3))
    length = float(np.linalg.norm(way))
    if length == 0:
        return found
    direction = _turn(model.body_quat[chain[0]]) @ way / length
    origin = model.body_pos[chain[0]]
    rigid = []
    for geom in np.flatnonzero(model.geom_bodyid == foot).tolist():
        thick = radius_of(model, geom) > _AS_THICK * radius_of(model, found[0])
        if foot == 0 or thick or model.geom_type[geom] == _SPHERE:
            continue
        off = axis_of(model, geom) - origin
        aside = off - np.outer(off @ direction, direction)
        ends, along = np.linalg.norm(off, axis=1), np.ptp(off @ direction)
        leads_there = ends.min() < _ALIGNED * length and along > _GOES_ON * np.ptp(ends)
        if leads_there or np.abs(aside).max() < _ALIGNED * length:
            rigid.append(geom)
    return ([geom for geom in rigid if _collides(model, geom)] or rigid) + found


def _touchable(model: mujoco.MjModel, body: int) -> list[int]:
    """The geoms of a body, but for those that are only seen.

    These are beside others that collide, or, if none does, beside others that are slender, or else
    longer than a half of the longest.
    """
    geoms = np.flatnonzero(model.body_weldid[model.geom_bodyid] == body)
    collide = np.array([_collides(model, int(geom)) for geom in geoms], dtype=bool)
    slender = np.isin(model.geom_type[geoms], _SLENDER)
    ends = np.reshape([axis_of(model, int(geom)) for geom in geoms], (-1, 2, 3))
    long = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    for mine in (collide, slender):
        if mine.any():
            return [int(geom) for geom in geoms[mine]]
    return [int(geom) for geom in geoms[2 * long >= long.max(initial=0)]]


def _collides(model: mujoco.MjModel, geom: int) -> bool:
    return bool(model.geom_contype[geom] or model.geom_conaffinity[geom])


def _geoms(model: mujoco.MjModel, text: str) -> list[int]:
    known = [model.geom(i).name for i in range(model.ngeom)]
    found: set[int] = set()
    for pattern in filter(None, (part.strip() for part in text.split(","))):
        fitting = {i for i, name in enumerate(known) if fnmatchcase(name, pattern)}
        found |= fitting or {_named("geoms", pattern, "geom", known)}
    return sorted(found)


def _sensor(
    model: mujoco.MjModel,
    word: str,
    name: str | None,
    kind: mujoco.mjtSensor,
    bodies: set[int],
) -> int | None:
    called, known = f"{word} sensor", [model.sensor(i).name for i in range(model.nsensor)]
    if name is not None:
        sensor = _named(called, name, "sensor", known)
        if model.sensor_type[sensor] != kind:
            what = f"{called} of the model"
            raise InputError(what, repr(name), f"a {called}", f"it is no <{word}>")
        return sensor
    found = [
        int(i)
        for i in np.flatnonzero(model.sensor_type == kind)
        if model.site_bodyid[model.sensor_objid[i]] in bodies
    ]
    if len(found) > 1:
        shown = ", ".join(repr(known[i]) for i in found[:6])
        raise InputError("model", f"with {len(found)} {called}s ({shown})",
                         "with one at the clamp", f"say which with --{word}")  # fmt: skip
    return found[0] if found else None


def _named(part: str, name: str, what: str, known: list[str]) -> int:
    if name in known:
        return known.index(name)
    names = [one for one in known if one]
    if not names:
        part, allowed = f"{part} of the model", f"the name of a {what}"
        raise InputError(part, repr(name), allowed, "the model names none")
    raise unknown(f"{part} of the model", name, names[:12], more=f": the model's {what} names")
