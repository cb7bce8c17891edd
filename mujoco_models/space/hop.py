"""Where a vibrissa goes that comes over an edge of a mesh: from face to face.

Damped by its material it goes straight towards the state that would be at rest if the face it comes
to had no end; at the next edge the next face says where that is.
"""

from functools import partial

import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.space.forecast import Bow
from mujoco_models.space.model import SpaceModel
from mujoco_models.space.rest import Rest, Settled
from mujoco_models.space.surface import STAYS, Feature, features_around

_FACES = 40  # over which a vibrissa hops at once
_EDGE = 5e-4  # L, to which the end of a face is enclosed


def over_faces(rest: Rest, held: Settled, foot: Floats, far: float) -> Settled | None:
    """Where it comes to rest.

    Parameters
    ----------
    rest : Rest
        Where a model comes to rest.
    held : Settled
        The last stable state.
    foot : array, shape (3,)
        Position of the foot, a little beyond [L].
    far : float
        How far the contact may get [L].

    Returns
    -------
    Settled or None
        None if no face holds it, or the body is none of faces.
    """
    model = rest.model
    if not model.shape.faceted:
        return None
    state, centre, begin = held.state, held.touch.centre, model.contact(held.touch)
    for _ in range(_FACES):
        model.place(foot, state.configuration)
        left = None
        for surface in features_around(model, state.link, centre):
            sought = partial(_use, rest, surface, foot)
            reach = np.inf if surface.flat else far  # a way on is along a face
            found = rest.settle(state, surface, foot, foot, held.touch.centre, reach, sought)
            if found is None or not found.stable:
                continue
            by = found.touch.centre - centre
            if found.stays:
                away = float(np.linalg.norm(model.contact(found.touch) - begin))
                return found if away <= far else None
            share = _room(model, surface, found.state.link, centre, by)
            if share > 0 and left is None:
                left = found.state, centre + share * by
        if left is None:
            return None
        state, centre = left
        if float(np.linalg.norm(centre - held.touch.centre)) > far:
            return None
    return None


def _use(rest: Rest, surface: Feature, foot: Floats, bow: Bow) -> bool:
    """Whether a vibrissa that will rest there lands, or goes on along a face."""
    if surface.flat:
        return bow.stable
    return bow.stable and surface.missed_at(bow.link, rest.centre(bow, foot)) < STAYS


def _room(model: SpaceModel, surface: Feature, link: int, centre: Floats, by: Floats) -> float:
    """How much of a way is along a face."""
    size = float(np.linalg.norm(by))
    first = min(1.0, 2 * model.radius / max(size, 1e-300))

    def stays(share: float) -> bool:
        return surface.missed_at(link, centre + share * by) < STAYS

    if not surface.flat or not stays(first):
        return 0.0
    low, high = first, 1.0
    while (high - low) * size > _EDGE:
        middle = (low + high) / 2
        low, high = (middle, high) if stays(middle) else (low, middle)
    return low
