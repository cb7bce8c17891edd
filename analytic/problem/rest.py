"""What the unloaded vibrissa touches first."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.roots import zero, zeros
from analytic.problem.along import Along
from analytic.problem.beam import Unloaded
from analytic.problem.clamp_path import Pose, Poses
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.errors import InputError

_SAMPLES = 513  # of the contour, between which its distance from the vibrissa has one minimum
_ROUNDING = 1e-14  # rad, of the slope of an upright side
_CONTOUR, _WAY, _VIBRISSA = 513, 513, 1025  # places that are looked at on any way
_LEVEL = 1e-3  # of the slope beyond the tip, of which a level one would have none
_EXACT = 1e-11  # L, rad; what a first contact may miss
_ASLANT = 1e-12  # rad; rounding, by which a tip may seem to come from inside


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
        remedy = "lessen it, take sweeps the other way alone, or raise the object's widest place "
        remedy += "above the tip: only its lower side can be touched"
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


def first_on_way(
    contour: Contour,
    reach: tuple[float, float],
    rest: Unloaded,
    poses: Poses,
    ends: tuple[float, float],
) -> FirstTouch | None:
    """The first contact between two parameters of a way, the first one larger; None if none is."""
    t = np.linspace(*reach, _CONTOUR)
    breaks = contour.breaks()
    t = np.unique(np.concatenate([t, breaks[(breaks > reach[0]) & (breaks < reach[1])]]))
    p = np.linspace(*ends, _WAY)
    apart, s, ahead = _apart(contour, t, rest, poses.at(p[None, :]))
    later, at_once, _ = _crossings(apart.T, s.T, ahead.T)  # the contour is cut at one pose
    if 0 in later:
        remedy = "start clear of the object, or farther away"
        raise InputError("start of the clamp's way", "across the object", "clear of it", remedy)
    i, j, share = _crossings(apart, s, ahead)  # a place of it passes the vibrissa
    # One that comes with its tip ahead cuts the contour before any place has passed it.
    passed = np.concatenate([p[j] + share * (p[j + 1] - p[j]), p[later]])
    if not passed.size:
        return None
    best = int(np.argmax(passed))
    i, j = np.concatenate([i, at_once])[best], np.concatenate([j, later])[best]
    near, at = (float(t[i]), float(passed[best])), s[i, j]
    found = [_at_tip(contour, rest, poses, *near), _along(contour, rest, poses, *near, float(at))]
    latest = near[1] + (p[1] - p[0])  # p falls; by then it touches
    here = [one for one in found if one is not None and one.p > latest]
    known = [one for one in here if reach[0] <= one.t <= reach[1]]
    if not known:
        allowed = f"such that it first touches the lower side of the object ({contour.label})"
        what = "one that comes to its upper side or its end, or to it from behind"
        remedy = "move the foot farther on under the object"
        raise InputError("way of the clamp", what, allowed, remedy)
    return max(known, key=lambda one: one.p)


def _crossings(apart: Floats, s: Floats, ahead: Booleans) -> tuple[Integers, Integers, Floats]:
    """Where, in the second index, something gets to the other side beside the vibrissa."""
    passes = (np.signbit(apart[:, 1:]) != np.signbit(apart[:, :-1])) & ahead[:, 1:] & ahead[:, :-1]
    i, j = np.nonzero(passes)
    share = apart[i, j] / (apart[i, j] - apart[i, j + 1])
    on = s[i, j] + share * (s[i, j + 1] - s[i, j]) <= 1
    return i[on], j[on], share[on]


def _apart(
    contour: Contour, t: Floats, rest: Unloaded, pose: Pose
) -> tuple[Floats, Floats, Booleans]:
    """How far places of the contour are right of the vibrissa, at which arc length; if ahead."""
    point = contour.at(t)
    x, y = pose.seen(point.xi[:, None], point.eta[:, None])
    s = np.linspace(0, 1, _VIBRISSA)
    rest_x, rest_y, slope = rest.at(s)

    def at(height: Floats) -> tuple[Floats, Floats]:
        beyond = np.maximum(height - rest_y[-1], 0.0) / max(float(np.sin(slope[-1])), _LEVEL)
        along = np.interp(height, rest_y, s) + beyond
        return along, np.interp(height, rest_y, rest_x) + beyond * np.cos(slope[-1])

    along = at(y)[0]
    thicker = np.where(along < 1, rest.taper(along), 0.0)
    leant = point.alpha[:, None] - pose.angle
    x, y = x + thicker * np.sin(leant), y - thicker * np.cos(leant)
    along, across = at(y)
    return x - across, along, y > 0


def _at_tip(
    contour: Contour, rest: Unloaded, poses: Poses, t: float, p: float
) -> FirstTouch | None:
    tip_x, tip_y, slope = rest.at(np.array(1.0))

    def missed(at: Floats) -> Floats:
        point = contour.at(at[:1])
        x, y = poses.at(at[1:]).place(tip_x, tip_y)
        return np.concatenate([x - point.xi, y - point.eta])

    found = _zero(missed, [t, p])
    if found is None:
        return None
    alpha, angle = contour.at(found[:1]).alpha, poses.at(found[1:]).angle
    excess = float((slope + angle - alpha)[0]) - rest.lean
    if excess < -_ASLANT:
        return None
    return FirstTouch(float(found[0]), max(excess, 0.0), float(found[1]))


def _along(
    contour: Contour, rest: Unloaded, poses: Poses, t: float, p: float, s: float
) -> FirstTouch | None:
    def missed(at: Floats) -> Floats:
        point, pose, length = contour.at(at[:1]), poses.at(at[1:2]), at[2:]
        rest_x, rest_y, slope = rest.at(length)
        x, y = pose.place(rest_x, rest_y)
        taper = rest.taper(length)
        return np.concatenate(
            [
                x - point.xi - taper * np.sin(point.alpha),
                y - point.eta + taper * np.cos(point.alpha),
                slope + pose.angle - point.alpha - rest.lean,
            ]
        )

    found = _zero(missed, [t, p, s])
    if found is None or not 0 < found[2] < 1:
        return None
    return FirstTouch(float(found[0]), float(found[2] - 1), float(found[1]))


def _zero(missed: Callable[[Floats], Floats], start: list[float]) -> Floats | None:
    from scipy.optimize import root  # slow to load

    with np.errstate(invalid="ignore"):
        found = root(missed, start, tol=1e-15)
    return found.x if np.abs(missed(found.x)).max() < _EXACT else None
