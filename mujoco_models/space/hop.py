"""Where a vibrissa goes that comes over an edge or a corner of a mesh.

A side that comes over a corner goes on along another edge that meets there: its energy goes down
from the corner to a stable state on that edge. A tip goes from face to face: damped by its material
it goes straight towards the state that would be at rest if the face it comes to had no end; at the
next edge the next face says where that is.
"""

from collections.abc import Iterable
from itertools import chain

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.space.problem.bodies.body import Feature
from analytic.space.problem.bodies.polyhedron import Polyhedron
from mujoco_models.space.balance import State
from mujoco_models.space.model import SpaceModel
from mujoco_models.space.rest import Rest, Settled
from mujoco_models.space.surface import Surface

_FACES = 40  # over which a vibrissa hops at once
_BESIDE = 2e-4  # L, from an edge or a corner: twice what a walk leaves before it goes over that
_SINGLE = 1e-7  # L: MuJoCo's vertices are in single precision


def over_faces(rest: Rest, held: Settled, foot: Floats, far: float) -> Settled | None:
    """Where it comes to rest."""
    model, mesh = rest.model, rest.model.mesh
    if mesh is None:
        return None
    state, start = held.state, model.contact(held.touch)
    place = start
    for _ in range(_FACES):
        place = mesh.snapped(place, _BESIDE)
        faces, edges = mesh.features(place, _SINGLE)
        if state.sliding:
            every = (_at_rest(rest, state, edge, place, foot, far) for edge in edges)
            holding = [one for one in every if one is not None and one.stays]
            places = {tuple(np.rint(one.touch.centre / _BESIDE)) for one in holding}
            if len(places) > 1 or (not holding and state is not held.state):
                return None  # the way down says to which of them, or where to
            if holding:
                return _within(model, far, start, holding[0])
        # Only where nothing that meets here leads on, what is next to it: a face beyond a corner
        # may hold a vibrissa that goes another way.
        found = _on(rest, mesh, chain(faces, edges), state, place, foot, far)
        if found is None:
            around = features_around(model, place)
            found = _on(rest, mesh, around, state, place, foot, far)
        if found is None:
            return None
        if isinstance(found, Settled):
            return _within(model, far, start, found)
        state, place = found
        if float(np.linalg.norm(place - start)) > far:
            return None
    return None


def features_around(model: SpaceModel, place: Floats) -> list[Feature]:
    """The faces and the edges of a mesh next to a place, faces first."""
    mesh = model.mesh
    assert mesh is not None
    near = np.linalg.norm(mesh.vertices - place, axis=1) < model.radius
    places = mesh.vertices[near] if near.any() else [mesh.snapped(place, model.radius)]
    every = [mesh.features(corner, _SINGLE) for corner in places]
    return [one for kind in zip(*every, strict=True) for some in kind for one in some]


def _within(model: SpaceModel, far: float, start: Floats, found: Settled) -> Settled | None:
    """What is found, if the contact is not too far away."""
    return found if float(np.linalg.norm(model.contact(found.touch) - start)) <= far else None


def _on(
    rest: Rest,
    mesh: Polyhedron,
    features: Iterable[Feature],
    state: State,
    place: Floats,
    foot: Floats,
    far: float,
) -> Settled | tuple[State, Floats] | None:
    """Where it comes to rest on one of some features, or where a face of them has ended."""
    left, beyond = None, list[State]()
    for feature in features:
        reach = np.inf if feature.flat else far  # a way on is along a face
        # Faces that lead to each other: the edge between them holds, with a normal between theirs.
        starts = [state] if feature.flat or left is not None else [state, *beyond]
        tried = (_at_rest(rest, one, feature, place, foot, reach) for one in starts)
        found = next((one for one in tried if one is not None), None)
        if found is None:
            continue
        if found.stays:
            return found
        by = rest.model.contact(found.touch) - place
        share = mesh.room(place, by) if feature.flat else 0.0
        if share * float(np.linalg.norm(by)) > _BESIDE and left is None:
            left = found.state, place + share * by
        if feature.flat:
            beyond.append(found.state)
    return left


def _at_rest(
    rest: Rest, state: State, feature: Feature, place: Floats, foot: Floats, far: float
) -> Settled | None:
    """The stable equilibrium on a face as if it had no end, or on an edge or a corner."""
    surface = Surface(rest.model, feature)
    near = place + rest.model.radius * feature.normal
    found = rest.settle(state, surface, foot, foot, near, far)
    if found is None or not found.stable:
        return None
    return found if feature.flat or found.stays else None
