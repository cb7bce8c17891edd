"""The vibrissa: an inextensible elastic beam with a round tip, uniform or not, straight or not."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Floats
from analytic.problem.along import Along, rescaled, sampled, values_at
from analytic.problem.errors import InputError, require
from analytic.problem.numbers import LARGEST, positive, within

# Of the radius at the clamp; at a thousandth, the stiffness of the tip is rounding beside that of
# the clamp, and a sweep finds no equilibria for minutes.
_THINNEST = 0.0015
_THICKEST = 0.1  # of the length
_PLACES = 257  # at which a vibrissa that is curved at rest is looked at
_MOST_CURVED = math.pi * (1 - 1e-12)  # 1/L; an arc of more is back at the foot line

Varying: TypeAlias = float | Callable[[Floats], Floats] | Sequence[tuple[float, float]] | Along
"""A number, a function of arc length, or pairs (arc length, value) from clamp to tip."""


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


def checked_rigidity(given: object, length: float, of_cone: bool) -> float | Along:
    """The flexural rigidity of a vibrissa; of a cone only a number follows its radius."""
    name = "beam.flexural_rigidity"
    found = Along.of(name, given, length) if _may_vary(given) else given
    if not isinstance(found, Along):
        value = positive(name, found)
        return Along((0.0, length), ((value,),)) if of_cone and _may_vary(given) else value
    place = found.first_not_positive()
    if place is not None:
        value = float(found(np.array(place)))
        raise InputError(name, f"{value:g} at s = {place:g}", "positive all along")
    return found


def checked_radii(radius: object, tip_radius: object, length: float) -> tuple[float, float | None]:
    remedy = "a vibrissa is slender: check the units of radius and length"
    base = within("beam.radius", radius, 0.0, math.nextafter(_THICKEST * length, 0), remedy)
    if tip_radius is None:
        return base, None
    remedy = "it may not vanish, and is at least 0.0015 of the radius at the clamp"
    least = max(_THINNEST * base, 1 / LARGEST)
    return base, within("beam.tip_radius", tip_radius, least, base, remedy)


def checked_curvature(given: object, length: float) -> float | Along:
    name, remedy = "beam.natural_curvature", "beyond, it is curved back to the foot line"
    found = Along.of(name, given, length) if _may_vary(given) else given
    if not isinstance(found, Along):
        return within(name, found, -_MOST_CURVED / length, _MOST_CURVED / length, remedy)
    s = np.linspace(0, 1, _PLACES)[1:]
    low = Unloaded(found.times(length, 1 / length)).at(s)[1] <= 0
    if low.any():
        what = f"such that the vibrissa at rest is back at the foot line at s = {s[low][0]:.3g} L"
        raise InputError(name, what, "such that it stays above", remedy)
    return found


def _may_vary(given: object) -> bool:
    return callable(given) or (hasattr(given, "__len__") and not isinstance(given, str | bytes))


@dataclass(frozen=True)
class Beam:
    """A technical vibrissa, in any consistent units.

    Parameters
    ----------
    length : float
        Length L from the clamp to the centre of the round tip [length].
    flexural_rigidity : float, or function or table of arc length
        Flexural rigidity EI [force length^2]. A function maps an array of arc lengths from the
        clamp, 0 to `length`, to an array of the same shape; it may have a few kinks and jumps. A
        table has pairs (arc length, value), the first at 0 and the last at `length`; between them
        monotone cubics interpolate (PCHIP). The beam keeps either as an `Along`.
    radius : float
        Radius of the cross-section and of the tip [length]; 0 is the paper's thin vibrissa, which
        only the analytic side can handle.
    tip_radius : float, optional
        Of a cone: radius at the tip, at least 0.0015 of that at the clamp, which is `radius`;
        between, it is linear [length]. If the flexural rigidity is a number, it is that at the
        clamp, and the rest follows the fourth power of the radius; else it is as given. An object
        is touched by the cone's surface: at arc length s its contour feels a sphere of the radius
        there about the axis.
    natural_curvature : float, or function or table of arc length
        Of the vibrissa at rest [1/length], given like the flexural rigidity: an arc from the
        upright clamp if it is a number, positive to the left of its way from clamp to tip; 0 is the
        paper's straight vibrissa.
    si : bool
        Whether these numbers, and all that belong to them, are known to be in metres and newtons,
        as those of a case whose quantities have units. Only reports and pictures use it: they
        name the units then.

    Raises
    ------
    InputError
        If a value is not finite, length or rigidity is somewhere not positive, the units of force
        and moment that follow are out of range, the radius is negative or not small against the
        length, the tip's is not positive or larger, or the vibrissa at rest is curved back to the
        foot line.
    """

    length: float = 1.0
    flexural_rigidity: Varying = 1.0
    radius: float = 0.005
    natural_curvature: Varying = field(default=0.0, kw_only=True)
    tip_radius: float | None = field(default=None, kw_only=True)
    si: bool = field(default=False, kw_only=True, compare=False, repr=False)

    def __post_init__(self) -> None:
        length = positive("beam.length", self.length)
        radius, tip_radius = checked_radii(self.radius, self.tip_radius, length)
        cone = tip_radius not in (None, radius)
        for name, value in (
            ("length", length),
            ("flexural_rigidity", checked_rigidity(self.flexural_rigidity, length, cone)),
            ("radius", radius),
            ("tip_radius", tip_radius),
            ("natural_curvature", checked_curvature(self.natural_curvature, length)),
        ):
            object.__setattr__(self, name, value)
        require("beam.si", self.si, bool, "leave it out")
        if not self._has_units():
            what = f"{self.base_rigidity:g} with a length of {self.length:g}"
            allowed = f"such that EI/L^2 and EI/L are {1 / LARGEST:g} to {LARGEST:g}"
            raise InputError("beam.flexural_rigidity", what, allowed, "choose other units")

    @property
    def force_unit(self) -> float:
        """EI/L^2, in which the dimensionless solution counts forces [force]."""
        return self.base_rigidity / self.length**2

    @property
    def moment_unit(self) -> float:
        """EI/L, in which the dimensionless solution counts moments [force length]."""
        return self.base_rigidity / self.length

    @property
    def varies(self) -> bool:
        """Whether flexural rigidity, radius or natural curvature vary along the vibrissa."""
        given = self.flexural_rigidity, self.natural_curvature
        return any(isinstance(value, Along) for value in given) or self._is_cone

    @property
    def breaks(self) -> Floats:
        """Arc lengths between which what varies along the vibrissa is smooth [length]."""
        given = (self.flexural_rigidity, self.natural_curvature)
        return np.unique([end for v in given if isinstance(v, Along) for end in v.ends[1:-1]])

    @cached_property
    def base_rigidity(self) -> float:
        """Flexural rigidity at the clamp [force length^2]."""
        return float(values_at(self._rigidity, np.zeros(1))[0])

    @cached_property
    def unloaded(self) -> Unloaded:
        """Shape and radius at rest, dimensionless."""
        length = self.length
        curvature = rescaled(self._natural, length, 1 / length)
        return Unloaded(curvature, self.radius / length, self._tip_radius / length)

    def rigidity_at(self, s: ArrayLike) -> Floats:
        """Flexural rigidity EI.

        Parameters
        ----------
        s : array_like, any shape
            Arc length from the clamp, 0 to `length` [length].

        Returns
        -------
        array, shape of `s`
            [force length^2].
        """
        rigidity = values_at(self._rigidity, np.asarray(s, dtype=float))
        if self._is_cone and not isinstance(self._rigidity, Along):
            rigidity *= (self.radius_at(s) / self.radius) ** 4
        return rigidity

    def curvature_at(self, s: ArrayLike) -> Floats:
        """Natural curvature.

        Parameters
        ----------
        s : array_like, any shape
            Arc length from the clamp, 0 to `length` [length].

        Returns
        -------
        array, shape of `s`
            Positive to the left of the way from clamp to tip [1/length].
        """
        return values_at(self._natural, np.asarray(s, dtype=float))

    def radius_at(self, s: ArrayLike) -> Floats:
        """Radius of the cross-section.

        Parameters
        ----------
        s : array_like, any shape
            Arc length from the clamp, 0 to `length` [length].

        Returns
        -------
        array, shape of `s`
            [length].
        """
        s = np.asarray(s, dtype=float)
        return self.radius + (self._tip_radius - self.radius) * s / self.length

    def scaled(self, length: float = 1.0, rigidity: float = 1.0) -> "Beam":
        """The vibrissa with another length or flexural rigidity.

        Parameters
        ----------
        length, rigidity : float
            By which they are multiplied. What varies along the vibrissa is stretched with it.

        Returns
        -------
        Beam
            As it is else.
        """
        return replace(
            self,
            length=self.length * length,
            flexural_rigidity=rescaled(self._rigidity, rigidity, length),
            natural_curvature=rescaled(self._natural, 1, length),
        )

    def mirrored(self) -> "Beam":
        """The mirror image, x to -x.

        Returns
        -------
        Beam
            Curved the other way at rest.
        """
        if self._natural == 0:
            return self
        return replace(self, natural_curvature=rescaled(self._natural, -1))

    @property
    def _is_cone(self) -> bool:
        return self.tip_radius not in (None, self.radius)

    @property
    def _tip_radius(self) -> float:
        return self.radius if self.tip_radius is None else self.tip_radius

    @property
    def _rigidity(self) -> float | Along:
        return cast("float | Along", self.flexural_rigidity)  # since __post_init__

    @property
    def _natural(self) -> float | Along:
        return cast("float | Along", self.natural_curvature)

    def _has_units(self) -> bool:
        try:
            units = self.force_unit, self.moment_unit
            return min(units) >= 1 / LARGEST and max(units) <= LARGEST
        except (OverflowError, ZeroDivisionError):
            return False
