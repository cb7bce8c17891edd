"""The contact from the clamp of a vibrissa whose rigidity, radius or natural curvature varies.

Force and moment at the clamp give the slope there and the force's direction, as in
`analytic.from_clamp.general`; from there the vibrissa is marched along by collocation, and its
contact is where the moment has fallen to what friction's couple leaves of it. The moment at a place
is the one at the clamp less the force times the way along its direction, m(s) = m(0) + F x(s).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from analytic.from_clamp.general import FLAT, Clamped, Reached
from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.solver.general.form import Form
from analytic.solver.general.march import Place, Trail, march
from analytic.solver.general.states import Vibrissa

_ROUNDS = 12  # of Newton's method, from a place between two nodes of a panel
_SAME = 1e-9  # L; of a step of Newton's method, whose next one would be of its square
_NEAR_TIP = 0.2  # L; the place may be that far beyond the tip, as far as the moment there says
_LONGEST = 2.0  # L; so far the straight continuation of the tip is followed


@dataclass(frozen=True, eq=False)
class Marched:
    """The clamp's end of vibrissae that vary, in a sweep to the left; arrays of one shape."""

    clamped: Clamped
    form: Form

    def sine_at_contact(self) -> Floats:
        """Sine of the vibrissa's slope angle at its contact, from the force's."""
        return np.asarray(np.sin(self._reached(self.contact_arc_length()).theta))

    def place(self, arc_length: Floats) -> Reached:
        """A place of the vibrissa."""
        end = self._reached(arc_length)
        beyond = np.maximum(arc_length - 1, 0.0)
        along = end.along + beyond * np.cos(end.theta)
        across = end.across + beyond * np.sin(end.theta)
        sin, cos = np.sin(self.clamped.direction), np.cos(self.clamped.direction)
        x, y = along * cos - across * sin, along * sin + across * cos
        return Reached(self.clamped.alpha, arc_length, x, y)

    def contact_arc_length(self) -> Floats:
        """Arc length up to where the moment has fallen to friction's couple.

        Of several such places it is the one that is at the tip, or where the vibrissa is parallel
        to the contour, as nearly as can be.
        """
        return self._contact

    @cached_property
    def _contact(self) -> Floats:
        shape = np.shape(self.clamped.force)
        best = np.full(shape, np.nan).ravel()
        known = np.isfinite(self.clamped.force + self.clamped.moment).ravel()
        if known.any():
            force, moment, theta = (
                np.broadcast_to(v, shape).ravel()[known]
                for v in (self.clamped.force, self.clamped.moment, self.clamped.theta)
            )
            best[known] = self._of(force, moment, theta).contacts()
        return best.reshape(shape)

    def _of(self, force: Floats, moment: Floats, theta: Floats) -> "_Spans":
        return _Spans(force, moment, theta, self.clamped.vibrissa, self.form)

    def _reached(self, arc_length: Floats) -> Place:
        c = self.clamped
        given = np.broadcast_arrays(c.theta, -c.moment, c.force, np.minimum(arc_length, 1.0))
        shape = given[0].shape
        known = np.isfinite(sum(given)).ravel()
        found = np.full((len(Place._fields), known.size), np.nan)
        if known.any():
            some = (np.array(values, dtype=float).ravel()[known] for values in given)
            found[:, known] = march(self.form, *some, from_clamp=True)
        return Place(*found.reshape(-1, *shape))


class _Spans(NamedTuple):
    """The same in one row."""

    force: Floats
    moment: Floats
    theta: Floats
    vibrissa: Vibrissa
    form: Form

    def contacts(self) -> Floats:
        """Arc lengths of the contacts, shape (n,)."""
        best, least = np.full(self.force.size, np.nan), np.full(self.force.size, np.inf)
        for which, start in self.starts():
            length, excess = self._some(which).refined(start)
            miss = np.fmin(np.abs(length - 1), np.where(length < 1, np.abs(excess), np.inf))
            nearer = miss < least[which]
            best[which[nearer]], least[which[nearer]] = length[nearer], miss[nearer]
        return np.where(self.is_flat(), 1.0, best)

    def _some(self, which: Integers) -> "_Spans":
        return self._replace(
            force=self.force[which], moment=self.moment[which], theta=self.theta[which]
        )

    def starts(self) -> list[tuple[Integers, Floats]]:
        """Between which nodes the moment passes the couple, and the tip: spans, arc lengths."""
        trail: list[Trail] = []
        whole = np.ones_like(self.force)
        end = march(self.form, self.theta, -self.moment, self.force, whole, from_clamp=True,
                    trail=trail)  # fmt: skip
        s = np.concatenate([np.zeros((1, self.force.size)), *(piece.s for piece in trail)])
        along = np.concatenate([np.zeros((1, self.force.size)), *(p.along for p in trail)])
        excess = -self.moment + self.force * along + self.couple(s)
        passed = np.signbit(excess[1:]) != np.signbit(excess[:-1])
        found = []
        for number in range(int(passed.sum(axis=0).max(initial=0))):
            which = np.flatnonzero(passed.sum(axis=0) > number)
            at = np.argsort(~passed[:, which], axis=0, kind="stable")[number]
            low, high = excess[at, which], excess[at + 1, which]
            begin, stop = s[at, which], s[at + 1, which]
            found.append((which, begin + (stop - begin) * low / (low - high)))
        with np.errstate(divide="ignore", invalid="ignore"):
            ahead = excess[-1] / (self.force * np.cos(end.theta))
        there = np.flatnonzero(np.abs(ahead) < _NEAR_TIP)
        return [*found, (there, np.ones(there.size))]

    def refined(self, start: Floats) -> tuple[Floats, Floats]:
        """Newton's method for the arc length; it, and by how much the slope is not Phase B's."""
        s, slope, moved = start.copy(), np.empty_like(start), np.full_like(start, np.inf)
        for _ in range(_ROUNDS):
            on = np.flatnonzero(moved > _SAME)
            if on.size == 0:
                break
            some, here = self._some(on), s[on]
            end = some.at(np.minimum(here, 1.0))
            rate = some.force * np.cos(end.theta)
            left = end.m + rate * np.maximum(here - 1, 0.0) + some.couple(here)
            with np.errstate(divide="ignore", invalid="ignore"):
                new = np.clip(here - left / (rate - some.couple_rate()), 0.0, _LONGEST)
            s[on], slope[on], moved[on] = new, end.theta, np.abs(new - here)
        parallel = self.vibrissa.lean - np.arctan(self.vibrissa.friction)
        settled = moved <= _SAME
        return np.where(settled, s, np.nan), np.where(settled, slope - parallel, np.nan)

    def is_flat(self) -> Booleans:
        """Whether the moment says nothing of where the contact is, which then is the tip."""
        end = self.at(np.ones_like(self.force))
        left = end.m + self.couple(np.ones_like(self.force))
        with np.errstate(divide="ignore", invalid="ignore"):
            swing = left**2 * self.form.flexibility(np.ones(1)) / 4 / self.force
        return np.asarray((swing < FLAT) & (np.sin(np.pi / 4 - end.theta / 2) ** 2 < FLAT))

    def at(self, arc_length: Floats) -> Place:
        return march(self.form, self.theta, -self.moment, self.force, arc_length, from_clamp=True)

    def couple(self, s: Floats) -> Floats:
        mu = self.vibrissa.friction
        return np.asarray(mu / np.sqrt(1 + mu**2) * self.vibrissa.radius_at(s) * self.force)

    def couple_rate(self) -> Floats:
        mu, rest = self.vibrissa.friction, self.form.unloaded
        return np.asarray(
            mu / np.sqrt(1 + mu**2) * (rest.base_radius - rest.tip_radius) * self.force
        )
