"""States at rest of a vibrissa with friction, an elastic clamp and a natural curvature.

Dimensionless throughout, on the contour that the centreline feels. Both phases are one family: the
excess w is s1 - 1 in Phase B, where it is negative, and phi1 - alpha in Phase A, where it is
positive, so that the phases take turns where it vanishes. A vibrissa that is curved towards the
object may turn on until it lies down on its other side, phi(s1) = alpha + pi: from w = pi on, s1 is
1 - (w - pi). A cone that touches a contour leans by
the angle from its surface to its axis: w is phi1 - alpha less that, in Phase B phi(s1) is alpha
and that, and the other side begins twice that earlier. With the normal force f, Coulomb friction
mu and slope angle alpha of the contour the force on the vibrissa is F = f sqrt(1 + mu^2) at the
slope angle phi_F = alpha + arctan(mu): a dead force again. It acts on the surface, so that the
couple -mu r f remains at the contact. Of a heavy vibrissa the end beyond a contact of Phase B hangs
(`analytic.problem.rod`), and its moment remains there, too.
"""

from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.along import Along
from analytic.problem.beam import Beam, Unloaded
from analytic.problem.case import Case
from analytic.problem.contours.contour import ContourPoint
from analytic.problem.rod import AtRest, Hung, RodProperties, at_rest, hang
from analytic.problem.support import Support
from analytic.solver.general.span import Start, back_by_collocation, back_to_clamp

# Differences of second order, to one side: a force is not negative, and a phase ends where w = 0.
_DIFFERENCE = 1e-5  # of a force and an excess of their size: truncation and round-off are alike
_BY_FORCE = np.array([0.0, 1.0, 2.0, 0.0, 0.0])
_BY_EXCESS = np.array([0.0, 0.0, 0.0, 1.0, 2.0])
_ASIDE = 1e-5  # rad; to both sides, by which a heavy vibrissa is turned with its contact
_BOTH_SIDES = np.array([[1.0], [-1.0]])
FORCES = slice(1, -1, 3)  # the places of the forces among the numbers of a state on a way
INSIDE = -5e-324  # an excess of nothing, in Phase B
_WEIGHTS = np.array([[-1.5, 2.0, -0.5, 0.0, 0.0], [-1.5, 0.0, 0.0, 2.0, -0.5]])


class Vibrissa(NamedTuple):
    """What the vibrissa and its contact are beyond the paper's, dimensionless."""

    # of the unloaded vibrissa; positive to the left of its way from clamp to tip [1/L].
    natural_curvature: float = 0.0
    compliance: float = 0.0  # rotation of the clamp by moment [L/EI]
    # coefficient, or one a state; positive where the object pushes the vibrissa to the right.
    friction: float | Floats = 0.0
    radius: float | Floats = 0.0  # at the tip, or one a state [L]
    # what varies along the vibrissa, or its weight, if there is any; the natural curvature is then
    # its.
    rod: RodProperties | None = None
    # by which its clamp leans to the left of the upright, or one a state [rad].
    clamp_angle: float | Floats = 0.0

    @classmethod
    def of(cls, beam: Beam, held: Support) -> "Vibrissa":
        rest = held.unloaded(beam)
        return cls(
            0.0 if isinstance(rest.natural, Along) else rest.natural,
            beam.moment_unit / held.clamp_stiffness,
            held.friction,
            rest.tip_radius,
            RodProperties.of(beam, rest, held.weight) if beam.varies or any(held.weight) else None,
            held.clamp_angle,
        )

    @classmethod
    def of_case(cls, case: Case) -> "Vibrissa":
        return cls.of(case.beam, case.support)

    @property
    def is_plain(self) -> bool:
        """Whether it is the paper's: straight, uniform, upright in a rigid clamp, not rubbed."""
        held = self.natural_curvature == self.compliance == 0 and not np.any(self.clamp_angle)
        return self.rod is None and held and not np.any(self.friction)

    @property
    def weight(self) -> tuple[float, float]:
        return (0.0, 0.0) if self.rod is None else self.rod.weight

    @property
    def at_rest(self) -> AtRest:
        if self.rod is None or not any(self.weight):
            return AtRest(self.unloaded, 0.0, stands=True)
        return at_rest(self.rod, self.compliance)

    def hung(self, slope: Floats, s: Floats) -> Hung | None:
        """Its ends beyond places of some slope, shape (n,), if it has a weight."""
        return hang(self.rod, slope, s) if self.rod is not None and any(self.weight) else None

    def moment_beyond(self, slope: Floats, s: Floats) -> Floats | None:
        """That of the end beyond places of some slope, if it has a weight."""
        if self.rod is None or not any(self.weight):
            return None
        slope, s = np.broadcast_arrays(slope, s)
        found, held = np.zeros(s.shape), np.isfinite(slope) & (s < 1)
        if held.any():
            found[held] = hang(self.rod, slope[held], s[held]).base
        return found

    @property
    def unloaded(self) -> Unloaded:
        if self.rod is not None:
            return self.rod.unloaded
        radius = float(self.radius)
        return Unloaded(self.natural_curvature, radius, radius, float(self.clamp_angle))

    def turn_after(self, s: Floats) -> Floats | float:
        """By how much it turns without weight on the way from a place to its tip [rad]."""
        if self.rod is not None:
            return self.rod.unloaded.turn_between(s, 1.0)
        return self.natural_curvature * (1 - s) if self.natural_curvature else 0.0

    def radius_at(self, s: Floats) -> Floats | float:
        return self.radius if self.rod is None else self.radius + self.rod.unloaded.taper(s)

    @property
    def least_force(self) -> float:
        """The force that counts as large: it turns the tip by half a radian, nearly."""
        return 1.0 if self.rod is None else self.rod.least_force

    def sizes(self, z: Floats) -> Floats:
        """The sizes of a state's numbers: 1, but for the forces, which have their own."""
        sizes = np.ones_like(z)
        sizes[..., FORCES] = np.maximum(self.least_force, z[..., FORCES])
        return sizes

    @property
    def lean(self) -> float:
        """Angle from the surface of a cone to its axis [rad]."""
        return 0.0 if self.rod is None else self.rod.unloaded.lean

    @property
    def most_turned(self) -> float:
        """Excess of a tip that lies on its other side; beyond it that side touches [rad]."""
        return np.pi - 2 * self.lean

    def side(self, excess: Floats) -> Integers:
        """What touches: -1 the front, 0 the tip, 1 the back."""
        return np.where(excess < 0, -1, np.where(excess > self.most_turned, 1, 0))

    def within(self, side: Integers, excess: Floats) -> Floats:
        """The excess, or the nearest one of a contact on that side."""
        low, high = self.limits
        return np.asarray(np.clip(excess, low[side + 1], high[side + 1]))

    @property
    def limits(self) -> tuple[Floats, Floats]:
        """The least and the largest excess of a contact at the front, the tip and the back."""
        most = self.most_turned
        return (
            np.array([-np.inf, 0.0, np.nextafter(most, np.inf)]),
            np.array([INSIDE, most, np.inf]),
        )

    def arc_length(self, excess: Floats) -> Floats:
        return 1 + np.minimum(excess, 0.0) - np.maximum(excess - self.most_turned, 0.0)

    def turned(self, excess: Floats) -> Floats:
        """Slope angle of its surface at the contact, from the contour's [rad]."""
        return np.asarray(np.clip(excess, 0.0, self.most_turned))

    def back_to_clamp(
        self, slope: Floats, couple: Floats, force: Floats, length: Floats, direction: Floats
    ) -> Start:
        if self.rod is None:
            return back_to_clamp(slope, self.natural_curvature - couple, force, length)
        return back_by_collocation(self.rod, slope, -couple, force, length, direction)

    def scaled(self, share: float) -> "Vibrissa":
        """The vibrissa a part of the way from the paper's to this one, its radius as it is."""
        return Vibrissa(
            share * self.natural_curvature,
            share * self.compliance,
            share * self.friction,
            self.radius,
            None if self.rod is None else self.rod.scaled(share),
            share * self.clamp_angle,
        )


class InnerContact(NamedTuple):
    """The contact nearer to the clamp; arrays of shape (n,)."""

    point: ContourPoint  # of the contour that the centreline feels
    force: Floats  # normal force
    apart: Floats  # arc length from here to the outer contact [L]
    missed: tuple[Floats, Floats, Floats]  # by the slope angle [rad] and the place along x and y


class States(NamedTuple):
    """Vibrissae against points of the contour, in balance or not; arrays of shape (n,)."""

    point: ContourPoint  # of the contour that the centreline feels at the tip
    force: Floats  # normal force f
    excess: Floats
    moment: Floats  # M_Az, on the vibrissa
    up: Floats
    reach: Floats  # height of the contact above the foot and its distance from it along x
    angle: Floats  # by which a clamp leans to the left that would hold it [rad]
    # amplitude of the span: from pi on, half a period, it is one that buckles [rad].
    amplitude: Floats
    vibrissa: Vibrissa
    inner: InnerContact | None = None  # where it touches a second time, nearer to the clamp

    @property
    def tangent(self) -> Booleans:
        """Phase B."""
        return np.asarray(self.side != 0)

    @property
    def side(self) -> Integers:
        return self.vibrissa.side(self.excess)

    @property
    def arc_length(self) -> Floats:
        return self.vibrissa.arc_length(self.excess)

    @property
    def tip_angle(self) -> Floats:
        """Slope angle of the vibrissa at the contact [rad]."""
        leant, lean = self.point.alpha + self.vibrissa.turned(self.excess), self.vibrissa.lean
        return leant + lean if lean else leant

    @property
    def last_angle(self) -> Floats:
        """Slope angle of the tip, which is the contact or beyond it [rad]."""
        hung = self.vibrissa.hung(self.tip_angle, self.arc_length)
        if hung is not None:
            return hung.slope[:, -1]
        return np.asarray(self.tip_angle + self.vibrissa.turn_after(self.arc_length))

    @property
    def end_curvature(self) -> Floats:
        """Curvature just beyond the contact, positive to the left."""
        slope, s, vibrissa = self.tip_angle, self.arc_length, self.vibrissa
        natural, beyond = vibrissa.unloaded.curvature(s), vibrissa.moment_beyond(slope, s)
        if beyond is None or vibrissa.rod is None:
            return natural
        return np.asarray(natural + beyond * vibrissa.rod.flexibility(s))

    @property
    def couple(self) -> Floats:
        """Couple of the friction on the surface about the axis."""
        return self.vibrissa.friction * self.vibrissa.radius_at(self.arc_length) * self.force

    @property
    def foot_x(self) -> Floats:
        return self.offset_point.xi - self.reach

    @property
    def slope_residual(self) -> Floats:
        """What the clamp's angle misses [rad]; zero in balance."""
        return self.angle - self.vibrissa.clamp_angle

    @property
    def height_residual(self) -> Floats:
        """Height of the span's end over the contour, from a foot at y = 0; zero in balance."""
        return self.up - self.offset_point.eta

    @property
    def offset_point(self) -> ContourPoint:
        """The place of the centreline, on the contour that it feels there."""
        if self.vibrissa.rod is None:
            return self.point
        point, taper = self.point, self.vibrissa.rod.unloaded.taper(self.arc_length)
        return ContourPoint(
            point.alpha,
            point.xi + taper * np.sin(point.alpha),
            point.eta - taper * np.cos(point.alpha),
            point.turning,
            point.stretch + taper * point.turning,
        )


def states(point: ContourPoint, force: Floats, excess: Floats, vibrissa: Vibrissa) -> States:
    """The vibrissa from a contact back to its clamp."""
    mu = vibrissa.friction
    push = np.sqrt(1 + mu**2) * force
    lean = np.arctan(mu)
    direction = point.alpha + lean
    length = vibrissa.arc_length(excess)
    couple = mu * vibrissa.radius_at(length) * force
    slope = vibrissa.turned(excess) + (vibrissa.lean - lean)
    beyond = vibrissa.moment_beyond(slope + direction, length)
    if beyond is None:
        start = vibrissa.back_to_clamp(slope, couple, push, length, direction)
        moment = couple + push * start.along
    else:
        start = vibrissa.back_to_clamp(slope, couple - beyond, push, length, direction)
        moment = -start.kappa
    reach, up = start.way(direction)
    angle = vibrissa.compliance * moment - 2 * start.angle_from(direction / 2)
    return States(point, force, excess, moment, up, reach, angle, start.amplitude, vibrissa)


def with_rates(
    point: ContourPoint, force: Floats, excess: Floats, vibrissa: Vibrissa
) -> tuple[States, Floats]:
    """`states`, and the derivatives of residuals and foot by t, force and excess, (n, 3, 3)."""
    step_f = _DIFFERENCE * np.maximum(vibrissa.least_force, force)
    most = vibrissa.most_turned
    falls = (excess < 0) | ((excess > most / 2) & (excess <= most))
    step_w = np.where(falls, -_DIFFERENCE, _DIFFERENCE)
    found = states(
        point,
        force + step_f * _BY_FORCE[:, None],
        excess + step_w * _BY_EXCESS[:, None],
        vibrissa,
    )
    moment, up, reach, angle, amplitude = (values[0] for values in found[3:8])
    here = States(point, force, excess, moment, up, reach, angle, amplitude, vibrissa)
    stretch = here.offset_point.stretch
    sin, cos = np.sin(point.alpha), np.cos(point.alpha)
    by_alpha = 1.0, here.reach, here.up
    if any(vibrissa.weight):
        aside = point._replace(alpha=point.alpha + _ASIDE * _BOTH_SIDES)
        there = states(aside, force, excess, vibrissa)
        of_end = there.angle, there.up, -there.reach
        by_alpha = tuple((right - left) / (2 * _ASIDE) for right, left in of_end)
    by_t = (
        point.turning * by_alpha[0],
        point.turning * by_alpha[1] - stretch * sin,
        stretch * cos + point.turning * by_alpha[2],
    )
    up, reach = found.up, found.reach
    if vibrissa.rod is not None:  # where a cone is touched decides how thick it is
        offset_point = found.offset_point
        up = up - (offset_point.eta - point.eta)
        reach = reach - (offset_point.xi - point.xi)
    changes = _WEIGHTS @ np.array([found.angle, up, -reach])
    by_force, by_excess = changes[:, 0] / step_f, changes[:, 1] / step_w
    return here, np.stack([np.stack(by_t, axis=1), by_force.T, by_excess.T], axis=2)
