"""What a bead touches while Newton's method runs: the body, or one face, edge or corner of a mesh.

On a mesh a face, an edge or a corner, each as if it had no end, is smooth, so that Newton's method
converges, and a step along the way of the foot that ends on another one is seen. The mesh says
which one it is; whether a bead is where the body is, MuJoCo's own contact says.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.space.problem.bodies.body import Feature
from mujoco_models.space.model import SpaceModel, Touch

_STAYS = 1e-8
"""How far a feature and MuJoCo's contact may be apart where they are one [L]: MuJoCo holds vertices
in single precision, so that triangles of one face are not quite in one plane."""


class Surface(NamedTuple):
    """What may be touched."""

    model: SpaceModel
    feature: Feature | None  # of a mesh; None for a smooth body as it is

    def touch(self, link: int, s: float) -> Touch:
        """The nearest point to a bead on a link."""
        if self.feature is None:
            return self.model.touch(link, s)
        return self.touched(self.model.centre(link, s))

    def touched(self, centre: Floats) -> Touch:
        """The nearest point of the feature to a bead wherever it is."""
        assert self.feature is not None
        spot = self.feature.nearest(centre, 1.0)
        return Touch(centre, spot.normal, spot.distance - self.model.radius)

    def turning(self, link: int, touch: Touch) -> Floats:
        """How the normal turns as the bead's centre moves, shape (3, 3), symmetric [1/L]."""
        if self.feature is None:
            return self.model.turning(link, touch)
        return self.feature.nearest(touch.centre, touch.distance + self.model.radius).turning

    def holds(self, link: int, centre: Floats) -> bool:
        """Whether that is where the mesh is, of a bead wherever it is."""
        return self.missed(link, centre) < _STAYS

    def missed(self, link: int, centre: Floats) -> float:
        """How far MuJoCo's contact is from being as if this were all of the mesh [L]."""
        ours, found = self.touched(centre), self.model.probe(link, centre)
        apart = found.distance + self.model.radius
        return max(
            abs(ours.distance - found.distance),
            apart * float(np.abs(ours.normal - found.normal).max()),
        )


def surface_at(model: SpaceModel, touch: Touch) -> Surface:
    """What a bead touches."""
    if model.mesh is None:
        return Surface(model, None)
    feature = Feature.of(model.mesh.nearest(touch.centre, touch.distance + model.radius))
    if feature.flat:  # as MuJoCo has it here
        feature = replace(feature, point=model.contact(touch), normal=touch.normal)
    return Surface(model, feature)
