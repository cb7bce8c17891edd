"""Families of contours that an object may be of, by a few dimensionless numbers."""

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from analytic.from_clamp.calibration.unknowns import Family, Number
from analytic.numerics.arrays import Floats
from analytic.problem.contours.families import circle, ellipse
from analytic.problem.contours.profile import Profile, of_curve
from analytic.problem.contours.superellipse import Superellipse

_SMALLEST, _LARGEST = 1e-3, 30.0  # of a size, over L
_AWAY = 30.0  # of a place, over L
_ANGULAR, _ROUND = 8.0, 1.2  # of a superellipse's exponent: nearly a rectangle, nearly a rhombus
_KNOTS = 7  # at which a convex contour has a radius of curvature of its own; two circles need them
_GRID = 400  # intervals of slope angle, over which a convex contour is summed up
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


class _Summed(NamedTuple):
    """Coordinates summed up from a radius of curvature."""

    xi: Callable[[Floats], Floats]
    eta: Callable[[Floats], Floats]
    radius: Callable[[Floats], Floats]


def convex_between(lowest: float, highest: float) -> Family:
    """Any convex contour whose radius of curvature is, in logarithms, piecewise linear.

    Between the slope angles that are touched; beyond them it is as at the last.
    """
    knots = np.linspace(lowest, highest, _KNOTS)
    middle = float(knots[_KNOTS // 2])
    grid = np.linspace(-math.pi / 2, math.pi / 2, _GRID + 1)

    def radius(logarithms: Floats, alpha: Floats) -> Floats:
        return np.exp(np.interp(alpha, knots, logarithms))

    def profile(numbers: Floats) -> Profile:
        logarithms = numbers[2:]
        curve = partial(radius, logarithms)

        def summed(at: float, slope: Callable[[Floats], Floats]) -> CubicHermiteSpline:
            ends, halfway = (curve(x) * slope(x) for x in (grid, grid[:-1] + np.diff(grid) / 2))
            simpson = (ends[:-1] + 4 * halfway + ends[1:]) * np.diff(grid) / 6
            along = np.concatenate([[0.0], np.cumsum(simpson)])
            begin = float(CubicHermiteSpline(grid, along, ends)(middle))
            return CubicHermiteSpline(grid, along + at - begin, ends)

        x, y = summed(float(numbers[0]), np.cos), summed(float(numbers[1]), np.sin)
        return of_curve(_Summed(x, y, curve), _UPRIGHT, "convex contour")

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
