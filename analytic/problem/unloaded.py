"""The unloaded vibrissa: its shape at rest and its radius, dimensionless."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from analytic.problem.along import Along, sampled, values_at
from analytic.problem.arrays import Floats

_PLACES = 257  # at which the slope of one of varying curvature is looked at


@dataclass(frozen=True)
class Unloaded:
    """Shape and radius of a vibrissa at rest; arc lengths in units of its length."""

    # Natural curvature, positive to the left of the way from clamp to tip [1/L].
    natural: float | Along = 0.0
    base_radius: float = 0.0  # of the cross-section at the clamp and at the tip, linear between [L]
    tip_radius: float = 0.0  # of the cross-section at the clamp and at the tip, linear between [L]
    angle: float = 0.0  # by which its clamp leans to the left of the upright [rad]

    @property
    def lean(self) -> float:
        """Angle from the contour's tangent to the axis of a cone that touches it [rad]."""
        return float(np.arcsin(self.base_radius - self.tip_radius))

    @cached_property
    def most_turned(self) -> float:
        """The largest angle by which it turns from the upright, to either side [rad]."""
        if not isinstance(self.natural, Along):
            return max(abs(self.angle), abs(self.angle + self.natural))
        s = np.linspace(0, 1, _PLACES)
        return float(np.abs(self.at(s)[2] - np.pi / 2).max())

    @property
    def is_arc(self) -> bool:
        """Whether curvature and radius are constant."""
        return not isinstance(self.natural, Along) and self.base_radius == self.tip_radius

    def curvature(self, s: Floats) -> Floats:
        return values_at(self.natural, s)

    def taper(self, s: Floats) -> Floats:
        """By how much the radius exceeds that of the tip."""
        return (self.base_radius - self.tip_radius) * (1 - s)

    def at(self, s: Floats) -> tuple[Floats, Floats, Floats]:
        """Places on the axis, as seen from the foot, and the slope angle there."""
        x, y, slope = self._upright(s)
        if self.angle == 0:
            return x, y, slope
        sin, cos = np.sin(self.angle), np.cos(self.angle)
        return x * cos - y * sin, x * sin + y * cos, slope + self.angle

    def _upright(self, s: Floats) -> tuple[Floats, Floats, Floats]:
        natural = self.natural
        if isinstance(natural, Along):
            x, y, turn = self._integrals
            return x(s), y(s), np.pi / 2 + turn(s)
        turned = natural * s
        half = np.sinc(turned / 2 / np.pi)  # sin(u/2)/(u/2)
        chord = s * half
        return -chord * np.sin(turned / 2), chord * np.cos(turned / 2), np.pi / 2 + turned

    def turn_between(self, begin: Floats, end: float) -> Floats:
        if isinstance(self.natural, Along):
            turn = self._integrals[2]
            return turn(np.array(end)) - turn(begin)
        return self.natural * (end - begin)

    def side(self, begin: Floats) -> Floats:
        """Length of the side that touches an object, from a place to the tip."""
        left, narrowing = 1 - begin, self.base_radius - self.tip_radius
        turn = self.turn_between(begin, 1.0)
        # The radius times the curvature, integrated by parts: the radius is linear.
        if isinstance(self.natural, Along):
            slope = self._integrals[2]
            mean = slope.integral()
            turned = slope(np.array(1.0)) * left - (mean(np.array(1.0)) - mean(begin))
        else:
            turned = turn * left / 2
        shorter = (self.tip_radius + self.taper(begin)) * turn - narrowing * turned
        return np.asarray(np.cos(self.lean) * left - shorter)

    @cached_property
    def _integrals(self) -> tuple[Along, Along, Along]:
        assert isinstance(self.natural, Along)
        turn = self.natural.integral()
        name, kinks = "the vibrissa at rest", turn.ends[1:-1]
        x = sampled(name, lambda s: -np.sin(turn(s)), 1.0, kinks)
        y = sampled(name, lambda s: np.cos(turn(s)), 1.0, kinks)
        return x.integral(), y.integral(), turn
