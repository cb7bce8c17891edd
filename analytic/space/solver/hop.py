"""Where a vibrissa goes that hops over an edge: down its energy, to the first stable state near by.

A tip that slides on a face and comes to an edge is not stable on the edge, whose curvature across
the plane of bending drops it. What it does then takes no time against the way of the foot. A
vibrissa whose material damps its motion (Kelvin and Voigt's law: as much as it is stiff) goes
straight towards the state that would be at rest if the face it comes to had no end. If the face
goes on that far, it has landed; if not, it comes to the next edge, and the faces there say where
to. An edge from which no face leads away holds it, or leads it along. Where that finds nothing, as
of a side that slides over a corner, the whole vibrissa goes down (`descent`).
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.space.problem.bodies.body import Feature
from analytic.space.problem.bodies.polyhedron import Polyhedron
from analytic.space.solver.contact import APART, Contact, Scene, contact_at, settle, settle_whole
from analytic.space.solver.descent import Touching, descend
from analytic.space.solver.stability import is_stable

_FARTHEST = 0.12  # L, of the contact: what lands farther away depends on its motion
_REACH = 0.36  # L; so far a landing is looked for
_STEPS = 100
_ABOVE = 1e-9  # L; a point that far outside has its nearest point on the surface
_SLACK = 1e-9  # of the energy: rounding
_NEAR = 0.02  # L, between a chain's contact and the one of the closed form
_ASTRAY = 0.05  # L; what Newton's method goes so far to find is another contact (observed: 4e-3)
_AHEAD = (0.0, 1e-3, 4e-3)  # L of the way: a chain may hold a little longer
_SLOW, _ASKED = 2e-3, 8  # rad, of a step less than the last, to ask the closed form; how often
_HELD = 1e-3  # L; a chain that goes no farther in all that holds, others only begin to fall
_TIP = 1e-6  # L
_LEAST = 1e-3  # rad, rotation of a tip that is searched for


class _Step(NamedTuple):
    """Along a face or an edge."""

    by: Floats  # shape (3,) [L]
    whole: bool  # whether the face goes on as far as the state at rest
    target: Contact  # that state


class DependsOnMotion(Exception):  # noqa: N818  # not an error: an answer
    """There is a state to land in, but so far away that the motion says whether it does."""


def landing(scene: Scene, start: Contact, begin: Floats, foot: Floats) -> Contact | None:
    """The stable state where a vibrissa lands that lost its hold; `DependsOnMotion` if far away."""
    # No more than it had, and what the foot has done since: its step is short, but so may a
    # vibrissa be bent that little.
    limit = start.energy * (1 + _SLACK) + start.force * _apart(foot, begin)
    found = None
    if isinstance(scene.body, Polyhedron):
        found = _over_faces(scene, scene.body, start, foot, limit)
    if found is None or _is_far(found, start):
        found = _down(scene, start, begin, foot, limit) or found
    if found is not None and _is_far(found, start):
        raise DependsOnMotion
    return found


def _is_far(found: Contact, start: Contact) -> bool:
    return _apart(found.spot.point, start.spot.point) > _FARTHEST


def _over_faces(
    scene: Scene, body: Polyhedron, start: Contact, foot: Floats, limit: float
) -> Contact | None:
    """Of a mesh, in closed form; None if only the way down says where."""
    point, normal, last = start.spot.point, start.spot.normal, start
    if start.tangent and start.arc_length > 1 - _TIP:  # drawn off an edge, it goes on as a tip
        last = start._replace(rotation=_LEAST, tangent=False)
    for _ in range(_STEPS):
        spot = body.nearest(point + _ABOVE * normal, APART)
        if _apart(spot.point, start.spot.point) > _REACH:
            return None
        faces, edges = body.features(spot.point)
        if last.tangent:
            ways = _steps(scene, body, edges, last, spot.point, foot, limit)
            on = [_landed(scene, step.target, foot) for step in ways if step.whole]
            holding = [one for one in on if one is not None]
            if holding:
                return holding[0] if len(holding) == 1 else None
        for step in _steps(scene, body, faces + edges, last, spot.point, foot, limit):
            found = _landed(scene, step.target, foot) if step.whole else None
            if found is not None:
                return found
            if not step.whole:
                point, normal, last = spot.point + step.by, step.target.spot.normal, step.target
                break
        else:
            return None
    return None


def _down(
    scene: Scene, start: Contact, begin: Floats, foot: Floats, limit: float
) -> Contact | None:
    """Of a whole vibrissa, sides and all; the closed form where it comes to rest."""
    onward = (foot - begin) / _apart(foot, begin)
    for ahead in _AHEAD:
        since, asked, before = start.spot.point, 0, np.inf
        for touching in descend(scene, start, foot + ahead * onward):
            if _apart(touching.place, start.spot.point) > _FARTHEST:
                return None
            slows, before = touching.turned < min(_SLOW, before), touching.turned
            if not slows:
                continue
            if _apart(touching.place, since) > _HELD:
                since, asked = touching.place, 0
            found, asked = _next_to(scene, touching, foot), asked + 1
            if found is not None and found.energy <= limit:
                return found
            if asked == _ASKED:
                break
        if asked < _ASKED:
            return None
    return None


def _next_to(scene: Scene, touching: Touching, foot: Floats) -> Contact | None:
    """The stable state of the closed form next to a chain at rest."""
    side = contact_at(scene, touching.on_parallel, touching.arc_length, tangent=True)
    rotation = max(side.rotation - touching.bent, _LEAST)
    tip = contact_at(scene, touching.on_parallel, rotation, tangent=False)
    for trial in (tip, side):
        found = settle(scene, trial, foot, _ASTRAY)
        if found is None or _apart(found.spot.point, touching.place) > _NEAR:
            continue
        if is_stable(found, scene.radius):
            return found
    return None


def _steps(
    scene: Scene,
    body: Polyhedron,
    features: list[Feature],
    last: Contact,
    point: Floats,
    foot: Floats,
    energy: float,
) -> Iterator[_Step]:
    """Ways on from a point of the surface, on faces and along edges that meet there."""
    for feature in features:
        alone = scene._replace(body=feature)
        above = feature.nearest(point + APART * last.spot.normal, APART).normal
        start = contact_at(alone, point + APART * above, last.free, last.tangent)
        target = settle(alone, start, foot)
        if target is None or target.energy > energy:
            continue
        by = target.spot.point - point
        room = body.room(point, by)
        if room * float(np.linalg.norm(by)) > _ABOVE:
            yield _Step(room * by, room == 1.0, target)


def _landed(scene: Scene, target: Contact, foot: Floats) -> Contact | None:
    """That state on the mesh as it is, if it is there and stable."""
    found = settle_whole(scene, target, foot)
    return found if found is not None and is_stable(found, scene.radius) else None


def _apart(one: Floats, other: Floats) -> float:
    return float(np.linalg.norm(one - other))
