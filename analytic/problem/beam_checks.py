"""What a vibrissa's numbers, functions and tables must be."""

import math

import numpy as np

from analytic.problem.along import Along
from analytic.problem.errors import InputError
from analytic.problem.numbers import is_finite_number
from analytic.problem.unloaded import Unloaded

# Of the radius at the clamp; at a thousandth, the stiffness of the tip is rounding beside that of
# the clamp, and a sweep finds no equilibria for minutes.
_THINNEST = 0.0015
_PLACES = 257  # at which a vibrissa at rest is looked at


def checked_length(given: object) -> float:
    """The length of a vibrissa."""
    if not (is_finite_number(given) and given > 0):
        raise InputError(
            "beam.length", given, "positive and finite", "give it in the units of the case"
        )
    return float(given)


def checked_rigidity(given: object, length: float) -> float | Along:
    """The flexural rigidity of a vibrissa."""
    name = "beam.flexural_rigidity"
    found = Along.of(name, given, length) if _may_vary(given) else given
    if isinstance(found, Along):
        place = found.first_not_positive()
        if place is not None:
            value = float(found(np.array(place)))
            what = f"{value:g} at s = {place:g}"
            raise InputError(name, what, "positive all along", "correct it there")
        return found
    if not (is_finite_number(found) and found > 0):
        raise InputError(name, found, "positive and finite", "give it in the units of the case")
    return float(found)


def checked_radii(radius: object, tip_radius: object, length: float) -> tuple[float, float | None]:
    """The radii of a vibrissa at its clamp and at its tip."""
    if not (is_finite_number(radius) and 0 <= radius < 0.1 * length):
        raise InputError(
            "beam.radius",
            radius,
            f"finite, not negative and below a tenth of the length ({length:g})",
            "a vibrissa is slender: check the units of radius and length",
        )
    if tip_radius is None:
        return float(radius), None
    if not (is_finite_number(tip_radius) and _THINNEST * radius <= tip_radius <= radius != 0):
        raise InputError(
            "beam.tip_radius",
            tip_radius,
            f"between {_THINNEST} of the radius at the clamp ({_THINNEST * radius:g}) and all "
            f"of it ({radius:g})",
            f"the radius falls in proportion to s, and may not vanish before or at s = {length:g}",
        )
    return float(radius), float(tip_radius)


def checked_curvature(given: object, length: float) -> float | Along:
    """The natural curvature of a vibrissa."""
    name, remedy = "beam.natural_curvature", "it is an inverse length, positive to the left"
    found = Along.of(name, given, length) if _may_vary(given) else given
    if isinstance(found, Along):
        s = np.linspace(0, 1, _PLACES)[1:]
        low = Unloaded(found.times(length, 1 / length)).at(s)[1] <= 0
        if low.any():
            raise InputError(
                name,
                f"such that the vibrissa at rest is back at the foot line at s = {s[low][0]:.3g} L",
                "such that it stays above",
                remedy,
            )
        return found
    if not (is_finite_number(found) and abs(found) * length < math.pi):
        raise InputError(
            name,
            found,
            f"finite and within {math.pi / length:.6g} of zero, where the vibrissa at rest"
            " is curved back to the foot line",
            remedy,
        )
    return float(found)


def _may_vary(given: object) -> bool:
    """Whether something is given as a function or a table, not as a number."""
    return callable(given) or (hasattr(given, "__len__") and not isinstance(given, str | bytes))
