"""Where a vibrissa goes that comes over an edge or a corner of a mesh.

A side that comes over a corner goes on along another edge that meets there: its energy goes down
from the corner to a stable state on that edge. A tip goes from face to face: damped by its material
it goes straight towards the state that would be at rest if the face it comes to had no end; at the
next edge the next face says where that is.
"""

from functools import partial

import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.space.balance import State
from mujoco_models.space.forecast import Bow
from mujoco_models.space.rest import Rest, Settled
from mujoco_models.space.surface import (
    BESIDE,
    STAYS,
    Feature,
    edges_of,
    features_around,
    features_at,
)

_FACES = 40  # over which a vibrissa hops at once
_EDGE = 1e-4  # L, to which the end of a face is enclosed


def over_faces(rest: Rest, held: Settled, foot: Floats, far: float) -> Settled | None:
    """Where it comes to rest."""
    model = rest.model
    if not model.shape.faceted:
        return None
    state, centre = held.state, held.touch.centre
    for _ in range(_FACES):
        here = features_at(model, state.link, centre)
        if state.sliding:
            holding = _holding(rest, here, state, centre, foot, far)
            if len(holding) > 1:
                return None  # the way down says to which of them
            if holding:
                return _within(rest, far, held, holding[0])
        # Only where nothing that meets here leads on, what is next to it: a face beyond a corner
        # may hold a vibrissa that goes another way.
        found = _on(rest, here, state, centre, foot, far)
        if found is None:
            around = features_around(model, state.link, centre, here)
            found = _on(rest, around, state, centre, foot, far)
        if found is None:
            return None
        if isinstance(found, Settled):
            return _within(rest, far, held, found)
        state, centre = found
        if float(np.linalg.norm(centre - held.touch.centre)) > far:
            return None
    return None


def _within(rest: Rest, far: float, held: Settled, found: Settled) -> Settled | None:
    """What is found, if the contact is not too far away."""
    away = float(np.linalg.norm(rest.model.contact(found.touch) - rest.model.contact(held.touch)))
    return found if away <= far else None


def _holding(
    rest: Rest, here: list[Feature], state: State, centre: Floats, foot: Floats, far: float
) -> list[Settled]:
    """Where a side comes to rest on the edges in which the faces meet."""
    faces = [one for one in here if one.flat]
    every = [
        rest.settle(state, edge, foot, foot, centre, far, partial(_use, rest, edge, foot))
        for edge in edges_of(rest.model, faces, centre)
    ]
    return [one for one in every if one is not None and one.stays and one.stable]


def _on(
    rest: Rest,
    surfaces: list[Feature],
    state: State,
    centre: Floats,
    foot: Floats,
    far: float,
) -> Settled | tuple[State, Floats] | None:
    """Where it comes to rest on one of some surfaces, or where a face of them has ended."""
    model, left = rest.model, None
    start = model.contact(model.probe(state.link, centre))
    for surface in surfaces:
        sought = partial(_use, rest, surface, foot)
        reach = np.inf if surface.flat else far  # a way on is along a face
        found = rest.settle(state, surface, foot, foot, centre, reach, sought)
        if found is None or not found.stable:
            continue
        if found.stays:
            return found
        by = model.contact(found.touch) - start
        share = _room(surface, found.state.link, start, by)
        if share > 0 and left is None:
            left = found.state, start + share * by + model.radius * surface.normal
    return left


def _use(rest: Rest, surface: Feature, foot: Floats, bow: Bow) -> bool:
    """Whether a vibrissa that will rest there lands, or goes on along a face."""
    if surface.flat:
        return bow.stable
    return bow.stable and surface.missed_at(bow.link, rest.centre(bow, foot)) < STAYS


def _room(surface: Feature, link: int, start: Floats, by: Floats) -> float:
    """How much of a way of the contact is along a face."""
    size = float(np.linalg.norm(by))
    first = min(1.0, 2 * BESIDE / max(size, 1e-300))

    def stays(share: float) -> bool:
        return surface.missed_at(link, start + share * by + BESIDE * surface.normal) < STAYS

    if not surface.flat or not stays(first):
        return 0.0
    low, high = first, 1.0
    while (high - low) * size > _EDGE:
        middle = (low + high) / 2
        low, high = (middle, high) if stays(middle) else (low, middle)
    return low
