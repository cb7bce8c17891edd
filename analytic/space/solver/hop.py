"""Where a vibrissa goes that hops over an edge: the stable state near by, if there is just one.

A tip that slides on a face and comes to an edge is not stable on the edge, whose curvature across
the plane of bending drops it: it hops to the next face. That is a slip-off with a landing close by,
and inertia has no say in it.
"""

import numpy as np

from analytic.problem.arrays import Floats
from analytic.space.problem.bodies.body import across
from analytic.space.solver.contact import Contact, Scene, contact_at
from analytic.space.solver.newton import settle
from analytic.space.solver.stability import is_stable

_DISTANCES = (0.005, 0.02, 0.06)  # L on the parallel surface, from where it is looked for
_WAYS = 8
_FARTHEST = 0.12  # L on the parallel surface: what lands farther away depends on its motion
_SAME = 1e-7  # L, of two landings that are one
_SLACK = 1e-9  # of the energy: rounding


def landing(scene: Scene, start: Contact, foot: Floats) -> Contact | None:
    """The stable state of less energy that is close to a state that ceases to be stable.

    Parameters
    ----------
    scene : Scene
        Body, clamp tangent, radius.
    start : Contact
        The last stable state.
    foot : array, shape (3,)
        A foot position just beyond [L].

    Returns
    -------
    Contact or None
        The nearest; None if there is none, or another one in another direction is as low.
    """
    found: list[tuple[float, float, Contact]] = []
    limit = start.energy * (1 + _SLACK)
    free = start.arc_length if start.tangent else start.excess
    for distance in _DISTANCES:
        for angle in np.arange(_WAYS) * 2 * np.pi / _WAYS:
            aside = np.array([np.cos(angle), np.sin(angle)]) @ across(start.spot.normal)
            place = start.on_parallel + distance * aside
            trial = settle(scene, contact_at(scene, place, free, start.tangent), foot)
            if trial is None or trial.energy > limit or not is_stable(trial, scene.radius):
                continue
            leap = float(np.linalg.norm(trial.on_parallel - start.on_parallel))
            if leap < _FARTHEST:
                found.append((leap, trial.energy, trial))
    if not found:
        return None
    _, low, nearest = min(found, key=lambda one: one[0])
    for _, energy, other in found:
        apart = float(np.linalg.norm(other.on_parallel - nearest.on_parallel))
        if apart > _SAME and abs(energy - low) <= _SLACK * low:
            return None
    return nearest
