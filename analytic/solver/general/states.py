"""States at rest of a vibrissa with friction, an elastic clamp and a natural curvature.

Dimensionless throughout, on the contour that the centreline feels. Both phases are one family: the
excess w is s1 - 1 in Phase B, where it is negative, and phi1 - alpha in Phase A, where it is
positive, so that the phases take turns where it vanishes. With the normal force f, Coulomb friction
mu and slope angle alpha of the contour the force on the vibrissa is F = f sqrt(1 + mu^2) at the
slope angle phi_F = alpha + arctan(mu): a dead force again. It acts on the surface, so that the
couple -mu r f remains at the contact.
"""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.beam import Beam
from analytic.problem.contours.contour import ContourPoint
from analytic.problem.support import require_plain
from analytic.problem.unloaded import Unloaded
from analytic.solver.general.span import back_to_clamp

# Differences of second order, to one side: a force is not negative, and a phase ends where w = 0.
_DIFFERENCE = 1e-5  # of a force and an excess of size 1: truncation and round-off are alike
_BY_FORCE = np.array([0.0, 1.0, 2.0, 0.0, 0.0])
_BY_EXCESS = np.array([0.0, 0.0, 0.0, 1.0, 2.0])
_WEIGHTS = np.array([[-1.5, 2.0, -0.5, 0.0, 0.0], [-1.5, 0.0, 0.0, 2.0, -0.5]])


class Vibrissa(NamedTuple):
    """What the vibrissa and its contact are beyond the paper's, dimensionless."""

    natural_curvature: float = 0.0
    """Of the unloaded vibrissa; positive to the left of its way from clamp to tip [1/L]."""
    compliance: float = 0.0
    """Rotation of the clamp by moment [L/EI]."""
    friction: float = 0.0
    """Coefficient; positive where the object pushes the vibrissa along the contour to the right."""
    radius: float = 0.0
    """[L]"""

    @classmethod
    def of(cls, beam: Beam, clamp_stiffness: float, friction: float) -> "Vibrissa":
        """The numbers of a beam in its clamp, made dimensionless.

        Parameters
        ----------
        beam : Beam
            The vibrissa.
        clamp_stiffness, friction : float
            Moment of the clamp by its rotation [force length/rad]; coefficient.

        Returns
        -------
        Vibrissa
            Dimensionless.
        """
        if beam.varies:
            require_plain("the closed form", beam)
        return cls(
            float(beam.curvature_at(0.0)) * beam.length,
            beam.moment_unit / clamp_stiffness,
            friction,
            beam.radius / beam.length,
        )

    @property
    def unloaded(self) -> Unloaded:
        """Its shape and radius at rest."""
        return Unloaded(self.natural_curvature, self.radius, self.radius)

    def scaled(self, share: float) -> "Vibrissa":
        """The vibrissa a part of the way from the paper's to this one, its radius as it is.

        Parameters
        ----------
        share : float
            From 0 to 1.

        Returns
        -------
        Vibrissa
            Dimensionless.
        """
        return Vibrissa(
            share * self.natural_curvature,
            share * self.compliance,
            share * self.friction,
            self.radius,
        )


class States(NamedTuple):
    """Vibrissae against points of the contour, in balance or not; arrays of shape (n,)."""

    point: ContourPoint
    force: Floats
    """Normal force f."""
    excess: Floats
    moment: Floats
    """M_Az, on the vibrissa."""
    up: Floats
    reach: Floats
    """Height of the contact above the foot and its distance from it along x."""
    twist: Floats
    """What the slope at the clamp misses [rad]; zero in balance."""
    swing: Floats
    """Amplitude of the span: from pi on, half a period, it is one that buckles [rad]."""
    vibrissa: Vibrissa

    def at(self, which: Integers) -> "States":
        """Some of the states.

        Parameters
        ----------
        which : array of int, shape (m,)
            Their numbers.

        Returns
        -------
        States
            Of m contacts.
        """
        point = ContourPoint(*(values[which] for values in self.point))
        return States(
            point,
            self.force[which],
            self.excess[which],
            self.moment[which],
            self.up[which],
            self.reach[which],
            self.twist[which],
            self.swing[which],
            self.vibrissa,
        )

    @property
    def tangent(self) -> Booleans:
        """Phase B."""
        return self.excess < 0

    @property
    def arc_length(self) -> Floats:
        """Arc length s1 of the contact."""
        return 1 + np.minimum(self.excess, 0.0)

    @property
    def tip_angle(self) -> Floats:
        """Slope angle of the vibrissa at the contact [rad]."""
        return self.point.alpha + np.maximum(self.excess, 0.0)

    @property
    def foot_x(self) -> Floats:
        """Foot position."""
        return self.point.xi - self.reach


def states(point: ContourPoint, force: Floats, excess: Floats, vibrissa: Vibrissa) -> States:
    """The vibrissa from a contact back to its clamp.

    Parameters
    ----------
    point : ContourPoint
        Where the centreline's contour is touched; arrays of shape (n,).
    force, excess : array, shape (n,)
        Normal force, not negative, and excess.
    vibrissa : Vibrissa
        Its numbers, or arrays of shape (n,).

    Returns
    -------
    States
        Whether or not the clamp has its slope and the foot its height.
    """
    natural, compliance, mu, radius = vibrissa
    push = np.sqrt(1 + mu**2) * force
    lean = np.arctan(mu)
    direction = point.alpha + lean
    length = 1 + np.minimum(excess, 0.0)
    couple = mu * radius * force
    start = back_to_clamp(np.maximum(excess, 0.0) - lean, natural - couple, push, length)
    moment = couple + push * start.along
    sin, cos = np.sin(direction), np.cos(direction)
    sin_half, cos_half = np.sin(direction / 2), np.cos(direction / 2)
    turned = np.arctan2(
        start.p * cos_half - start.g * sin_half, start.g * cos_half + start.p * sin_half
    )
    return States(
        point,
        force,
        excess,
        moment,
        start.along * sin + start.across * cos,
        start.along * cos - start.across * sin,
        compliance * moment - 2 * turned,
        start.swing,
        vibrissa,
    )


class Rates(NamedTuple):
    """Derivatives of what a state misses and where it is, each of shape (n, 3).

    By the contour parameter t, the normal force and the excess.
    """

    twist: Floats
    above: Floats
    """Of the height of the span's end over the contour's point."""
    foot_x: Floats


def with_rates(
    point: ContourPoint, force: Floats, excess: Floats, vibrissa: Vibrissa
) -> tuple[States, Rates]:
    """`states` and their derivatives.

    The span as seen from the contact does not depend on alpha, so that the derivative by t is exact
    and one-sided at a contour's breaks; the other two are differences that do not change the phase.

    Parameters
    ----------
    point : ContourPoint
        Where the centreline's contour is touched; arrays of shape (n,).
    force, excess : array, shape (n,)
        Normal force, not negative, and excess.
    vibrissa : Vibrissa
        Its numbers.

    Returns
    -------
    States, Rates
        Of n contacts.
    """
    step_f = _DIFFERENCE * np.maximum(1.0, force)
    step_w = np.where(excess < 0, -_DIFFERENCE, _DIFFERENCE)
    found = states(
        point,
        force + step_f * _BY_FORCE[:, None],
        excess + step_w * _BY_EXCESS[:, None],
        vibrissa,
    )
    moment, up, reach, twist, swing = (values[0] for values in found[3:8])
    here = States(point, force, excess, moment, up, reach, twist, swing, vibrissa)
    sin, cos = np.sin(point.alpha), np.cos(point.alpha)
    by_t = (
        point.turning,
        point.turning * here.reach - point.stretch * sin,
        point.stretch * cos + point.turning * here.up,
    )
    rates = []
    for known, values in zip(by_t, (found.twist, found.up, -found.reach), strict=True):
        by_f, by_w = _WEIGHTS @ values
        rates.append(np.array([known, by_f / step_f, by_w / step_w]).T)
    return here, Rates(*rates)
