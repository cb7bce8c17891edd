"""The contact from the clamp's end of any vibrissa.

From force and moment at the clamp follow the slope there and the force's direction phi_F, which is
the contour's slope angle plus the friction angle arctan(mu). Up to the contact the moment falls to
what friction's couple leaves of it, M = mu r f. Where that is, is known in closed form if natural
curvature and rigidity are constant. In the terms of `analytic.solver.general.span`, p = sin(chi),
g = cos(chi) and v = -kappa/2 with chi = pi/4 - (phi - phi_F)/2, the curvature there gives v,
F p^2 + v^2 = B gives p but for its sign, and the addition theorems of sn, cn and dn, read backwards
(Byrd and Friedman, *Handbook of elliptic integrals*, 1971, 123.01), the arc length between two
places of which all three are known. A vibrissa that varies is marched along by collocation, and the
place is sought where the moment passes the couple, and what a weight beyond leaves there.
"""

from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

import numpy as np
from scipy.special import elliprf

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.batches import take
from analytic.problem.rod import RodProperties
from analytic.solver.general.span import SpanEnd, Trail, back_to_clamp, march
from analytic.solver.general.states import Vibrissa

# Where the vibrissa is nearly square to the force at its contact (p^2 below), its moment is the
# same all around and does not say where the contact is. In Phase B it is never so (p^2 is 1/2
# without friction and at least 0.15 with a coefficient of 1 of either sign), and in Phase A the
# contact is the tip.
_FLAT = 0.01
_ROUNDS = 12  # of Newton's method, from a place between two nodes of a panel
_STEP = 1e-6  # L; of a difference, at which Newton's method takes no more of them
_SAME = 1e-9  # L; of a step of Newton's method, whose next one would be of its square
_NEAR_TIP = 0.2  # L; the place may be that far beyond the tip, as far as the moment there says
_LONGEST = 2.0  # L; so far the straight continuation of the tip is followed

_Candidate: TypeAlias = tuple[Integers, Floats, Floats]
"""Vibrissae that may touch there, the arc length, and the slope angle from the force's [rad]."""


class Reached(NamedTuple):
    """Places of the vibrissa as seen from its foot, of a sweep to the left; arrays of one shape."""

    alpha: Floats  # slope angle of the contour that is touched there [rad]
    arc_length: Floats
    x: Floats
    y: Floats


class ClampEnd(NamedTuple):
    """The clamp's end of vibrissae in a sweep to the left, dimensionless; arrays of one shape."""

    force: Floats
    direction: Floats  # slope angle phi_F of the force on the vibrissa at its contact [rad]
    moment: Floats
    theta: Floats  # slope angle at the clamp, from the force's [rad]
    vibrissa: Vibrissa

    @classmethod
    def of(cls, force_x: Floats, force_y: Floats, moment: Floats, vibrissa: Vibrissa) -> "ClampEnd":
        direction = np.arctan2(-force_x, force_y)
        leant = vibrissa.clamp_angle - vibrissa.compliance * moment
        theta = np.pi / 2 + leant - direction
        return cls(np.hypot(force_x, force_y), direction, moment, theta, vibrissa)

    def parallel(self, theta: Floats) -> Floats:
        """Slope angle of a vibrissa that is parallel to the contour, from the force's [rad].

        It is that of the side, front or back, on which one of slope angle theta more nearly lies.
        """
        lean, rub = self.vibrissa.lean, np.arctan(self.vibrissa.friction)
        return np.where(theta + rub > np.pi / 2, np.pi - lean, lean) - rub

    def left(self, s: Floats, theta: Floats, m: Floats) -> Floats:
        """What of the moment neither friction nor the weight beyond explains."""
        beyond = self.vibrissa.moment_beyond(theta + self.direction, s)
        left = m + self.couple(s)
        return left if beyond is None else left - beyond

    def couple(self, s: Floats) -> Floats:
        """Couple of the friction if the contact is there."""
        mu = self.vibrissa.friction
        return np.asarray(mu / np.sqrt(1 + mu**2) * self.vibrissa.radius_at(s) * self.force)

    def march(self, s: Floats) -> SpanEnd:
        """Go up the vibrissa; beyond the tip one that varies goes on straight."""
        rod = self.vibrissa.rod
        if rod is None:
            # From this end the curvature is the opposite one.
            natural = self.vibrissa.natural_curvature
            start = back_to_clamp(self.theta, self.moment - natural, self.force, s)
            theta = np.pi / 2 - 2 * np.arctan2(start.p, start.g)
            return SpanEnd(
                theta, -start.kappa - natural, start.along, start.across, start.amplitude
            )
        begin = self.theta, -self.moment, self.force
        given = np.broadcast_arrays(*begin, np.minimum(s, 1.0), self.direction)
        known = np.isfinite(sum(given))
        found = np.full((len(SpanEnd._fields), *known.shape), np.nan)
        if known.any():
            theta, m, force, length, direction = (values[known] for values in given)
            found[:, known] = march(
                rod, theta, m, force, length, direction=direction, from_clamp=True
            )
        end, beyond = SpanEnd(*found), np.maximum(s - 1, 0.0)
        cos, sin = np.cos(end.theta), np.sin(end.theta)
        return end._replace(
            m=end.m + beyond * self.force * cos,
            along=end.along + beyond * cos,
            across=end.across + beyond * sin,
        )

    def place(self, arc_length: Floats) -> Reached:
        end = self.march(arc_length)
        sin, cos = np.sin(self.direction), np.cos(self.direction)
        return Reached(
            np.asarray(self.direction - np.arctan(self.vibrissa.friction)),
            arc_length,
            end.along * cos - end.across * sin,
            end.along * sin + end.across * cos,
        )

    def sine_at_contact(self, arc_length: Floats) -> Floats:
        """Sine of the vibrissa's slope angle at its contact, from the force's.

        Of constant curvature and rigidity twice the energy, kappa^2 - 2 F sin(phi - phi_F), is the
        same all along.
        """
        if self.vibrissa.rod is not None:
            return np.asarray(np.sin(self.march(arc_length).theta))
        couple, natural = self.couple(arc_length), self.vibrissa.natural_curvature
        lost = (self.moment - couple) / self.force
        return np.asarray(np.sin(self.theta) + lost * (natural - (self.moment + couple) / 2))

    def contact_arc_length(self) -> Floats:
        """Arc length up to where the moment has fallen to friction's couple.

        Of several such places it is the one that is at the tip, or where the vibrissa is parallel
        to the contour, as nearly as can be.
        """
        known = np.isfinite(self.force + self.moment)
        found = np.full(known.shape, np.nan)
        if known.any():
            found[known] = _contacts(take(self, known))
        return found


def _contacts(end: ClampEnd) -> Floats:
    best, least = np.full(end.force.size, np.nan), np.full(end.force.size, np.inf)
    rod = end.vibrissa.rod
    for which, length, slope in _in_closed_form(end) if rod is None else _marched(end, rod):
        aside = np.where(length < 1, np.abs(slope - end.parallel(slope)), np.inf)
        missed = np.fmin(np.abs(length - 1), aside)
        # A pendulum's turning points are all as parallel: of those it is the first one.
        so_far = least[which]
        nearer = missed < so_far - _SAME
        nearer |= (missed < so_far + _SAME) & (length < best[which])
        best[which[nearer]], least[which[nearer]] = length[nearer], missed[nearer]
    return np.where(_is_flat(end), 1.0, best)


def _is_flat(end: ClampEnd) -> Booleans:
    """Whether the moment says nothing of where the contact is, which then is the tip."""
    vibrissa, tip = end.vibrissa, np.ones_like(end.force)
    if vibrissa.rod is None and vibrissa.natural_curvature == 0 and vibrissa.radius == 0:
        return np.zeros(end.force.shape, dtype=bool)  # the moment is nil at one place alone
    there = end.march(tip)
    if vibrissa.rod is None:
        square = np.abs(_Pendulum.of(end).square)
    else:
        left, flexibility = there.m + end.couple(tip), vibrissa.rod.flexibility(np.ones(1))
        with np.errstate(divide="ignore", invalid="ignore"):
            square = left**2 * flexibility / 4 / end.force
    return np.asarray((square < _FLAT) & (np.sin(np.pi / 4 - there.theta / 2) ** 2 < _FLAT))


class _Pendulum(NamedTuple):
    """p, g and v at the clamp, and v and the square of p where the moment is the couple."""

    p: Floats
    g: Floats
    v: Floats
    v_there: Floats
    square: Floats

    @classmethod
    def of(cls, end: ClampEnd) -> "_Pendulum":
        chi, natural = np.pi / 4 - end.theta / 2, end.vibrissa.natural_curvature
        couple = end.couple(np.ones_like(end.force))
        p, v, there = np.sin(chi), (end.moment - natural) / 2, (couple - natural) / 2
        return cls(p, np.cos(chi), v, there, p**2 + (v - there) / end.force * (v + there))


def _in_closed_form(end: ClampEnd) -> Iterator[_Candidate]:
    """The curvature is that of two places a period."""
    p0, g0, v0, v1, square = _Pendulum.of(end)
    there = (square >= 0) & (square <= 1)
    for sign in (1.0, -1.0):
        p1 = sign * np.sqrt(np.where(there, square, np.nan))
        g1 = np.sqrt(1 - p1**2)
        length = _length_between(end.force, p0, g0, v0, p1, g1, v1)
        yield np.arange(length.size), length, np.pi / 2 - 2 * np.arctan2(p1, g1)


def _length_between(
    force: Floats, p0: Floats, g0: Floats, v0: Floats, p1: Floats, g1: Floats, v1: Floats
) -> Floats:
    """Arc length from one place to the next with given p, g and v, within a period."""
    energy = force * p0**2 + v0**2
    with np.errstate(divide="ignore", invalid="ignore"):
        D = energy - force * (p0 * p1) ** 2
        S = (p1 * v0 * g0 - p0 * v1 * g1) / D
        c = (v0 * v1 + force * p0 * p1 * g0 * g1) / D
        d = (energy * g0 * g1 + p0 * p1 * v0 * v1) / D
        swings = energy <= force
        cn = np.where(swings, c, d)
        larger = np.where(swings, force, energy)
        m = np.where(swings, energy, force) / larger
    known = np.isfinite(S) & np.isfinite(m)
    S, c, d, cn = (np.where(known, values, 0.5) for values in (S, c, d, cn))
    m, larger = np.where(known, m, 0.5), np.where(known, larger, 1.0)
    rising = np.abs(S) * elliprf(c**2, d**2, np.ones_like(S))
    half = 2 * elliprf(0.0, 1 - m, np.ones_like(S)) / np.sqrt(larger)
    length = np.where(
        S >= 0,
        np.where(cn >= 0, rising, half - rising),
        np.where(cn < 0, half + rising, 2 * half - rising),
    )
    return np.where(known, length, np.nan)


def _marched(end: ClampEnd, rod: RodProperties) -> Iterator[_Candidate]:
    """Between which nodes the moment passes the couple, and next to the tip.

    What hangs beyond a node is taken to be straight: it only has to show where to look.
    """
    trail: list[Trail] = []
    whole, here = np.ones_like(end.force), (end.theta, -end.moment, end.force)
    tip = march(rod, *here, whole, direction=end.direction, from_clamp=True, trail=trail)
    clamp = 0 * whole, end.theta, -end.moment
    s, theta, m = (
        np.concatenate([begin[None], *pieces])
        for begin, *pieces in zip(clamp, *((p.s, p.theta, p.m) for p in trail), strict=True)
    )
    slope, (w_x, w_y) = theta + end.direction, end.vibrissa.weight
    hangs = (1 - s) ** 2 / 2 * (w_y * np.cos(slope) - w_x * np.sin(slope))
    excess = m + end.couple(s) - hangs
    passed = np.signbit(excess[1:]) != np.signbit(excess[:-1])
    for number in range(int(passed.sum(axis=0).max(initial=0))):
        which = np.flatnonzero(passed.sum(axis=0) > number)
        at = np.argsort(~passed[:, which], axis=0, kind="stable")[number]
        low, high = excess[at, which], excess[at + 1, which]
        begin, stop = s[at, which], s[at + 1, which]
        yield which, *_refined(take(end, which), begin + (stop - begin) * low / (low - high))
    with np.errstate(divide="ignore", invalid="ignore"):
        ahead = excess[-1] / (end.force * np.cos(tip.theta))
    near = np.flatnonzero(np.abs(ahead) < _NEAR_TIP)
    yield near, *_refined(take(end, near), np.ones(near.size))


def _refined(end: ClampEnd, start: Floats) -> tuple[Floats, Floats]:
    """Newton's method for the arc length at which the moment is the couple; the slope there."""
    s, slope, moved = start.copy(), np.empty_like(start), np.full_like(start, np.inf)
    for _ in range(_ROUNDS):
        on = np.flatnonzero(moved > _SAME)
        if on.size == 0:
            break
        some, here = take(end, on), s[on]
        place, farther = some.march(here), some.march(here + _STEP)
        left = some.left(here, place.theta, place.m)
        rate = (some.left(here + _STEP, farther.theta, farther.m) - left) / _STEP
        with np.errstate(divide="ignore", invalid="ignore"):
            new = np.clip(here - left / rate, 0.0, _LONGEST)
        s[on], slope[on], moved[on] = new, place.theta, np.abs(new - here)
    settled = moved <= _SAME
    return np.where(settled, s, np.nan), np.where(settled, slope, np.nan)
