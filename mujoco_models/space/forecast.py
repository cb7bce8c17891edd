"""Where a vibrissa will rest on a face, an edge or a corner, before MuJoCo is asked.

Joints that bend alike in all directions store energy by the angle between two links, and one
frictionless contact does not twist them: the directions of the links say everything. In these the
springs couple neighbours only, and the lever of a force turns with one link at a time. Unknown
beside them is the force, a vector across the edge or at the corner,

    springs(t) = F . dc/dt,    P (c - p) = (r/|F| - 1/k) F,    F . t = 0 where the bead slides,

with c the bead's centre, p a point of what is touched and P the projection across it: no normal,
which turns within the radius r of the vibrissa, takes part. Nothing of this is in a reading: it is
where Newton's method on MuJoCo's own balance begins.
"""

import math
from typing import NamedTuple

import numpy as np
from scipy.linalg import eigvals_banded
from scipy.linalg.lapack import dgbsv, dgesv, dpbtrf, dsyev

from analytic.problem.arrays import Floats
from mujoco_models.beams.layout import Layout
from mujoco_models.space.beams import Law
from mujoco_models.space.surface import Feature

_ITERATIONS = 14
_LARGEST_TURN = 0.4  # rad, of a link in one step
_LONGEST_SLIDE = 0.1  # L, of the bead in one step
_FOUND = 1e-7  # rad and L, of a step: the next one would be of rounding's size
_OUTWARD = 1e-12  # cosine; rounding of what is tangential
_SAME = 1e-13  # L
_BESIDE = 3  # diagonals on either side of the main one
_LEAST_FORCE = 1e-9  # EI/L^2; with less the force has no direction to start from
_ABOUT = np.cross(np.eye(3)[None], np.eye(3)[:, None])  # t @ _ABOUT[i] is t x e_i


class Bow(NamedTuple):
    """Directions of the links and a contact; lengths in L."""

    tangents: Floats
    """Shape (n_links, 3)."""
    link: int
    """The link that carries the bead."""
    s: float
    """Arc length of the bead [L]."""
    force: Floats
    """Of the body on the vibrissa, shape (3,) [EI/L^2]."""
    sliding: bool
    """Whether the bead is where its link is tangential."""
    stable: bool = False
    """Whether it is at rest, and the energy of vibrissa and contact is least there."""


class _Chain(NamedTuple):
    """Derivatives of the energy by the turns of m links across themselves."""

    levers: Floats
    """Of the force, shape (m,) [L]."""
    frames: Floats
    """Each link's direction and two ways across it, shape (m, 3, 3)."""
    own: Floats
    """Second derivatives by a link's turns, shape (m, 2, 2) [EI/L]."""
    beside: Floats
    """By a link's and the next one's, shape (m - 1, 2, 2) [EI/L]."""
    imbalance: Floats
    """First derivatives less the force's, shape (2 m,) [EI/L]."""

    def band(self) -> Floats:
        """The second derivatives as LAPACK's general band."""
        own, beside, main = self.own, self.beside, 2 * _BESIDE
        found = np.zeros((3 * _BESIDE + 1, len(self.imbalance)), order="F")
        found[main, 0::2], found[main, 1::2] = own[:, 0, 0], own[:, 1, 1]
        found[main - 1, 1::2] = found[main + 1, 0::2] = own[:, 0, 1]
        for i in range(2):
            for j in range(2):  # turn i of a link, j of the next one
                gap = 2 + j - i
                found[main - gap, 2 + j :: 2] = found[main + gap, i:-2:2] = beside[:, i, j]
        return found

    def negative(self, band: Floats) -> int:
        """How many eigenvalues are negative, mostly none."""
        if not dpbtrf(band[_BESIDE : 2 * _BESIDE + 1])[1]:
            return 0
        return int((eigvals_banded(band[_BESIDE : 2 * _BESIDE + 1]) < 0).sum())


class Forecast:
    """Newton's method on the picture of a chain.

    Parameters
    ----------
    layout : Layout
        Where the joints are.
    law : callable
        Of a joint's energy, times its compliance.
    tangent : array, shape (3,)
        Of the vibrissa at its clamp.
    radius : float
        Of the vibrissa [L].
    contact_stiffness : float
        Force over penetration [EI/L^3].
    """

    def __init__(
        self, layout: Layout, law: Law, tangent: Floats, radius: float, contact_stiffness: float
    ) -> None:
        self._law, self._tangent, self._radius = law, tangent, radius
        self._k = contact_stiffness
        self._joints, self._lengths = layout.joints, layout.lengths
        self._ends = np.append(layout.joints[1:], 1.0)
        self._springs = 1 / layout.compliances

    def rest(self, start: Bow, surface: Feature, foot: Floats) -> Bow | None:
        """The equilibrium to which Newton's method leads.

        Parameters
        ----------
        start : Bow
            Where it begins.
        surface : Feature
            What is touched.
        foot : array, shape (3,)
            Position of the foot [L].

        Returns
        -------
        Bow or None
            None if it leads nowhere, or to where nothing presses.
        """
        bow, basis = start, surface.basis
        for _ in range(_ITERATIONS):
            if bow.force @ bow.force < _LEAST_FORCE**2:
                return None
            stepped = self._step(bow, basis, surface.point, foot)
            if stepped is None:
                return None
            bow, size = stepped
            if size < _FOUND:
                return bow
            bow = self._slid_or_held(bow)
        return None

    def centre(self, bow: Bow, foot: Floats) -> Floats:
        """Of the bead.

        Parameters
        ----------
        bow : Bow
            Of the vibrissa.
        foot : array, shape (3,)
            Position of the foot [L].

        Returns
        -------
        array, shape (3,)
            [L]
        """
        start = foot + self._joints[0] * self._tangent
        start = start + self._lengths[: bow.link] @ bow.tangents[: bow.link]
        return np.asarray(start + (bow.s - self._joints[bow.link]) * bow.tangents[bow.link])

    def _step(
        self, bow: Bow, basis: Floats, point: Floats, foot: Floats
    ) -> tuple[Bow, float] | None:
        """One step, and its size."""
        count, parts, flat = bow.link + 1, len(basis), len(basis) == 1
        chain = self._chain(bow)
        t, levers, across = bow.tangents[:count], chain.levers, chain.frames[:, 1:]
        away = basis @ (foot + self._joints[0] * self._tangent + levers @ t - point)
        force = basis @ bow.force
        size = math.sqrt(force @ force)
        if flat:
            gap = away - (self._radius - force / self._k)
            matrix = np.full((1, 1), -1 / self._k)
        else:
            gap = away - (self._radius / size - 1 / self._k) * force
            matrix = (self._radius / size - 1 / self._k) * np.eye(parts)
            matrix -= self._radius / size**3 * np.outer(force, force)
        # Right-hand sides: the imbalance, the levers of the force's components, the link's own.
        slides = int(bow.sliding)
        right = np.zeros((2 * count, 1 + parts + slides), order="F")
        right[:, 0] = -chain.imbalance
        right[:, 1 : 1 + parts] = (across @ basis.T * levers[:, None, None]).reshape(-1, parts)
        if slides:
            right[-2:, -1] = across[-1] @ bow.force
        pulls = right[:, 1:].copy()
        band = chain.band()
        *_, found, failed = dgbsv(_BESIDE, _BESIDE, band, right, overwrite_b=1)
        if failed:
            return None
        # u = free + bent (dF, ds): into the rows of the contact.
        products = pulls.T @ found
        rows, rest = -products[:, 1:], products[:, 0]
        rows[:parts, :parts] += matrix
        rest[:parts] += gap
        if slides:
            slope = basis @ t[-1]
            rows[:parts, -1] -= slope
            rows[-1, :parts] -= slope
            rest[-1] += force @ slope
        *_, change, failed = dgesv(rows, rest)
        if failed:
            return None
        turns = found[:, 0] + found[:, 1:] @ change
        most = float(np.abs(turns).max())
        slide = float(change[-1]) if slides else 0.0
        slid = abs(slide)
        if not math.isfinite(most + slid):
            return None
        largest = max(most, slid)
        stable = False
        if largest < _FOUND:
            # Only the contact's row and that of a bead that slides, to where the distance is
            # least, are negative then (Haynsworth's inertia).
            negative = chain.negative(band) + int((dsyev(rows, compute_v=0)[0] < 0).sum())
            stable = negative == 1 + slides
        share = min(1.0, _LARGEST_TURN / max(most, 1e-300), _LONGEST_SLIDE / max(slid, 1e-300))
        pushed = bow.force + share * (change[:parts] @ basis)
        if flat and pushed @ bow.force <= 0:
            return None
        tangents = bow.tangents.copy()
        turned = t + share * (turns.reshape(count, 1, 2) @ across)[:, 0]
        turned /= np.sqrt(np.einsum("ij,ij->i", turned, turned))[:, None]
        tangents[:count], tangents[count:] = turned, turned[-1]
        bow = Bow(tangents, bow.link, bow.s, pushed, bow.sliding, stable)
        return self._moved(bow, share * slide) if slides else bow, largest

    def _chain(self, bow: Bow) -> "_Chain":
        """Stiffness of the links up to the contact, and what is out of balance."""
        count = bow.link + 1
        t = bow.tangents[:count]
        levers = self._lengths[:count].copy()
        levers[-1] = bow.s - self._joints[bow.link]
        # Each link's own frame: its direction, and two ways across it.
        frames = np.empty((count, 3, 3))
        axis = int(np.abs(t).max(axis=0).argmin())
        along = t[:, axis]
        frames[:, 0] = t
        frames[:, 1] = t @ _ABOUT[axis]
        frames[:, 2] = t * along[:, None]
        frames[:, 2, axis] -= 1.0
        frames[:, 1:] /= np.sqrt(1 - along**2)[:, None, None]
        before = np.concatenate([self._tangent[None], t[:-1]])
        behind = (frames @ before[:, :, None])[:, :, 0]
        ahead = (frames[:-1, 1:] @ t[1:, :, None])[:, :, 0]
        cosine, back = behind[:, 0], behind[:, 1:]
        springs = self._springs[:count]
        first, second = self._law(np.hypot(back[:, 0], back[:, 1]), cosine)
        first, second = first * springs, second * springs
        pull = levers[:, None] * (frames @ bow.force)
        tension = first * cosine
        tension[:-1] += tension[1:]
        tension -= pull[:, 0]
        imbalance = first[:, None] * back - pull[:, 1:]
        imbalance[:-1] += first[1:, None] * ahead
        own = (second[:, None] * back)[:, :, None] * back[:, None, :]
        bent = (second[1:, None] * ahead)[:, :, None]
        own[:-1] += bent * ahead[:, None, :]
        own[:, 0, 0] -= tension
        own[:, 1, 1] -= tension
        beside = frames[:-1, 1:] @ frames[1:, 1:].transpose(0, 2, 1)
        beside *= first[1:, None, None]
        beside += bent * back[1:, None, :]
        return _Chain(levers, frames, own, beside, imbalance.ravel())

    def _slid_or_held(self, bow: Bow) -> Bow:
        """Whether the bead slides, or is at the tip, and held there."""
        if self._ends[-1] - bow.s < _SAME:
            slope = bow.tangents[-1] @ bow.force
            return bow._replace(sliding=bool(slope > _OUTWARD * np.linalg.norm(bow.force)))
        return bow._replace(sliding=bow.s > self._joints[0])

    def _moved(self, bow: Bow, by: float) -> Bow:
        """Along the vibrissa, whose links beyond the contact are straight."""
        s = max(min(bow.s + by, 1.0), float(self._joints[0]))
        link = int(self._ends[:-1].searchsorted(s))
        return bow._replace(link=link, s=s)
