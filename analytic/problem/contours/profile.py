"""A strictly convex contour, as triples (alpha, xi, eta) by slope angle: are they one at all?"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol, TypeAlias

import numpy as np

from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.errors import InputError
from analytic.problem.numbers import LARGEST, pair, positive

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

# Steps of the differences: truncation goes with their 6th power, round-off with their inverse.
_STEPS = 5e-3 / 4.0 ** np.arange(4)  # rad
_STENCIL = np.arange(-3.0, 4.0)  # in steps
_TO_POWERS = np.linalg.inv(np.vander(_STENCIL, increasing=True))


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


@dataclass(frozen=True)
class Profile(Contour):
    """A strictly convex C1 contour seen from below, parametrised by its slope angle alpha.

    Beyond its range of slope angles the contour is a corner: the body ends there, and the vibrissa
    turns about the end point before it slides off.

    Parameters
    ----------
    xi, eta : callable
        Coordinates of the contour point with slope angle ``alpha`` [length]; each maps an array of
        angles [rad] to an array of the same shape.
    alpha_range : tuple of float
        Smallest and largest slope angle of the contour [rad], within [-pi/2, pi/2].
    radius_of_curvature : callable, optional
        d(arc length)/d(alpha) [length]; by sixth-order differences of `xi` and `eta` if not given.
    label : str
        What reports call the profile.
    kinks : tuple of float
        Slope angles within the range at which the radius of curvature jumps [rad].

    Raises
    ------
    InputError
        If the range is empty, a function is none of arrays, or the triples do not describe a convex
        contour: the chord between two contour points must have a slope angle between the tangents
        there.
    """

    xi: Coordinate = field(repr=False)
    eta: Coordinate = field(repr=False)
    alpha_range: tuple[float, float]
    radius_of_curvature: Coordinate | None = field(default=None, repr=False)
    label: str = "custom profile"
    kinks: tuple[float, ...] = field(default=(), repr=False)
    # That of the parallel curve from what the functions say, which goes round corners, too [length]
    distance: float = field(default=0.0, init=False, repr=False)

    def __post_init__(self) -> None:
        for name in ("xi", "eta", "radius_of_curvature"):
            curve = getattr(self, name)
            if not (callable(curve) or (curve is None and name == "radius_of_curvature")):
                raise InputError(
                    f"profile.{name}", curve, OF_ANGLES, "write it with NumPy functions"
                )
        lowest, highest = pair("profile.alpha_range", self.alpha_range)
        if not -np.pi / 2 <= lowest < highest <= np.pi / 2:
            allowed = "two angles, the smaller first, within [-pi/2, pi/2] rad"
            remedy = "they grow with x along the lower side of a convex body"
            raise InputError("profile.alpha_range", self.alpha_range, allowed, remedy)
        check_convex(self.xi, self.eta, self.alpha_range, self.radius_of_curvature, self.label)

    @property
    def t_range(self) -> tuple[float, float]:
        return (-np.pi / 2, np.pi / 2)

    def at(self, t: Floats) -> ContourPoint:
        t = np.asarray(t, dtype=float)
        on = self._on(t)
        stretch = np.where(t == on, self._stretch(on), 0.0) + self.distance
        return ContourPoint(t, *self._place(on, t), np.ones(t.shape), stretch)

    def place(self, t: Floats) -> tuple[Floats, Floats]:
        return self._place(self._on(t), t)

    def _place(self, on: Floats, t: Floats) -> tuple[Floats, Floats]:
        xi, eta = self.xi(on), self.eta(on)
        if isinstance(self.distance, float) and self.distance == 0:
            return xi, eta
        return xi + self.distance * np.sin(t), eta - self.distance * np.cos(t)

    def parameter(self, alpha: Floats) -> Floats:
        return alpha

    def breaks(self) -> Floats:
        """The ends of the range of slope angles, where they are corners, and the kinks between."""
        ends = [end for end in self.alpha_range if abs(end) < np.pi / 2]
        return np.unique([*ends, *self.kinks])

    def outline(self, begin: float, end: float, points: int) -> Floats:
        """Vertices at equal steps of slope angle: equal steps of the facets' normals."""
        if self.distance == 0:
            low, high = self.alpha_range
            begin, end = max(begin, low), min(end, high)
        return np.column_stack(self.place(np.linspace(begin, end, points)))

    def offset(self, radius: float) -> "Profile":
        if radius == 0:
            return self
        positive("radius of the parallel curve", radius)
        return self._changed(distance=self.distance + radius)

    def scaled(self, factor: float) -> "Profile":
        if positive("profile.scale", factor) == 1:
            return self
        return self._changed(
            xi=partial(_scaled, self.xi, factor),
            eta=partial(_scaled, self.eta, factor),
            radius_of_curvature=partial(_scaled, self._stretch, factor),
            distance=factor * self.distance,
        )

    def raised(self, height: float) -> "Profile":
        return self._changed(
            eta=partial(_raised, self.eta, height),
            radius_of_curvature=self._stretch,
        )

    def mirrored(self) -> "Profile":
        low, high = self.alpha_range
        return self._changed(
            xi=partial(_mirrored, self.xi, -1),
            eta=partial(_mirrored, self.eta, 1),
            alpha_range=(-high, -low),
            radius_of_curvature=partial(_mirrored, self._stretch, 1),
            kinks=tuple(-kink for kink in reversed(self.kinks)),
            label=f"{self.label}, mirrored",
        )

    def _changed(self, **parts: object) -> "Profile":
        """With other parts, made of those of a checked contour: they are not checked again."""
        return unchecked(**self.__dict__ | parts)

    def _on(self, alpha: Floats) -> Floats:
        low, high = self.alpha_range
        return np.minimum(np.maximum(alpha, low), high)

    def _stretch(self, alpha: Floats) -> Floats:
        if self.radius_of_curvature is not None:
            return self.radius_of_curvature(alpha)
        return np.cos(alpha) * self._slope(self.xi, alpha) + np.sin(alpha) * self._slope(
            self.eta, alpha
        )

    def _slope(self, curve: Coordinate, alpha: Floats) -> Floats:
        """Derivative of `curve`, from polynomials through seven points within the range."""
        lowest, highest = self.alpha_range
        h = np.minimum(_STEPS, (highest - lowest) / 12 * (_STEPS / _STEPS[0]))[:, None]
        centre = np.minimum(np.maximum(alpha, lowest + 3 * h), highest - 3 * h)
        at = centre[:, None] + _STENCIL[:, None] * h[:, None]
        values = np.reshape(curve(np.clip(at, lowest, highest).ravel()), at.shape)
        powers = np.einsum("kj,sjn->skn", _TO_POWERS, values)
        order = np.arange(1.0, 7.0)[:, None]
        aside = ((alpha - centre) / h)[:, None]
        slopes = (order * aside ** (order - 1) * powers[:, 1:]).sum(axis=1) / h
        best = np.argmin(np.abs(np.diff(slopes, axis=0)), axis=0)
        return np.asarray(np.take_along_axis(slopes, best[None], axis=0)[0])


class Curve(Protocol):
    """A closed form by slope angle that is known to be convex."""

    def xi(self, alpha: Floats) -> Floats:
        """Coordinates along x."""

    def eta(self, alpha: Floats) -> Floats:
        """Coordinates along y."""

    def radius(self, alpha: Floats) -> Floats:
        """Radii of curvature."""


def of_curve(curve: Curve, steepest: float, label: str, kinks: tuple[float, ...] = ()) -> Profile:
    """A contour up to a slope angle on either side, not searched for waves."""
    xi, eta, radius, ends = curve.xi, curve.eta, curve.radius, (-steepest, steepest)
    check_convex(xi, eta, ends, radius, label, known=True)
    return unchecked(
        xi=xi, eta=eta, alpha_range=ends, radius_of_curvature=radius, label=label, kinks=kinks
    )


def unchecked(**parts: object) -> Profile:
    """A contour of parts that are known to be right, or of arrays that stand for numbers."""
    found = object.__new__(Profile)
    found.__dict__.update(parts)
    return found


def _scaled(curve: Coordinate, factor: float, alpha: Floats) -> Floats:
    return factor * curve(alpha)


def _raised(curve: Coordinate, height: float, alpha: Floats) -> Floats:
    return curve(alpha) + height


def _mirrored(curve: Coordinate, sign: int, alpha: Floats) -> Floats:
    return sign * curve(-alpha)
