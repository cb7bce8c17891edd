"""Families of contours that an object may be of, by a few dimensionless numbers."""

import math
from collections.abc import Sequence

import numpy as np

from analytic.from_clamp.calibration.unknowns import Family, Number
from analytic.numerics.arrays import Complexes, Floats, Integers
from analytic.problem.contours.families import circle, ellipse
from analytic.problem.contours.profile import Profile, of_curve
from analytic.problem.contours.superellipse import Superellipse

_SMALLEST, _LARGEST = 1e-3, 30.0  # of a size, over L
_AWAY = 30.0  # of a place, over L
_ANGULAR, _ROUND = 8.0, 1.2  # of a superellipse's exponent: nearly a rectangle, nearly a rhombus
_KNOTS = 7  # at which a convex contour has a radius of curvature of its own; two circles need them
_UPRIGHT = math.pi / 2


_X, _Y = (Number(f"centre_{axis}", -_AWAY, _AWAY) for axis in "xy")


def _size(name: str) -> Number:
    return Number(name, _SMALLEST, _LARGEST)


def _circle(numbers: Floats) -> Profile:
    radius, x, y = numbers.tolist()
    return circle(radius, (x, y - radius))


def _ellipse(numbers: Floats) -> Profile:
    across, upward, x, y = numbers.tolist()
    return ellipse((across, upward), (x, y - upward))


def _superellipse(numbers: Floats) -> Superellipse:
    return Superellipse(*numbers.tolist())


class _Bowed:
    """A contour whose radius of curvature is, in logarithms, piecewise linear: its points, summed.

    Where log r = a + b alpha, the integral of r exp(i alpha) is r exp(i alpha)/(b + i).
    """

    def __init__(self, knots: Floats, logarithms: Floats, middle: complex) -> None:
        self._knots, self._logarithms = knots, logarithms
        self._rates = np.concatenate([[0.0], np.diff(logarithms) / np.diff(knots), [0.0]])
        before, behind = (self._integral(knots, np.arange(_KNOTS) + i) for i in (0, 1))
        self._starts = np.concatenate([[0.0], np.cumsum(before - behind)])
        self._starts += middle - self._place(knots[_KNOTS // 2])

    def radius(self, alpha: Floats) -> Floats:
        return np.exp(np.interp(alpha, self._knots, self._logarithms))

    def xi(self, alpha: Floats) -> Floats:
        return self._place(alpha).real

    def eta(self, alpha: Floats) -> Floats:
        return self._place(alpha).imag

    def _place(self, alpha: Floats) -> Complexes:
        between = np.searchsorted(self._knots, alpha)
        return np.asarray(self._integral(alpha, between) + self._starts[between])

    def _integral(self, alpha: Floats, between: Integers) -> Complexes:
        return np.asarray(self.radius(alpha) * np.exp(1j * alpha) / (self._rates[between] + 1j))


def convex_between(lowest: float, highest: float) -> Family:
    """Any convex contour whose radius of curvature is, in logarithms, piecewise linear.

    Between the slope angles that are touched; beyond them it is as at the last.
    """
    knots = np.linspace(lowest, highest, _KNOTS)
    middle = float(knots[_KNOTS // 2])

    def profile(numbers: Floats) -> Profile:
        return of_curve(
            _Bowed(knots, numbers[2:], complex(*numbers[:2])), _UPRIGHT, "convex contour"
        )

    def start(simpler: Floats) -> Floats:
        known = _ellipse(simpler) if len(simpler) > 3 else _circle(simpler)
        at = np.array([middle])
        assert known.radius_of_curvature is not None
        return np.concatenate(
            [known.xi(at), known.eta(at), np.log(known.radius_of_curvature(knots))]
        )

    low, high = math.log(_SMALLEST), math.log(_LARGEST)
    degrees = [f"log_radius_at_{angle:.0f}_degrees" for angle in np.rad2deg(knots)]
    kinds = (
        Number(f"x_at_{math.degrees(middle):.0f}_degrees", -_AWAY, _AWAY),
        Number(f"y_at_{math.degrees(middle):.0f}_degrees", -_AWAY, _AWAY),
        *(Number(name, low, high, possible=(True, True)) for name in degrees),
    )
    return Family("convex", kinds, profile, start, ("circle", "ellipse"))


def families(slope_angles: Floats) -> dict[str, Family]:
    """All families, each after the one that it starts from."""
    both = (_size("semi_axis_x"), _size("semi_axis_y"), _X, _Y)
    exponent = Number("exponent", _ROUND, _ANGULAR)
    low, high = np.quantile(slope_angles, [0.05, 0.95]).tolist()
    found: Sequence[Family] = (
        Family("circle", (_size("radius"), _X, _Y), _circle, np.asarray),
        Family("ellipse", both, _ellipse, lambda one: one[[0, 0, 1, 2]], ("circle",)),
        Family(
            "superellipse",
            (*both, exponent),
            _superellipse,
            lambda one: np.append(one, 2.0),
            ("ellipse",),
        ),
        convex_between(low, high),
    )
    return {family.name: family for family in found}
