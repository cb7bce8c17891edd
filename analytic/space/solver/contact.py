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

from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.numerics.vectors import cross
from analytic.solver.elastica import frame, span, span_by_alpha, span_by_excess
from analytic.solver.equilibria import tip_rates
from analytic.space.problem.bodies.body import Body, Spot, across

APART = 0.25
"""Distance of the parallel surface on which contacts move [L]. It has no edges and no corners, and
any positive distance gives the same states; this one turns as slowly as the vibrissa can follow."""

_EPS = float(np.finfo(float).eps)
_EXACT = 64 * _EPS  # of a foot position, in units of the extent: some roundings
_STEPS = 20
_HALVINGS = 6
_WIDE = 0.1  # L on the parallel surface and rad of the tip, the longest step
_FLATTEST = 1e-12  # rad, alpha, where the plane of bending is lost, and w, where there is no force
_SAME = 1e-7  # L on the parallel surface, between a face that has no end and the mesh
_SWITCHES = 4  # of the phase
_PHASE_SLACK = 1e-12  # rad and L: at the limit both phases are the same state


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
