"""What else touches, or is touched, as a user's foot goes on its way past an object."""

from copy import copy

import mujoco
import numpy as np

from analytic.numerics.arrays import Booleans, Floats
from mujoco_models.inspect.drive import holders
from mujoco_models.inspect.parts import Parts
from mujoco_models.inspect.touching import kept_apart, thickness

WAY = 2.25
"""L; of the foot: past the circle of `case_of` 2.15, and while it gains speed."""
_BEGINS = 0.02  # L; what is nearer to the foot's own line, a floor perhaps, is left alone
HEIGHT, _DEEP = 0.4, 1.5  # L; how high an object is, and half of how deep: the circle of `case_of`


def on_its_way(
    model: mujoco.MjModel, parts: Parts, data: mujoco.MjData, nodes: Floats, axes: Floats
) -> tuple[int, ...]:
    """Geoms that it meets and that do not move with the foot, where it passes unbent."""
    (low, high), length = _extent(nodes, axes), _length(nodes)
    thick = thickness(model, parts)
    box = low + np.array([-WAY * length, _BEGINS * length, -thick]), high + np.array([0, 0, thick])
    excluded = np.isin(model.geom_bodyid, kept_apart(model, parts.chain[-1]))
    meets = _filtered(model, parts) & ~_with_foot(model, parts) & ~excluded
    return _within(model, data, box, axes, meets)


def ahead(
    model: mujoco.MjModel, parts: Parts, data: mujoco.MjData, nodes: Floats, axes: Floats
) -> tuple[int, ...]:
    """Geoms beside it that an object meets, too: on its foot, or on what its sensors feel."""
    (low, high), length = _extent(nodes, axes), _length(nodes)
    box = (
        low + length * np.array([-WAY, HEIGHT, -_DEEP]),
        high + length * np.array([WAY, 0, _DEEP]),
    )
    owner = model.geom_bodyid
    felt = _below(model, parts.foot if parts.force is None else _body_of(model, parts.force))
    felt &= model.body_weldid != model.body_weldid[parts.foot]
    if model.body_mocapid[parts.foot] < 0:  # nothing pushes a mocap body
        felt |= model.body_weldid == model.body_weldid[parts.foot]
    felt[[0, *parts.chain]] = False
    own = np.isin(np.arange(model.ngeom), parts.geoms)
    kinds = (model.geom_contype | model.geom_conaffinity) & 1 > 0
    return _within(model, data, box, axes, felt[owner] & kinds & ~own)


def _length(nodes: Floats) -> float:
    return float(np.linalg.norm(np.diff(nodes, axis=0), axis=1).sum())


def _extent(nodes: Floats, axes: Floats) -> tuple[Floats, Floats]:
    places = nodes @ axes.T
    start = places[0, 1]  # what is behind the clamp does not count
    low, high = places.min(axis=0), places.max(axis=0)
    return np.array([low[0], start, low[2]]), high


def _within(
    model: mujoco.MjModel,
    data: mujoco.MjData,
    box: tuple[Floats, Floats],
    axes: Floats,
    which: Booleans,
) -> tuple[int, ...]:
    """Which geoms overlap a box, for which some other geom stands in."""
    others = np.flatnonzero(~which)
    if not others.size or not which.any():
        return ()
    model, data, stand_in = copy(model), copy(data), int(others[0])
    (low, high), kind = box, int(mujoco.mjtGeom.mjGEOM_BOX)
    model.geom_type[stand_in], model.geom_size[stand_in] = kind, (high - low) / 2
    model.geom_rbound[stand_in] = np.linalg.norm(high - low) / 2
    data.geom_xpos[stand_in] = (low + high) / 2 @ axes
    data.geom_xmat[stand_in] = axes.T.ravel()
    return tuple(
        one for one in np.flatnonzero(which).tolist()
        if mujoco.mj_geomDistance(model, data, one, stand_in, 1.0, None) < 0
    )  # fmt: skip


def _with_foot(model: mujoco.MjModel, parts: Parts) -> Booleans:
    roots = [model.body_rootid[body] for body in holders(model, parts.foot)]
    return np.isin(model.body_rootid[model.geom_bodyid], roots)


def _filtered(model: mujoco.MjModel, parts: Parts) -> Booleans:
    """Whether contype and conaffinity let geoms meet the vibrissa."""
    mine = [*parts.geoms]
    kind = np.bitwise_or.reduce(model.geom_contype[mine], initial=0)
    meets = np.bitwise_or.reduce(model.geom_conaffinity[mine], initial=0)
    if parts.rod is not None:
        kind |= model.flex_contype[parts.rod.flex]
        meets |= model.flex_conaffinity[parts.rod.flex]
    return np.asarray(((model.geom_contype & meets) | (model.geom_conaffinity & kind)) > 0)


def _below(model: mujoco.MjModel, body: int) -> Booleans:
    """Bodies that one carries, and itself."""
    found: Booleans = np.arange(model.nbody) == body
    for one in range(body + 1, model.nbody):
        found[one] |= found[model.body_parentid[one]]
    return found


def _body_of(model: mujoco.MjModel, sensor: int) -> int:
    return int(model.site_bodyid[model.sensor_objid[sensor]])
