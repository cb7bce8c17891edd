"""Which contact a foot position has: Newton's method on the body's surface, from a near contact."""

from collections.abc import Iterator
from itertools import islice

import numpy as np

from analytic.problem.arrays import Floats
from analytic.space.problem.bodies.body import across
from analytic.space.solver.contact import Contact, Scene, contact_at

_EPS = float(np.finfo(float).eps)
_EXACT = 64 * _EPS  # of a foot position, in units of the extent: some roundings
_STEPS = 20
_HALVINGS = 6
_WIDE = 0.1  # L on the parallel surface and rad of the tip, the longest step
_FLATTEST = 1e-12  # rad, alpha, where the plane of bending is lost, and w, where there is no force
_SAME = 1e-7  # L on the parallel surface, between a face that has no end and the mesh
_SWITCHES = 4  # of the phase
_PHASE_SLACK = 1e-12  # rad and L: at the limit both phases are the same state


def settle(scene: Scene, start: Contact, foot: Floats, reach: float = np.inf) -> Contact | None:
    """The contact that a foot position has, from one near by."""
    for _ in range(_SWITCHES):
        found = _newton(scene, start, foot, reach)
        if found is None:
            return None
        limit = np.pi / 2 - found.plane.alpha
        if found.tangent and found.arc_length > 1 + _PHASE_SLACK:
            start = contact_at(scene, found.on_parallel, limit, tangent=False)
        elif not found.tangent and found.rotation > limit + _PHASE_SLACK:
            start = contact_at(scene, found.on_parallel, 1.0, tangent=True)
        else:
            return found
    return None


def settle_whole(scene: Scene, alone: Contact, foot: Floats) -> Contact | None:
    """The contact with the whole of a mesh where one rests that knows a part of it alone."""
    start = contact_at(scene, alone.on_parallel, alone.free, alone.tangent)
    found = settle(scene, start, foot)
    if found is None or np.linalg.norm(found.on_parallel - alone.on_parallel) > _SAME:
        return None
    return found


def _newton(scene: Scene, start: Contact, foot: Floats, reach: float) -> Contact | None:
    """The contact of given phase; steps are halved while they do not come nearer."""
    if not _bent_outside(start):
        return None
    extent = max(1.0, float(np.abs(foot).max()), float(np.abs(start.centre).max()))
    best, missed = start, _miss(start, foot)
    for _ in range(_STEPS):
        if missed <= 4 * _EPS * extent:
            break
        nearer = None
        tries = 1 if missed <= _EXACT * extent else _HALVINGS
        for trial in islice(_trials(scene, best, foot), tries):
            miss = _miss(trial, foot)
            if miss < missed:
                nearer = trial
                break
        if nearer is None:
            break
        if np.linalg.norm(nearer.spot.point - start.spot.point) > reach:
            return None
        best, missed = nearer, miss
    return best if missed <= _EXACT * extent else None


def _bent_outside(contact: Contact) -> bool:
    """Whether it bends the vibrissa, at a place outside the body: inside there is no normal."""
    bent = min(contact.plane.alpha, contact.rotation) > _FLATTEST
    return bent and bool(contact.spot.normal.any())


def _miss(contact: Contact, foot: Floats) -> float:
    return float(np.abs(contact.foot - foot).max())


def _trials(scene: Scene, at: Contact, foot: Floats) -> Iterator[Contact]:
    """Newton's step, then its halves."""
    sides = across(at.spot.normal)
    rates = at.foot_rates(scene.radius)
    matrix = np.column_stack([rates[:, :3] @ sides.T, rates[:, 3]])
    try:
        step = np.linalg.solve(matrix, foot - at.foot)
    except np.linalg.LinAlgError:
        return
    if not np.isfinite(step).all():
        return
    step *= min(1.0, _WIDE / float(np.abs(step).max()))
    for _ in range(_HALVINGS):
        new = max(at.free + step[2], at.free / 10)
        place = at.on_parallel + step[:2] @ sides
        trial = contact_at(scene, place, new, at.tangent)
        if _bent_outside(trial):
            yield trial
        step = step / 2
