"""What the unloaded vibrissa touches first on any way of its clamp."""

from collections.abc import Callable

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.poses import Pose, Poses
from analytic.problem.rest import FirstTouch
from analytic.problem.unloaded import Unloaded

_CONTOUR, _WAY, _VIBRISSA = 513, 513, 1025  # places at which they are looked at
_LEVEL = 1e-3  # of the slope beyond the tip, of which a level one would have none
_EXACT = 1e-11  # L, rad; what a first contact may miss
_ROUNDING = 1e-12


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
    touching = ahead & (s <= 1)
    left, right = (touching[:, 0] & (sign * apart[:, 0] < 0) for sign in (1, -1))
    if left.any() and right.any():
        remedy = "it starts clear of the object, or farther away"
        raise InputError("start of the clamp's way", "across the object", "clear of it", remedy)
    passes = (np.signbit(apart[:, 1:]) != np.signbit(apart[:, :-1])) & ahead[:, 1:] & ahead[:, :-1]
    i, j = np.nonzero(passes)
    share = apart[i, j] / (apart[i, j] - apart[i, j + 1])
    on = s[i, j] + share * (s[i, j + 1] - s[i, j]) <= 1
    if not on.any():
        return None
    i, j, share = i[on], j[on], share[on]
    passed = p[j] + share * (p[j + 1] - p[j])
    best = int(np.argmax(passed))
    near = float(t[i[best]]), float(passed[best])
    at = s[i[best], j[best]]
    found = [_at_tip(contour, rest, poses, *near), _along(contour, rest, poses, *near, float(at))]
    known = [one for one in found if one is not None and reach[0] <= one.t <= reach[1]]
    if not known:
        allowed = f"such that it first touches the lower side of the object ({contour.label})"
        what = "one on which the vibrissa does not"
        raise InputError("way of the clamp", what, allowed, "turn it")
    return max(known, key=lambda one: one.p)


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
    if excess < -_ROUNDING:
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
