"""The contact from the clamp with friction, an elastic clamp and a natural curvature.

From force and moment at the clamp follow the slope there and the force's direction phi_F, which is
the contour's slope angle plus the friction angle arctan(mu). Up to the contact the moment falls to
what friction's couple leaves of it, M = mu r f. In the terms of `analytic.solver.general.span`, p =
sin(chi), g = cos(chi) and v = -kappa/2 with chi = pi/4 - (phi - phi_F)/2, the curvature there gives
v, F p^2 + v^2 = B gives p but for its sign, and the addition theorems of sn, cn and dn, read
backwards (Byrd and Friedman, *Handbook of elliptic integrals*, 1971, 123.01), the arc length
between two places of which all three are known.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import elliprf

from analytic.problem.arrays import Booleans, Floats
from analytic.solver.general.span import Start, back_to_clamp
from analytic.solver.general.states import Vibrissa

# Where the vibrissa is nearly square to the force at its contact (p^2 below), its moment is the
# same all around and does not say where the contact is. In Phase B it is never so (p^2 is 1/2
# without friction and at least 0.15 with a coefficient of 1 of either sign), and in Phase A the
# contact is the tip.
FLAT = 0.01
"""Of p^2, below which the moment does not say where the contact is."""


class Reached(NamedTuple):
    """Places of the vibrissa as seen from its foot, of a sweep to the left; arrays of one shape."""

    alpha: Floats
    """Slope angle of the contour that is touched there [rad]."""
    arc_length: Floats
    x: Floats
    y: Floats


class Clamped(NamedTuple):
    """The clamp's end of vibrissae in a sweep to the left, dimensionless; arrays of one shape."""

    force: Floats
    direction: Floats
    """Slope angle phi_F of the force on the vibrissa at its contact [rad]."""
    moment: Floats
    couple: Floats
    """Moment that is left at the contact."""
    theta: Floats
    """Slope angle at the clamp, from the force's [rad]."""
    vibrissa: Vibrissa

    @classmethod
    def of(cls, force_x: Floats, force_y: Floats, moment: Floats, vibrissa: Vibrissa) -> "Clamped":
        """What the readings say of the clamp's end."""
        compliance, mu, radius = vibrissa.compliance, vibrissa.friction, vibrissa.radius
        force, direction = np.hypot(force_x, force_y), np.arctan2(-force_x, force_y)
        couple = mu * radius * force / np.sqrt(1 + mu**2)
        theta = np.pi / 2 - compliance * moment - direction
        return cls(force, direction, moment, couple, theta, vibrissa)

    @property
    def alpha(self) -> Floats:
        """Slope angle of the contour at the contact [rad]."""
        return np.asarray(self.direction - np.arctan(self.vibrissa.friction))

    def sine_at_contact(self) -> Floats:
        """Sine of the vibrissa's slope angle at its contact, from the force's.

        Twice the energy, kappa^2 - 2 F sin(phi - phi_F), is the same all along.
        """
        natural = self.vibrissa.natural_curvature
        lost = (self.moment - self.couple) / self.force
        return np.asarray(np.sin(self.theta) + lost * (natural - (self.moment + self.couple) / 2))

    def march(self, arc_length: Floats) -> Start:
        """Go up the vibrissa."""
        natural = self.vibrissa.natural_curvature
        return back_to_clamp(self.theta, self.moment - natural, self.force, arc_length)

    def place(self, arc_length: Floats) -> Reached:
        """A place of the vibrissa."""
        end = self.march(arc_length)
        sin, cos = np.sin(self.direction), np.cos(self.direction)
        return Reached(
            self.alpha,
            arc_length,
            end.along * cos - end.across * sin,
            end.along * sin + end.across * cos,
        )

    def contact_arc_length(self) -> Floats:
        """Arc length up to where the moment has fallen to friction's couple.

        The curvature is that of two places a period. In Phase B the contact is the one where the
        vibrissa is parallel to the contour, in Phase A the one at the tip.
        """
        p0, g0 = np.sin(np.pi / 4 - self.theta / 2), np.cos(np.pi / 4 - self.theta / 2)
        v0 = (self.moment - self.vibrissa.natural_curvature) / 2
        v1 = (self.couple - self.vibrissa.natural_curvature) / 2
        square = p0**2 + (v0 - v1) / self.force * (v0 + v1)  # of p at the contact
        there = (square >= 0) & (square <= 1)
        lean = np.arctan(self.vibrissa.friction)
        best, least = np.full_like(p0, np.nan), np.full_like(p0, np.inf)
        for sign in (1.0, -1.0):
            p1 = sign * np.sqrt(np.where(there, square, np.nan))
            g1 = np.sqrt(1 - p1**2)
            length = self._length_between(p0, g0, v0, p1, g1, v1)
            excess = np.pi / 2 - 2 * np.arctan2(p1, g1) + lean
            missed = np.fmin(np.abs(length - 1), np.where(length < 1, np.abs(excess), np.inf))
            nearer = missed < least
            best, least = np.where(nearer, length, best), np.where(nearer, missed, least)
        return np.where(self._is_flat(square), 1.0, best)

    def _is_flat(self, square: Floats) -> Booleans:
        """Whether the moment says nothing of where the contact is, which then is the tip."""
        if self.vibrissa.natural_curvature == 0 and self.vibrissa.radius == 0:
            return np.zeros(np.shape(square), dtype=bool)  # the moment is nil at one place alone
        tip = self.march(np.ones_like(self.force)).p
        return np.asarray((np.abs(square) < FLAT) & (tip**2 < FLAT))

    def _length_between(
        self, p0: Floats, g0: Floats, v0: Floats, p1: Floats, g1: Floats, v1: Floats
    ) -> Floats:
        """Arc length from one place to the next with given p, g and v, within a period."""
        force = self.force
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
