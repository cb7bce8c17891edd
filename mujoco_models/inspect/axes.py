"""The axes of the sweep of a user's model: its vibrissa, and the plane in which that bends."""

import mujoco
import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.errors import InputError
from mujoco_models.inspect.drive import slides
from mujoco_models.inspect.sensors import Held

_SLANT = 0.7  # cosine; a slide that is farther from across goes along the vibrissa
_ACROSS = 0.05  # cosine, and what a cosine lacks of one
_WORLD = 0.999999  # cosine; along an axis of the world
_ALONG = 1e-3  # cosine of an axis that is across, and what it lacks of one that is along


def sweep_axes(held: Held) -> Floats:
    nodes = np.vstack([held.clamp, held.joints, held.tip])
    ways = np.diff(nodes, axis=0)
    along = next(w for w in ways if np.linalg.norm(w) > 1e-9 * np.linalg.norm(nodes[-1] - nodes[0]))
    y = along / np.linalg.norm(along)
    hinges = _hinges(held)
    z = hinges[0] if _alike(held, hinges) else _normal(held, hinges, y)
    z = _aside(z[None], y)[0]
    if np.linalg.norm(z) < _ACROSS:
        raise InputError(
            "hinges of the vibrissa", "along it", "across it, so that it bends",
            "turn the axes of its joints",
        )  # fmt: skip
    z = z / np.linalg.norm(z)
    z = z if z[int(np.argmax(np.abs(z)))] > 0 else -z
    return np.array([np.cross(y, z), y, z])


def _hinges(held: Held) -> Floats:
    """Their axes, in rows."""
    mine = np.isin(held.model.jnt_bodyid, held.parts.chain)
    mine &= held.model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE
    return np.array(held.data.xaxis[mine])


def _alike(held: Held, hinges: Floats) -> bool:
    """Whether all its joints are hinges about one axis."""
    return len(hinges) == len(held.dofs) and bool(
        (np.linalg.norm(np.cross(hinges[0], hinges), axis=1) < 1e-6).all()
    )


def lean_of(held: Held, along: Floats) -> float:
    """From across the vibrissa, of the axes of its hinges, if they are all alike [rad]."""
    hinges = _hinges(held)
    return float(np.arcsin(abs(hinges[0] @ along))) if _alike(held, hinges) else 0.0


def _normal(held: Held, hinges: Floats, y: Floats) -> Floats:
    """Of the plane of the sweep where its hinges leave it open: by a slide, a hinge, a sensor."""
    for joint in slides(held.model, held.parts.foot):
        way = held.data.xaxis[joint]
        if abs(way @ y) < _SLANT:
            return np.asarray(np.cross(way, y))
    usual = _across(y)
    found = hinges[np.abs(hinges @ y) < _ACROSS] if len(hinges) else hinges
    if not len(found) and np.abs(y).max() < _WORLD:
        sites = (held.site(s)[1].T for s in (held.parts.force, held.parts.torque) if s is not None)
        along = ((site, np.abs(site @ y)) for site in sites)
        found = next((site[on < _ACROSS] for site, on in along if on.max() > 1 - _ACROSS), found)
    return np.asarray(found[int(np.argmax(np.abs(found @ usual)))]) if len(found) else usual


def _across(y: Floats) -> Floats:
    """An axis of the world that is across the vibrissa: z, or y if it points there."""
    return np.array([0.0, 0.0, 1.0]) if abs(y[2]) < 0.5 else np.array([0.0, 1.0, 0.0])


def is_planar(held: Held, z: Floats) -> bool:
    """Whether nothing of it can leave the plane of the sweep."""
    joints = np.flatnonzero(np.isin(held.model.jnt_bodyid, held.parts.chain))
    kinds, across = held.model.jnt_type[joints], np.abs(held.data.xaxis[joints] @ z)
    hinges = (kinds == mujoco.mjtJoint.mjJNT_HINGE) & (across > 1 - _ALONG)
    slides_ = (kinds == mujoco.mjtJoint.mjJNT_SLIDE) & (across < _ALONG)
    return bool((hinges | slides_).all())


def _aside(points: Floats, direction: Floats) -> Floats:
    return np.asarray(points - np.outer(points @ direction, direction))
