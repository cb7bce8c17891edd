"""Where a vibrissa will rest on a face, an edge or a corner, before MuJoCo is asked.

Joints that bend alike in all directions store energy by the angle between two links, and one
frictionless contact does not twist them. So a chain at rest lies in the plane of its clamp's
tangent t0 and the force F on it: the angles of its links in that plane, in which springs couple
neighbours only, and the force say everything. Across the plane nothing pulls; turning F about t0
turns the chain with it. Unknown are the angles, F across the edge or at the corner, and the bead's
arc length where it slides,

    springs(angles) = F . dc/d angles,    P (c - p) = (r/|F| - 1/k) F,    F . t = 0 if it slides,

with c the bead's centre, p a point of what is touched and P the projection across it: no normal,
which turns within the radius r of the vibrissa, takes part. Nothing of this is in a reading: it is
where Newton's method on MuJoCo's own balance begins.
"""

import math
from bisect import bisect_left
from typing import NamedTuple

import numpy as np
from scipy.linalg import eigvalsh_tridiagonal
from scipy.linalg.lapack import dgesv, dgtsv, dpttrf, dsyev

from analytic.numerics.arrays import Floats
from analytic.space.problem.bodies.body import Feature
from mujoco_models.beams.layout import Layout
from mujoco_models.beams.protocol import Law

_ITERATIONS = 14
_NOT_HALVED = 5  # steps; from its start or later, Newton's method that leads anywhere halves them
_LARGEST_TURN = 0.4  # rad, of a link in one step
_LONGEST_SLIDE = 0.1  # L, of the bead in one step
_FOUND = 1e-7  # rad and L, of a step: the next one would be of rounding's size
_OUTWARD = 1e-12  # cosine; rounding of what is tangential
_SAME = 1e-13  # L
_LEAST_FORCE = 1e-9  # EI/L^2; with less the force has no direction to start from
_UNIT = np.eye(3)
_SLIGHT = 1e-6  # rad, below which a joint bends across the plane as it does within
HEAD_ON = 1e-6
"""Cosine of a force with the way across the clamp, below which it has no plane with it."""


class Planar(NamedTuple):
    """A chain in a plane with its clamp, and a contact; lengths in L."""

    angles: Floats  # of the links from the clamp's tangent, shape (n_links,) [rad]
    side: Floats  # to which they turn: a unit vector across the clamp's tangent, shape (3,)
    link: int  # the link that carries the bead
    s: float  # arc length of the bead [L]
    force: Floats  # of the body on the vibrissa, in the plane, shape (3,) [EI/L^2]
    sliding: bool  # whether the bead is where its link is tangential
    # Whether it is at rest, and the energy of vibrissa and contact is least there
    stable: bool = False


class _Bent(NamedTuple):
    """The loaded part of a chain."""

    angles: Floats  # shape (n,) [rad]
    levers: Floats  # of the force, shape (n,) [L]
    ways: Floats  # cosines and sines of the angles, shape (2, n)
    along: float  # from the first joint to the bead, along the clamp's tangent [L]
    aside: float  # to the side [L]


class Forecast:
    """Newton's method on the surrogate of a chain."""

    def __init__(
        self, layout: Layout, law: Law, tangent: Floats, radius: float, contact_stiffness: float
    ) -> None:
        self._law, self._tangent, self._radius = law, tangent, radius
        self._k = contact_stiffness
        self._joints, self._lengths = layout.joints, layout.lengths
        self._begins: list[float] = layout.joints.tolist()
        self._springs = 1 / layout.compliances

    def rest(
        self,
        start: Planar,
        feature: Feature,
        foot: Floats,
        near: Floats | None = None,
        far: float = math.inf,
    ) -> Planar | None:
        """The equilibrium to which Newton's method leads."""
        planar, before, apart, not_halved = start, math.inf, math.inf, 0
        onto = feature.basis @ self._tangent
        clamp = foot + self._begins[0] * self._tangent
        first = feature.basis @ (clamp - feature.point)
        for _ in range(_ITERATIONS):
            if planar.force @ planar.force < _LEAST_FORCE**2:
                return None
            bent = self._bent(planar)
            if near is not None:
                away = clamp + bent.along * self._tangent + bent.aside * planar.side - near
                before_that, apart = apart, math.sqrt(away @ away)
                if apart > max(far, before_that):
                    return None
            stepped = self._step(planar, bent, feature.basis, first, onto)
            if stepped is None:
                return None
            planar, size = stepped
            if size < _FOUND:
                return planar
            not_halved += 2 * size > before
            if not_halved == _NOT_HALVED:
                return None
            before = size
            planar = self._slid_or_held(planar)
        return None

    def planar(
        self, tangents: Floats, link: int, s: float, force: Floats, sliding: bool
    ) -> Planar | None:
        """A chain, turned into the plane of its clamp and of the force on it."""
        across = force - (force @ self._tangent) * self._tangent
        size = float(np.linalg.norm(across))
        if size <= HEAD_ON * np.linalg.norm(force):
            return None
        side = across / size
        angles = np.arctan2(tangents @ side, tangents @ self._tangent)
        return Planar(angles, side, link, s, force, sliding)

    def centre(self, planar: Planar, foot: Floats) -> Floats:
        """Of the bead."""
        bent = self._bent(planar)
        along = self._begins[0] + bent.along
        return np.asarray(foot + along * self._tangent + bent.aside * planar.side)

    def _bent(self, planar: Planar) -> _Bent:
        """Of the links up to the contact, and two at least: LAPACK asks for it."""
        link = planar.link
        levers = self._lengths[: max(link, 1) + 1].copy()
        levers[link:] = 0.0
        levers[link] = planar.s - self._begins[link]
        angles = planar.angles[: len(levers)]
        ways = np.array([np.cos(angles), np.sin(angles)])
        along, aside = (ways @ levers).tolist()
        return _Bent(angles, levers, ways, along, aside)

    def _step(
        self, planar: Planar, bent: _Bent, basis: Floats, first: Floats, onto_tangent: Floats
    ) -> tuple[Planar, float] | None:
        """One step, and its size."""
        parts, slides, link, side = len(basis), int(planar.sliding), planar.link, planar.side
        angles, levers, ways, reach, aside = bent
        count = len(levers)
        along, across = float(planar.force @ self._tangent), float(planar.force @ side)
        if abs(across) <= HEAD_ON * abs(along):
            return None
        bends = angles.copy()
        bends[1:] -= angles[:-1]
        slope, second = self._law(bends)
        springs = self._springs[:count]
        slope, second = slope * springs, second * springs
        # Of the force across the links and along them, and of its parts.
        turned = np.array([[across, -along], [0.0, -1.0], [1.0, 0.0], [along, across]]) @ ways
        # Right-hand sides: the imbalance, the levers of the force's parts, the link's own.
        right = np.zeros((3 + slides, count))
        if slides:
            right[3, link] = turned[0, link]
        turned *= levers
        right[:3] = turned[:3]
        right[0] -= slope
        right[0, :-1] += slope[1:]
        beside, pressed = -second[1:], turned[3]
        own = second + pressed
        own[:-1] -= beside
        *_, found, failed = dgtsv(beside, own, beside, right.T)
        if failed:
            return None
        # Their turns are free + bent (force's parts, slide): into the rows of the contact. With a
        # force that turns about the clamp's tangent the whole chain turns.
        swing = aside / across
        (a, a1, a2, *a3), (b, b1, b2, *b3), *of_slide = (right[1:] @ found).tolist()
        if slides:
            ((c, c1, c2, c3),) = of_slide
            cos, sin = ways[:, link].tolist()
            inner = [
                [a + reach, swing - a1, -a2, -a3[0] - cos],
                [b + aside, -b1, swing - b2, -b3[0] - sin],
                [c + along * cos + across * sin, -c1 - cos, -c2 - sin, -c3],
            ]
        else:
            inner = [[a + reach, swing - a1, -a2], [b + aside, -b1, swing - b2]]
        onto = np.zeros((2 + slides, parts + slides))
        onto[0, :parts], onto[1, :parts] = onto_tangent, basis @ side
        if slides:
            onto[2, -1] = 1.0
        products = onto.T @ np.array(inner)
        rows, rest = products[:, 1:] @ onto, products[:, 0]
        force = basis @ planar.force
        size = math.sqrt(force @ force)
        held = self._radius / size - 1 / self._k
        own_rows = rows[:parts, :parts]
        own_rows -= (self._radius / size**3 * force)[:, None] * force
        own_rows += (held - swing) * _UNIT[:parts, :parts]
        rest[:parts] += first - held * force
        *_, change, failed = dgesv(rows, rest)
        if failed:
            return None
        parted = onto @ change
        turns = found[:, 0] + found[:, 1:] @ parted
        more = change[:parts]
        aslant = math.sqrt(max(more @ more - parted[:2] @ parted[:2], 0.0))
        most = float(np.abs(turns).max())
        swung = aslant / abs(across)
        if swung > most:
            most = max(most, swung * float(np.abs(ways[1]).max()))
        slide = float(change[-1]) if slides else 0.0
        largest = max(most, abs(slide))
        if not math.isfinite(largest):
            return None
        stable = False
        if largest < _FOUND:
            # Only the contact's row and that of a bead that slides, to where the distance is
            # least, are negative then (Haynsworth's inertia).
            negative = _negative(own, beside) + self._negative_across(slope, bends, pressed)
            negative += int((dsyev(rows, compute_v=0)[0] < 0).sum())
            stable = negative == 1 + slides
        share = min(
            1.0, _LARGEST_TURN / max(most, 1e-300), _LONGEST_SLIDE / max(abs(slide), 1e-300)
        )
        pushed = planar.force + (share * more) @ basis
        if parts == 1 and pushed @ planar.force <= 0:
            return None
        turned = planar.angles.copy()
        turned[:count] += share * turns
        turned[count:] = turned[count - 1]
        link, s = self._slid(planar, share * slide) if slides else (link, planar.s)
        turned_to = self._side(pushed, side)
        return Planar(turned, turned_to, link, s, pushed, planar.sliding, stable), largest

    def _side(self, force: Floats, before: Floats) -> Floats:
        """Of the plane of a force, turned as little as may be."""
        across = force - (force @ self._tangent) * self._tangent
        return np.asarray(across / math.copysign(math.sqrt(across @ across), across @ before))

    def _negative_across(self, slope: Floats, bends: Floats, pressed: Floats) -> int:
        """How many ways across its plane the chain, under its force, would leave it."""
        straight = np.abs(bends) < _SLIGHT
        tension = np.where(straight, self._springs[: len(bends)], slope)
        tension = tension / np.where(straight, 1.0, np.sin(bends))
        own = tension * np.cos(bends)
        own[:-1] += own[1:]
        return _negative(own + pressed, -tension[1:])

    def _slid_or_held(self, planar: Planar) -> Planar:
        """Whether the bead slides, or is at the tip, and held there."""
        if 1.0 - planar.s < _SAME:
            last = float(planar.angles[-1])
            slope = math.cos(last) * (planar.force @ self._tangent)
            slope += math.sin(last) * (planar.force @ planar.side)
            return planar._replace(sliding=bool(slope > _OUTWARD * np.linalg.norm(planar.force)))
        return planar._replace(sliding=planar.s > self._begins[0])

    def _slid(self, planar: Planar, by: float) -> tuple[int, float]:
        """Along the vibrissa, whose links beyond the contact are straight."""
        s = max(min(planar.s + by, 1.0), self._begins[0])
        return bisect_left(self._begins, s, 1) - 1, s


def _negative(own: Floats, beside: Floats) -> int:
    """How many eigenvalues of a tridiagonal matrix are negative, mostly none."""
    if not dpttrf(own, beside)[-1]:
        return 0
    return int((eigvalsh_tridiagonal(own, beside) < 0).sum())
