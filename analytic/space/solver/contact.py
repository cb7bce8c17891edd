"""A vibrissa at rest against one point of a body: what it feels, and whether it fits its foot."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Floats
from analytic.space.problem.bodies.body import Body, Spot
from analytic.space.solver.rod import Loaded, Plane, loaded_part

APART = 0.25
"""Distance of the parallel surface on which contacts move [L]. It has no edges and no corners, and
any positive distance gives the same states; this one turns as slowly as the vibrissa can follow."""


class Scene(NamedTuple):
    """What does not change along a sweep; lengths in L."""

    body: Body
    tangent: Floats
    """Of the clamp."""
    radius: float
    """Of the vibrissa."""


class Contact(NamedTuple):
    """A vibrissa against a spot of the body, wherever its foot is; lengths in L."""

    spot: Spot
    plane: Plane
    loaded: Loaded
    rotation: float
    """Rotation w of the end of the loaded part [rad]."""
    arc_length: float
    """Of the loaded part."""
    tangent: bool
    """Phase B."""
    centre: Floats
    """Of the vibrissa's axis at the contact, shape (3,)."""

    @property
    def on_parallel(self) -> Floats:
        """The spot's place on the parallel surface, shape (3,)."""
        return self.spot.point + APART * self.spot.normal

    @property
    def free(self) -> float:
        """What its phase leaves free: the rotation w of the tip, or the arc length."""
        return self.arc_length if self.tangent else self.rotation

    @property
    def force(self) -> float:
        """Magnitude f of the contact's force [EI/L^2]."""
        return (self.loaded.root_f / self.arc_length) ** 2

    @property
    def energy(self) -> float:
        """Of bending: the integral of kappa^2/2 = f (sin theta - sin theta_1) [EI/L]."""
        return self.loaded.root_f / self.arc_length * self.loaded.bending

    @property
    def foot(self) -> Floats:
        """Where the foot must be, shape (3,)."""
        up, reach = self.arc_length * self.loaded.place
        return np.asarray(self.centre - up * self.plane.tangent - reach * self.plane.lateral)

    def foot_rates(self, radius: float) -> Floats:
        """How the foot moves with the place on the parallel surface and `free`, shape (3, 4)."""
        plane, loaded, s = self.plane, self.loaded, self.arc_length
        turning = self.spot.turning
        by_alpha, by_rotation = loaded.by_alpha, loaded.by_rotation
        if self.tangent:
            by_alpha, free = by_alpha - by_rotation, loaded.place
        else:
            free = by_rotation
        both = np.stack([plane.tangent, plane.lateral])
        moved = np.eye(3) - (APART - radius) * turning
        tilt = plane.along @ turning
        swing = np.outer(plane.across, plane.across @ turning) / np.sin(plane.alpha)
        rates = moved - s * np.outer(by_alpha @ both, tilt) - s * loaded.place[1] * swing
        end = free @ both if self.tangent else s * (free @ both)
        return np.column_stack([rates, -end])


def contact_at(scene: Scene, x: Floats, free: float, tangent: bool) -> Contact:
    """The contact at the nearest point of the body to a place outside; `free` as `Contact.free`."""
    spot = scene.body.nearest(x, APART)
    plane = Plane.of(scene.tangent, spot.normal)
    rotation, arc_length = (np.pi / 2 - plane.alpha, free) if tangent else (free, 1.0)
    loaded, centre = loaded_part(rotation, plane.alpha), spot.point + scene.radius * spot.normal
    return Contact(spot, plane, loaded, rotation, arc_length, tangent, centre)
