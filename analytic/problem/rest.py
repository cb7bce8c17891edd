"""What the unloaded vibrissa touches first."""

from typing import NamedTuple

import numpy as np

from analytic.numerics.roots import zero, zeros
from analytic.problem.along import Along
from analytic.problem.arrays import Floats, Integers
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.errors import InputError
from analytic.problem.unloaded import Unloaded

_SAMPLES = 513  # of the contour, between which its distance from the vibrissa has one minimum

_ROUNDING = 1e-14  # rad, of the slope of an upright side


class FirstTouch(NamedTuple):
    """The first contact, unloaded; dimensionless."""

    t: float  # contour parameter
    excess: float  # phi1 - alpha >= 0 at the tip, less a cone's lean; s1 - 1 < 0 elsewhere
    p: float  # parameter of the clamp's way, that of a sweep the foot position


def first_touch(contour: Contour, reach: tuple[float, float], rest: Unloaded) -> FirstTouch:
    """What the unloaded vibrissa touches first when its foot comes from the right."""
    _, tip_y, tip_angle = (float(v) for v in rest.at(np.array(1.0)))
    first = reach[1]
    lowest = float(contour.parameter(np.zeros(1))[0])

    def height(t: Floats) -> Floats:
        return contour.at(t).eta

    at_lowest, at_first = height(np.array([lowest, first])).tolist()
    if at_lowest >= tip_y:
        name = f"height of the lowest point of the object ({contour.label}), less the radius,"
        allowed = f"below {tip_y:.6g} L, the tip of the vibrissa at rest"
        raise InputError(name, f"{at_lowest:.6g} L", allowed, "lower the object or curve it less")
    top = first if at_first <= tip_y else zero(lambda t: height(t) - tip_y, lowest, first)

    def arc_length(t: Floats) -> Floats:
        return _arc_length(contour.at(t), rest)

    def lean(t: Floats) -> Floats:
        """Positive where the contour is steeper than the vibrissa beside it."""
        point = contour.at(t)
        return point.alpha + rest.lean - rest.at(_arc_length(point, rest))[2]

    grid = np.linspace(top, lowest, _SAMPLES)
    steep = lean(grid)
    at_tip = top < first or at_first >= tip_y * (1 - 1e-15)
    if not at_tip and steep[0] < -_ROUNDING:
        # Towards the motion: a sweep to the right is solved as its mirror image.
        name, what = "clamp_angle", f"{rest.angle:.6g} rad towards where the foot goes"
        if isinstance(rest.natural, Along):
            name = "shape at rest, by natural curvature, weight and clamp_angle,"
            what = f"a tip at {tip_angle:.6g} rad"
        elif rest.angle == 0:
            name, what = "beam.natural_curvature", f"{rest.natural:.6g}/L at the tip"
        allowed = f"such that it does not lean over the upper side of the object ({contour.label})"
        remedy = "lessen it, or raise the object's widest place above the tip: only its lower side "
        remedy += "can be touched"
        raise InputError(name, what, allowed, remedy)
    crossings = np.flatnonzero((steep[:-1] > 0) & (steep[1:] <= 0))
    tangents = zeros(lambda _, t: lean(t), grid[crossings + 1], grid[crossings])
    places = np.append(top, tangents)
    lengths = arc_length(places)
    lengths[0] = 1.0 if at_tip else lengths[0]
    point = contour.at(places)
    feet = point.xi + rest.taper(lengths) * np.sin(point.alpha) - rest.at(lengths)[0]
    if not at_tip and steep[0] > 0:
        feet[0] = -np.inf  # the contour's end, as far right as the corner that it is, is no tangent
    best = int(np.argmax(feet))
    excess = float(lengths[best] - 1)
    if best == 0 and at_tip:
        excess = max(tip_angle - float(point.alpha[0]) - rest.lean, 0.0)
    return FirstTouch(float(places[best]), excess, float(feet[best]))


def _arc_length(point: ContourPoint, rest: Unloaded) -> Floats:
    """Arc length at which the vibrissa at rest is as high as the contour at given points."""
    if not rest.is_arc or (rest.angle and rest.natural):

        def above(which: Integers, s: Floats) -> Floats:
            alpha, eta = point.alpha[which], point.eta[which]
            return np.asarray(rest.at(s)[1] + rest.taper(s) * np.cos(alpha) - eta)

        return zeros(above, np.zeros_like(point.eta), np.ones_like(point.eta))
    natural = rest.natural
    assert isinstance(natural, float)
    turn = np.arcsin(np.clip(natural * point.eta, -1, 1))
    return point.eta / np.cos(rest.angle) if natural == 0 else turn / natural
