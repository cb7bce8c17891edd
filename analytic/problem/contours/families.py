"""Families of convex contours, closed forms by slope angle."""

import math
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.contours.profile import Profile, of_curve
from analytic.problem.numbers import finite, pair, positive

_UPRIGHT = math.pi / 2
_STEEPEST = _UPRIGHT - 1e-3  # the graph of a function of x never stands upright


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
    a, c = positive("profile.a", a), finite("profile.c", c)
    return of_curve(_Catenary(a, c), _STEEPEST, f"catenary cosh({a:g} x) {c:+g}")


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
    a, c = positive("profile.a", a), finite("profile.c", c)
    return of_curve(_Parabola(a, c), _STEEPEST, f"parabola {a:g} x^2 {c:+g}")


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
    radius = positive("profile.radius", radius)
    point = pair("profile.lowest", lowest)
    return _ellipse(radius, radius, *point, f"circle of radius {radius:g}")


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
    across, upward = pair("profile.semi_axes", semi_axes)
    positive("profile.semi_axes[0]", across)
    positive("profile.semi_axes[1]", upward)
    point = pair("profile.lowest", lowest)
    return _ellipse(across, upward, *point, f"ellipse {across:g} by {upward:g}")


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
    right = positive("profile.right_radius", right_radius)
    left = positive("profile.left_radius", left_radius)
    x, y = pair("profile.lowest", lowest)
    label = f"two circles of radius {left:g} and {right:g}"
    return of_curve(_TwoCircles(right, left, x, y), _UPRIGHT, label, kinks=(0.0,))


def _ellipse(across: float, upward: float, x: float, y: float, label: str) -> Profile:
    curve = _Ellipse(across, upward, x, y)
    return of_curve(curve, _UPRIGHT, f"{label}, lowest point ({x:g}, {y:g})")


class _Catenary(NamedTuple):
    a: float
    c: float

    def xi(self, alpha: Floats) -> Floats:
        return np.arcsinh(np.tan(alpha) / self.a) / self.a

    def eta(self, alpha: Floats) -> Floats:
        return np.hypot(1.0, np.tan(alpha) / self.a) + self.c

    def radius(self, alpha: Floats) -> Floats:
        cosine = np.cos(alpha)
        return 1 / (cosine * cosine * cosine * self.a * np.hypot(self.a, np.tan(alpha)))


class _Parabola(NamedTuple):
    a: float
    c: float

    def xi(self, alpha: Floats) -> Floats:
        return np.tan(alpha) / (2 * self.a)

    def eta(self, alpha: Floats) -> Floats:
        return np.tan(alpha) ** 2 / (4 * self.a) + self.c

    def radius(self, alpha: Floats) -> Floats:
        cosine = np.cos(alpha)
        return 1 / (2 * self.a * cosine * cosine * cosine)


class _Ellipse(NamedTuple):
    across: float
    upward: float
    x: float
    y: float

    def support(self, alpha: Floats) -> Floats:
        """Distance of the tangent at `alpha` from the centre."""
        return np.hypot(self.across * np.sin(alpha), self.upward * np.cos(alpha))

    def xi(self, alpha: Floats) -> Floats:
        return self.x + self.across * (self.across * np.sin(alpha) / self.support(alpha))

    def eta(self, alpha: Floats) -> Floats:
        """Y + b - b^2 cos(alpha)/h, with b - b^2 cos(alpha)/h free of cancellation at alpha = 0."""
        support = self.support(alpha)
        rise = (self.across * np.sin(alpha)) ** 2 / (support + self.upward * np.cos(alpha))
        return self.y + self.upward * rise / support

    def radius(self, alpha: Floats) -> Floats:
        support = self.support(alpha)
        return np.square(self.across / support) * np.square(self.upward / support) * support


class _TwoCircles(NamedTuple):
    right: float
    left: float
    x: float
    y: float

    def radius(self, alpha: Floats) -> Floats:
        return self.left + (self.right - self.left) * (alpha > 0).astype(float)

    def xi(self, alpha: Floats) -> Floats:
        return self.x + self.radius(alpha) * np.sin(alpha)

    def eta(self, alpha: Floats) -> Floats:
        return self.y + self.radius(alpha) * 2 * np.square(np.sin(alpha / 2))
