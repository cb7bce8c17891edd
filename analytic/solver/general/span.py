"""A loaded span of constant natural curvature, from the contact back to the clamp, in closed form.

With the moment of a dead force F of slope angle phi_F about the span's end, the curvature obeys
kappa' = F cos(theta), theta = phi - phi_F: the pendulum's equation, whatever the natural curvature,
as long as that is constant. With chi = pi/4 - theta/2 the three functions

    p = sin(chi),  g = cos(chi),  v = -kappa/2    obey    p' = g v,  g' = -p v,  v' = -F p g,

so that p^2 + g^2 = 1 and F p^2 + v^2 = B stay. They are k sn, dn and sqrt(F) k cn with k^2 = B/F.
Let S(s) be the solution of S' = c d, c^2 = 1 - F S^2, d^2 = 1 - B S^2, S(0) = 0: it is sn/sqrt(F)
of modulus k for k < 1, sn/sqrt(B) of modulus 1/k for k > 1. The addition theorems of sn, cn and dn
(Byrd and Friedman, *Handbook of elliptic integrals*, 1971, 123.01) take p, g and v from the contact
to the clamp, and that of the second kind's integral (116.02) gives the position. Written so,
nothing is singular: neither where the curvature changes its sign, nor at k = 1, nor where the force
vanishes.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import ellipj, elliprd

from analytic.problem.arrays import Floats

_TINY = 1e-300  # instead of nothing, to divide by


class Start(NamedTuple):
    """The clamp's end of the span, as seen from the contact; arrays of one shape."""

    p: Floats
    g: Floats  # sin(chi) and cos(chi) of the slope at the clamp
    kappa: Floats
    along: Floats
    across: Floats  # integrals of cos(theta) and sin(theta) from the clamp to the contact
    amplitude: Floats  # amplitude of the span: pi at half a period [rad]

    def way(self, direction: Floats) -> tuple[Floats, Floats]:
        """From the clamp to the contact along x and y, the force at a slope angle."""
        sin, cos = np.sin(direction), np.cos(direction)
        return self.along * cos - self.across * sin, self.along * sin + self.across * cos

    def angle_from(self, due: Floats) -> Floats:
        """The angle chi at the clamp, from another one [rad]."""
        sin, cos = np.sin(due), np.cos(due)
        return np.asarray(np.arctan2(self.p * cos - self.g * sin, self.g * cos + self.p * sin))


def back_to_clamp(theta: Floats, kappa: Floats, force: Floats, length: Floats) -> Start:
    chi = np.pi / 4 - theta / 2
    p1, g1, v1 = np.sin(chi), np.cos(chi), -kappa / 2
    energy = force * p1**2 + v1**2
    swings = energy <= force  # the pendulum does; else it turns over
    larger = np.maximum(np.where(swings, force, energy), _TINY)
    m = np.where(swings, energy, force) / larger
    root = np.sqrt(larger)
    sn, cn, dn, _ = ellipj(root * length, m)
    S = sn / root
    S_S = S * S
    c, d = np.where(swings, cn, dn), np.where(swings, dn, cn)
    down = energy * _second_kind(S, S_S, cn, dn, m, root)

    p1_S, g1_d, v1_S = p1 * S, g1 * d, v1 * S
    D = 1 - force * p1_S**2
    p = (p1 * c * d - v1_S * g1) / D
    g = (g1_d + p1 * v1_S * c) / D
    # (1 - c)/F, as it is best where the force is small or large.
    large = (1 - c) / np.maximum(force, _TINY)
    fall = np.where(c >= 0, S_S / (1 + np.maximum(c, 0)), large)
    gained = (v1 * (p1_S**2 - fall) + p1_S * g1_d) / D  # (v - v1)/F
    along = 2 * gained
    across = length - 2 * (down + p1_S * p)
    return Start(p, g, kappa - force * along, along, across, np.arctan2(sn, cn) % (2 * np.pi))


def _second_kind(S: Floats, S_S: Floats, cn: Floats, dn: Floats, m: Floats, root: Floats) -> Floats:
    """Integral of S^2 by arc length, from 0 (Carlson's R_D; DLMF 19.25.10)."""
    rising = np.abs(S) * S_S / 3 * elliprd(cn * cn, dn * dn, 1.0)
    first = ~((cn < 0) | (S < 0))
    if first.all():  # no longer than a quarter of a period
        return rising
    quarter = np.zeros_like(S)
    quarter[~first] = elliprd(0.0, 1 - m[~first], 1.0) / (3 * root[~first] ** 3)
    return np.where(
        S >= 0,
        np.where(cn >= 0, rising, 2 * quarter - rising),
        np.where(cn < 0, 2 * quarter + rising, 4 * quarter - rising),
    )
