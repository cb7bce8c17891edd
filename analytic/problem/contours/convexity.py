"""Whether triples (alpha, xi, eta) are a strictly convex contour at all."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.errors import InputError
from analytic.problem.numbers import LARGEST

Coordinate: TypeAlias = Callable[[Floats], Floats]

OF_ANGLES = "a function that maps an array of angles to an array of the same shape"
_COARSE = 129
_FINE = 1024  # short chords, of functions of which nothing is known
_FEW = 32  # of the families' closed forms, in which no waves can hide
_SHORT = 1e-4  # rad, of the fine chords: waves of a larger period are seen one by one
_SLACK = 1e-9  # rad
_ROUNDING = 8 * np.finfo(float).eps  # of a difference of two coordinates, relative to their size
_SEQUENCE = np.arange(1, _FINE + 1) * ((np.sqrt(5) - 1) / 2) % 1  # of the golden section
_EDGE = 1e-4  # of the size; y = x^4, the flattest point of use, moves by 1e-5 in one rounding
_HALVINGS = 50  # from the long chords down to rounding
_LEAST_SIZE = 1e-10  # of the distance from the origin; below, rounding would be seen as corners


def check_convex(
    xi: Coordinate,
    eta: Coordinate,
    alpha_range: tuple[float, float],
    radius: Coordinate | None,
    label: str,
    known: bool = False,
) -> None:
    """Compare chords, long and short, with the slope angles at their ends."""
    lowest, highest = alpha_range
    inset = 1e-6 * (highest - lowest)  # open families have their poles at +-pi/2
    low, high = lowest + inset, highest - inset
    long = np.linspace(low, high, _COARSE)
    turn = min(_SHORT, (high - low) / _COARSE)
    places = _SEQUENCE[:_FEW] if known else _SEQUENCE
    short = low + (high - low - turn) * places
    alpha = np.concatenate([long, short, short + turn])
    x, y = (_values(curve, alpha, name, label) for curve, name in ((xi, "xi"), (eta, "eta")))

    size = float(np.hypot(np.ptp(x), np.ptp(y)))
    place = float(np.hypot(x, y).max())
    if size < _LEAST_SIZE * place:
        what = f"{label}, of a size of {size:.3g} at a distance of {place:.3g} from the origin"
        allowed = f"larger than {_LEAST_SIZE:g} of that distance"
        raise InputError("profile", what, allowed, "enlarge it; a sharp corner is a polygon's")
    n = _COARSE
    _check_chords(long[:-1], long[1:], np.diff(x[:n]), np.diff(y[:n]), place, label, corners=True)
    dx, dy = (values[n + places.size :] - values[n : n + places.size] for values in (x, y))
    _check_chords(short, short + turn, dx, dy, place, label, corners=False)
    if not known:
        _check_bowed(xi, eta, long, np.hypot(np.diff(x[:n]), np.diff(y[:n])), size, label)
    if radius is not None:
        middle = short + turn / 2
        stated = _values(radius, middle, "radius_of_curvature", label)
        _check_radius(stated, middle, np.hypot(dx, dy) / (2 * np.sin(turn / 2)), place, turn, label)


def _values(curve: Coordinate, alpha: Floats, name: str, label: str) -> Floats:
    try:
        with np.errstate(all="ignore"):  # what is not finite is reported below
            values = np.asarray(curve(alpha), dtype=float)
    except (TypeError, ValueError, ArithmeticError) as error:
        remedy = f"write it with NumPy functions ({error})"
        raise InputError(f"profile.{name}", label, OF_ANGLES, remedy) from error
    if values.shape != alpha.shape:
        what = f"of {label}, mapping shape {alpha.shape} to {values.shape}"
        raise InputError(f"profile.{name}", what, OF_ANGLES, "write it with NumPy functions")
    finite = np.abs(values) < LARGEST
    if not finite.all():
        what = f"{label}, {name} not finite at alpha = {alpha[~finite][0]:.6g} rad"
        allowed = "finite over its whole alpha_range"
        raise InputError("profile", what, allowed, "narrow alpha_range or correct xi and eta")
    return values


def _check_chords(
    begin: Floats, end: Floats, dx: Floats, dy: Floats, place: float, label: str, corners: bool
) -> None:
    """Refuse the first chord whose slope is not between those at its ends, rounding allowed for."""
    length = np.hypot(dx, dy)
    slope = np.arctan2(dy, dx)
    with np.errstate(divide="ignore"):
        doubt = np.where(length > 0, _ROUNDING * place / length, np.inf)
    resolved = doubt < 0.1
    slack = np.where(resolved, _SLACK + doubt, np.inf)
    wrong = (slope < begin - slack) | (slope > end + slack)
    if wrong.any():
        i = int(np.argmax(wrong))
        ends = f"alpha = {begin[i]:.6g} and {end[i]:.6g} rad"
        what = f"{label}, whose chord between {ends} has slope angle {slope[i]:.6g} rad"
        allowed = "strictly convex, each chord's slope between those of the tangents at its ends"
        raise InputError("profile", what, allowed, "is (xi, eta) where the slope angle is alpha?")
    if corners and not resolved.all():
        i = int(np.argmin(resolved))
        ends = f"alpha = {begin[i]:.6g} and {end[i]:.6g} rad"
        what, allowed = f"{label}, which stays between {ends}", "strictly convex without corners"
        raise InputError("profile", what, allowed, "round the corner, or use a polygon")


def _check_bowed(
    xi: Coordinate, eta: Coordinate, alpha: Floats, length: Floats, size: float, label: str
) -> None:
    """Refuse a straight edge: a chord that stays long as its ends' angles come together."""
    long = length > _EDGE * size
    low, high = alpha[:-1][long], alpha[1:][long]
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        x, y = (curve(np.concatenate([low, middle, high])).reshape(3, -1) for curve in (xi, eta))
        first, second = np.hypot(np.diff(x, axis=0), np.diff(y, axis=0))
        low, high = np.where(first > second, low, middle), np.where(first > second, middle, high)
    edge = np.maximum(first, second) > _EDGE * size
    if edge.any():
        i = int(np.argmax(edge))
        ends = f"({x[0, i]:.6g}, {y[0, i]:.6g}) and ({x[2, i]:.6g}, {y[2, i]:.6g})"
        what = f"{label}, straight between {ends} at alpha = {low[i]:.6g} rad"
        allowed = "strictly convex, without straight edges"
        raise InputError("profile", what, allowed, "bow the edge; a polygon may have straight ones")


def _check_radius(
    stated: Floats, alpha: Floats, found: Floats, place: float, turn: float, label: str
) -> None:
    """Refuse a radius of curvature that is not that of the points, kinks allowed for."""
    resolved: Booleans = found * turn > 1e3 * _ROUNDING * place
    wrong = resolved & ~(np.abs(stated - found) <= 0.5 * found)
    if (stated <= 0).any() or wrong.sum() > 0.05 * len(alpha):
        i = int(np.argmax((stated <= 0) | wrong))
        what = f"{stated[i]:.6g} for {label} at alpha = {alpha[i]:.6g} rad"
        allowed = f"positive and d(arc length)/d(alpha), which is {found[i]:.6g} there"
        raise InputError("profile.radius_of_curvature", what, allowed, "correct it or leave it out")
