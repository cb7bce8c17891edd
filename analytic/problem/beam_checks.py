"""What a vibrissa's numbers, functions and tables must be."""

import math

import numpy as np

from analytic.problem.along import Along
from analytic.problem.errors import InputError
from analytic.problem.numbers import LARGEST, positive, within
from analytic.problem.unloaded import Unloaded

# Of the radius at the clamp; at a thousandth, the stiffness of the tip is rounding beside that of
# the clamp, and a sweep finds no equilibria for minutes.
_THINNEST = 0.0015
_THICKEST = 0.1  # of the length
_PLACES = 257  # at which a vibrissa at rest is looked at
_MOST_CURVED = math.pi * (1 - 1e-12)  # 1/L; an arc of more is back at the foot line


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
