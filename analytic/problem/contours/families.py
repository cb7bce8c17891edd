"""Families of convex contours with closed forms by slope angle."""

import math
from functools import partial

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.contours.profile import Profile
from analytic.problem.errors import InputError

_STEEPEST = math.pi / 2 - 1e-3  # the graph of a function of x never stands upright


def catenary(a: float, c: float) -> Profile:
    """The catenary y = cosh(a x) + c; the paper's g1 is ``catenary(0.5, -0.8)``.

    Parameters
    ----------
    a : float
        Inverse width [1/length], positive.
    c : float
        Height of the lowest point less one unit of length [length].
    """
    _positive("catenary.a", a)
    _finite("catenary.c", c)
    return Profile(
        xi=partial(_catenary_xi, a),
        eta=partial(_catenary_eta, a, c),
        alpha_range=(-_STEEPEST, _STEEPEST),
        radius_of_curvature=partial(_catenary_radius, a),
        label=f"catenary cosh({a:g} x) {c:+g}",
    )


def parabola(a: float, c: float) -> Profile:
    """The parabola y = a x^2 + c; the paper's g2 is ``parabola(0.5, 0.5)``.

    Parameters
    ----------
    a : float
        Half the curvature at the lowest point [1/length], positive.
    c : float
        Height of the lowest point [length].
    """
    _positive("parabola.a", a)
    _finite("parabola.c", c)
    return Profile(
        xi=partial(_parabola_xi, a),
        eta=partial(_parabola_eta, a, c),
        alpha_range=(-_STEEPEST, _STEEPEST),
        radius_of_curvature=partial(_parabola_radius, a),
        label=f"parabola {a:g} x^2 {c:+g}",
    )


def circle(radius: float, lowest: tuple[float, float]) -> Profile:
    """The lower half of a circle of `radius` [length] with its lowest point at `lowest`."""
    _positive("circle.radius", radius)
    return _ellipse(radius, radius, lowest, f"circle of radius {radius:g}")


def ellipse(semi_axes: tuple[float, float], lowest: tuple[float, float]) -> Profile:
    """The lower half of an ellipse with `semi_axes` (along x, along y) [length].

    `lowest` is its lowest point.
    """
    across, upward = semi_axes
    _positive("ellipse.semi_axes[0]", across)
    _positive("ellipse.semi_axes[1]", upward)
    return _ellipse(across, upward, lowest, f"ellipse {across:g} by {upward:g}")


def two_circles(
    right_radius: float = 2.0, left_radius: float = 0.5, lowest: tuple[float, float] = (0.0, 0.5)
) -> Profile:
    """Two circles that share their lowest point and the tangent there; by default the paper's g3.

    C1 but not C2: every reading has a kink where the contact passes the lowest point.
    """
    _positive("two_circles.right_radius", right_radius)
    _positive("two_circles.left_radius", left_radius)
    x, y = _point("two_circles.lowest", lowest)
    return Profile(
        xi=partial(_two_circles_xi, right_radius, left_radius, x),
        eta=partial(_two_circles_eta, right_radius, left_radius, y),
        alpha_range=(-math.pi / 2, math.pi / 2),
        radius_of_curvature=partial(_two_circles_radius, right_radius, left_radius),
        kinks=(0.0,),
        label=f"two circles of radius {left_radius:g} and {right_radius:g}",
    )


def _catenary_xi(a: float, alpha: Floats) -> Floats:
    return np.arcsinh(np.tan(alpha) / a) / a


def _catenary_eta(a: float, c: float, alpha: Floats) -> Floats:
    return np.hypot(1.0, np.tan(alpha) / a) + c


def _catenary_radius(a: float, alpha: Floats) -> Floats:
    return 1 / (np.cos(alpha) ** 3 * a**2 * np.hypot(1.0, np.tan(alpha) / a))


def _parabola_xi(a: float, alpha: Floats) -> Floats:
    return np.tan(alpha) / (2 * a)


def _parabola_eta(a: float, c: float, alpha: Floats) -> Floats:
    return np.tan(alpha) ** 2 / (4 * a) + c


def _parabola_radius(a: float, alpha: Floats) -> Floats:
    return 1 / (2 * a * np.cos(alpha) ** 3)


def _ellipse(across: float, upward: float, lowest: tuple[float, float], label: str) -> Profile:
    x, y = _point("lowest", lowest)
    return Profile(
        xi=partial(_ellipse_xi, across, upward, x),
        eta=partial(_ellipse_eta, across, upward, y),
        alpha_range=(-math.pi / 2, math.pi / 2),
        radius_of_curvature=partial(_ellipse_radius, across, upward),
        label=f"{label}, lowest point ({x:g}, {y:g})",
    )


def _ellipse_support(across: float, upward: float, alpha: Floats) -> Floats:
    """Distance of the tangent at `alpha` from the centre."""
    return np.hypot(across * np.sin(alpha), upward * np.cos(alpha))


def _ellipse_xi(across: float, upward: float, x: float, alpha: Floats) -> Floats:
    return x + across**2 * np.sin(alpha) / _ellipse_support(across, upward, alpha)


def _ellipse_eta(across: float, upward: float, y: float, alpha: Floats) -> Floats:
    """Y + b - b^2 cos(alpha)/h, with b - b^2 cos(alpha)/h free of cancellation near alpha = 0."""
    support = _ellipse_support(across, upward, alpha)
    rise = (across * np.sin(alpha)) ** 2 / (support + upward * np.cos(alpha))
    return y + upward * rise / support


def _ellipse_radius(across: float, upward: float, alpha: Floats) -> Floats:
    return (across * upward) ** 2 / _ellipse_support(across, upward, alpha) ** 3


def _two_circles_radius(right: float, left: float, alpha: Floats) -> Floats:
    on_right = (alpha > 0).astype(float)
    return left + (right - left) * on_right


def _two_circles_xi(right: float, left: float, x: float, alpha: Floats) -> Floats:
    return x + _two_circles_radius(right, left, alpha) * np.sin(alpha)


def _two_circles_eta(right: float, left: float, y: float, alpha: Floats) -> Floats:
    return y + _two_circles_radius(right, left, alpha) * 2 * np.square(np.sin(alpha / 2))


def _positive(name: str, value: float) -> None:
    if not (math.isfinite(value) and value > 0):
        raise InputError(f"profile {name}", value, "positive and finite", "turn or mend the number")


def _finite(name: str, value: float) -> None:
    if not math.isfinite(value):
        raise InputError(f"profile {name}", value, "finite", "mend the number")


def _point(name: str, point: tuple[float, float]) -> tuple[float, float]:
    x, y = point
    if not (math.isfinite(x) and math.isfinite(y)):
        raise InputError(f"profile {name}", point, "two finite coordinates", "mend the numbers")
    return float(x), float(y)
