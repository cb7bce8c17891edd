"""Families of convex contours with closed forms by slope angle."""

import math
from functools import partial

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.contours.profile import Profile, of_family
from analytic.problem.numbers import finite, pair, positive

_STEEPEST = math.pi / 2 - 1e-3  # the graph of a function of x never stands upright


def catenary(a: float, c: float) -> Profile:
    """The catenary y = cosh(a x) + c; the paper's g1 is ``catenary(0.5, -0.8)``.

    Parameters
    ----------
    a : float
        Inverse width [1/length], positive.
    c : float
        Height of the lowest point less one unit of length [length].

    Returns
    -------
    Profile
        For slope angles up to 1e-3 rad from the vertical.

    Raises
    ------
    InputError
        If a number cannot be.
    """
    a, c = positive("profile catenary.a", a), finite("profile catenary.c", c)
    return of_family(
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

    Returns
    -------
    Profile
        For slope angles up to 1e-3 rad from the vertical.

    Raises
    ------
    InputError
        If a number cannot be.
    """
    a, c = positive("profile parabola.a", a), finite("profile parabola.c", c)
    return of_family(
        xi=partial(_parabola_xi, a),
        eta=partial(_parabola_eta, a, c),
        alpha_range=(-_STEEPEST, _STEEPEST),
        radius_of_curvature=partial(_parabola_radius, a),
        label=f"parabola {a:g} x^2 {c:+g}",
    )


def circle(radius: float, lowest: tuple[float, float]) -> Profile:
    """The lower half of a circle.

    Parameters
    ----------
    radius : float
        Its radius, positive [length].
    lowest : tuple of float
        Its lowest point (x, y) [length].

    Returns
    -------
    Profile
        For all slope angles from -pi/2 to pi/2.

    Raises
    ------
    InputError
        If a number cannot be.
    """
    radius = positive("profile circle.radius", radius)
    point = pair("profile circle.lowest", lowest)
    return _ellipse(radius, radius, point, f"circle of radius {radius:g}")


def ellipse(semi_axes: tuple[float, float], lowest: tuple[float, float]) -> Profile:
    """The lower half of an ellipse whose axes are along x and y.

    Parameters
    ----------
    semi_axes : tuple of float
        Along x and along y, positive [length].
    lowest : tuple of float
        Its lowest point (x, y) [length].

    Returns
    -------
    Profile
        For all slope angles from -pi/2 to pi/2.

    Raises
    ------
    InputError
        If a number cannot be.
    """
    across, upward = pair("profile ellipse.semi_axes", semi_axes)
    positive("profile ellipse.semi_axes[0]", across)
    positive("profile ellipse.semi_axes[1]", upward)
    point = pair("profile ellipse.lowest", lowest)
    return _ellipse(across, upward, point, f"ellipse {across:g} by {upward:g}")


def two_circles(
    right_radius: float = 2.0, left_radius: float = 0.5, lowest: tuple[float, float] = (0.0, 0.5)
) -> Profile:
    """Two circles that share their lowest point and the tangent there; by default the paper's g3.

    C1 but not C2: every reading has a kink where the contact passes the lowest point.

    Parameters
    ----------
    right_radius, left_radius : float
        Radii of the arcs on either side of the lowest point, positive [length].
    lowest : tuple of float
        The lowest point (x, y) [length].

    Returns
    -------
    Profile
        For all slope angles from -pi/2 to pi/2.

    Raises
    ------
    InputError
        If a number cannot be.
    """
    right = positive("profile two_circles.right_radius", right_radius)
    left = positive("profile two_circles.left_radius", left_radius)
    x, y = pair("profile two_circles.lowest", lowest)
    return of_family(
        xi=partial(_two_circles_xi, right, left, x),
        eta=partial(_two_circles_eta, right, left, y),
        alpha_range=(-math.pi / 2, math.pi / 2),
        radius_of_curvature=partial(_two_circles_radius, right, left),
        kinks=(0.0,),
        label=f"two circles of radius {left:g} and {right:g}",
    )


def _catenary_xi(a: float, alpha: Floats) -> Floats:
    return np.arcsinh(np.tan(alpha) / a) / a


def _catenary_eta(a: float, c: float, alpha: Floats) -> Floats:
    return np.hypot(1.0, np.tan(alpha) / a) + c


def _catenary_radius(a: float, alpha: Floats) -> Floats:
    cosine = np.cos(alpha)
    return 1 / (cosine * cosine * cosine * a * np.hypot(a, np.tan(alpha)))


def _parabola_xi(a: float, alpha: Floats) -> Floats:
    return np.tan(alpha) / (2 * a)


def _parabola_eta(a: float, c: float, alpha: Floats) -> Floats:
    return np.tan(alpha) ** 2 / (4 * a) + c


def _parabola_radius(a: float, alpha: Floats) -> Floats:
    cosine = np.cos(alpha)
    return 1 / (2 * a * cosine * cosine * cosine)


def _ellipse(across: float, upward: float, lowest: tuple[float, float], label: str) -> Profile:
    x, y = lowest
    return of_family(
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
    return x + across * (across * np.sin(alpha) / _ellipse_support(across, upward, alpha))


def _ellipse_eta(across: float, upward: float, y: float, alpha: Floats) -> Floats:
    """Y + b - b^2 cos(alpha)/h, with b - b^2 cos(alpha)/h free of cancellation near alpha = 0."""
    support = _ellipse_support(across, upward, alpha)
    rise = (across * np.sin(alpha)) ** 2 / (support + upward * np.cos(alpha))
    return y + upward * rise / support


def _ellipse_radius(across: float, upward: float, alpha: Floats) -> Floats:
    support = _ellipse_support(across, upward, alpha)
    return np.square(across / support) * np.square(upward / support) * support


def _two_circles_radius(right: float, left: float, alpha: Floats) -> Floats:
    on_right = (alpha > 0).astype(float)
    return left + (right - left) * on_right


def _two_circles_xi(right: float, left: float, x: float, alpha: Floats) -> Floats:
    return x + _two_circles_radius(right, left, alpha) * np.sin(alpha)


def _two_circles_eta(right: float, left: float, y: float, alpha: Floats) -> Floats:
    return y + _two_circles_radius(right, left, alpha) * 2 * np.square(np.sin(alpha / 2))
