"""A vibrissa at rest against one point of a body: what it feels, and whether it fits its foot.

A straight isotropic vibrissa under one frictionless contact has no torque along it and stays
untwisted; moments about the contact point vanish, so it bends in the plane that holds its clamp
tangent t and the force, which is along the normal n of the body. In that plane it is the planar
elastica (Will, Steigenberger and Behn, 2014, eqs. 6-22), whose slope angle of the contour is

    n = sin(alpha) d - cos(alpha) t,   d normal to t,   0 < alpha < pi/2.

With the integrals q, C, S of `analytic.solver.elastica` its loaded part, of length s, ends at

    c - x0 = s (height t + reach d),   force f = (q/s)^2 along n.

Phase A: s = L, and the rotation w of the tip is free. Phase B: w = pi/2 - alpha, and s is free.
Lengths here are in L, forces in EI/L^2.
"""

from typing import NamedTuple

import numpy as np

from analytic.numerics.vectors import cross
from analytic.problem.arrays import Floats
from analytic.solver.elastica import frame, span, span_by_alpha, span_by_excess
from analytic.solver.equilibria import tip_rates
from analytic.space.problem.bodies.body import Body, Spot

APART = 0.25
"""Distance of the parallel surface on which contacts move [L]. It has no edges and no corners, and
any positive distance gives the same states; this one turns as slowly as the vibrissa can follow."""


class Plane(NamedTuple):
    """The plane in which the vibrissa bends; vectors of shape (3,)."""

    tangent: Floats  # of the clamp, t
    normal: Floats  # of the body at the contact, n
    lateral: Floats  # the part of the normal across the clamp's tangent, of length 1: d
    alpha: float  # slope angle of the body's surface against the plane across t [rad]

    @classmethod
    def of(cls, tangent: Floats, normal: Floats) -> "Plane":
        down = -float(normal @ tangent)
        sideways = normal + down * tangent
        sine = float(np.linalg.norm(sideways))
        return cls(tangent, normal, sideways / max(sine, 1e-300), float(np.arctan2(sine, down)))

    @property
    def along(self) -> Floats:
        """Unit vector along the surface in the plane, the way the vibrissa points."""
        return np.asarray(np.cos(self.alpha) * self.lateral + np.sin(self.alpha) * self.tangent)

    @property
    def across(self) -> Floats:
        """Unit vector normal to the plane."""
        return cross(self.lateral, self.tangent)


class Loaded(NamedTuple):
    """The loaded part of a vibrissa of unit length, and its rates."""

    root_f: float  # q: the root of the force on a loaded part of length 1
    moment: float  # C: moment at the clamp over the root of the force
    place: Floats  # height along t and reach along d of its end, shape (2,)
    by_alpha: Floats  # rate of that with alpha at fixed w, shape (2,)
    by_rotation: Floats  # rate of that with w, shape (2,)
    bending: float  # energy of bending over the root of the force: S - q sin(theta_1)
    root_f_rates: Floats  # rates of q with w and with alpha, shape (2,)


def loaded_part(rotation: float, alpha: float) -> Loaded:
    w, a = np.array(rotation), np.array(alpha)
    with np.errstate(all="ignore"):  # beyond an upright or level surface: not finite, and no state
        integrals = span(w, a)
        end = frame(integrals, a)
        height, reach = tip_rates(w, integrals, a, end)
        by_rotation = span_by_excess(integrals, w, a)
        by_alpha = span_by_alpha(integrals, by_rotation, a)
        place = np.array(end) / integrals.q
    q = float(integrals.q)
    return Loaded(
        q,
        float(integrals.C),
        place,
        np.array([float(height.by_alpha), float(reach.by_alpha)]),
        np.array([float(height.by_excess), float(reach.by_excess)]),
        float(integrals.S) - q * float(np.cos(w + a)),
        np.array([float(by_rotation.q), float(by_alpha.q)]),
    )


class Scene(NamedTuple):
    """What does not change along a sweep; lengths in L."""

    body: Body
    tangent: Floats  # of the clamp
    radius: float  # of the vibrissa


class Contact(NamedTuple):
    """A vibrissa against a spot of the body, wherever its foot is; lengths in L."""

    spot: Spot
    plane: Plane
    loaded: Loaded
    rotation: float  # rotation w of the end of the loaded part [rad]
    arc_length: float  # of the loaded part
    tangent: bool  # Phase B
    centre: Floats  # of the vibrissa's axis at the contact, shape (3,)

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
