"""Where a sweep along x can touch, starts and stops: by geometry alone, or as it is stated.

Lengths in L, on the contour that the centreline feels.
"""

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.numerics.roots import smooth_zeros
from analytic.problem.clamp_path import Direction, Sweep
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.numbers import within

FARTHEST = 1e4  # L, from the origin: positions are then good to 2e-12 L
_LOOKED_AT = 65  # places at a time, between which the least foot position is then sought
_AS_CLOSE = 1e-12  # of a contour's parameter: of a foot position, where the contour has a corner
_SHARES = np.linspace(0, 1, 33)  # of the way from the lowest point to either end
_BESIDE = np.array([0, -1, 1, -2, 2, -3, 3, -4, 4])  # roundings off a place that is interpolated
_WIDEST = 1e3  # L; a wider object turns by less than 1e-3 rad while the vibrissa passes

MARGIN = 0.01  # L; the default sweep starts and ends this far beyond reach
_SHORTEST = 1e-9  # L, of the sweep: stations must differ by more than rounding


def contact_range(contour: Contour) -> tuple[float, float]:
    """The contour parameters between which the contour lies within reach, eta <= 1."""
    low, high = contour.t_range
    bottom = float(contour.parameter(np.array([0.0]))[0])
    t = bottom + np.array([[low - bottom], [high - bottom]]) * _SHARES
    t[:, -1] = low, high
    eta = contour.place(t.ravel())[1].reshape(t.shape)
    lowest = float(eta[0, 0])
    name = f"height of the lowest point of the object ({contour.label}), less the beam's radius,"
    if lowest <= 0:
        raise InputError(name, f"{lowest:.6g} L", "above the foot line, y = 0", "raise the object")
    if lowest >= 1:
        remedy = "lower the object or lengthen the vibrissa"
        raise InputError(name, f"{lowest:.6g} L", "below 1 L, the tip of the vibrissa", remedy)
    ends = _height_one(t, eta, contour)
    _check_place(contour, ends)
    return ends


def out_of_reach(contour: Contour, last: float, first: float) -> float:
    """The foot position, left of the contour, from which all of it is farther away than 1."""
    low, high = last, first
    close = max(_AS_CLOSE, 8 * float(np.spacing(max(abs(low), abs(high)))))
    while True:
        t = np.linspace(low, high, _LOOKED_AT)
        xi, eta = contour.place(t)
        foot = xi - np.sqrt(np.maximum(0.0, 1 - eta * eta))
        best = int(np.argmin(foot))
        low, high = t[max(best - 1, 0)], t[min(best + 1, _LOOKED_AT - 1)]
        if high - low <= close:
            return float(foot[best])


def _check_place(contour: Contour, ends: tuple[float, float]) -> None:
    left, right = contour.place(np.array(ends))[0].tolist()
    if right - left > _WIDEST:
        name = f"width of the object within reach ({contour.label})"
        remedy = "the vibrissa feels a straight wall: check the units, or cut a part out"
        raise InputError(name, f"{right - left:.6g} L", f"at most {_WIDEST:g} L", remedy)
    if not max(abs(left), abs(right)) <= FARTHEST:
        what = f"x from {left:.6g} L to {right:.6g} L"
        allowed = f"within {FARTHEST:g} L of the origin"
        remedy = "move the origin to the object, or check the units of object and beam"
        raise InputError(f"place of the object ({contour.label})", what, allowed, remedy)


def _height_one(t: Floats, eta: Floats, contour: Contour) -> tuple[float, float]:
    """Where the contour passes the height 1 on both sides of its lowest point, or its ends."""
    ends = t[:, -1].copy()
    sides = np.flatnonzero(eta[:, -1] > 1)
    if sides.size:
        past = np.argmax(eta[sides] >= 1, axis=1)
        (inner, lower), (outer, higher) = (
            (t[sides, place], eta[sides, place]) for place in (past - 1, past)
        )
        likely = inner + (outer - inner) * ((1 - lower) / (higher - lower))
        found = smooth_zeros(
            lambda _, at: contour.place(at)[1] - 1,
            np.minimum(inner, outer),
            np.maximum(inner, outer),
            likely,
        )
        # Of the numbers next to it the one that is nearest to that height, or else it itself.
        near = found[:, None] + np.spacing(found)[:, None] * _BESIDE
        missed = np.abs(contour.place(near.ravel())[1] - 1).reshape(near.shape)
        ends[sides] = near[np.arange(sides.size), np.argmin(missed, axis=1)]
    return float(ends[0]), float(ends[1])


def sign_of(way: Direction) -> int:
    """That of the foot's motion along x."""
    return 1 if way == "right" else -1


def check_ends(sweep: Sweep, start: float, touch: float, length: float) -> None:
    """Refuse a sweep that does not start clear of the object, or does not go on from there."""
    farthest = 2 * FARTHEST * length
    for name in ("start", "stop"):  # by default they are in order, and the stop is not needed
        value = getattr(sweep, name)
        if value is not None:
            within(f"sweep.{name}", value, -farthest, farthest, "check its unit")
    sign, more = sign_of(sweep.direction), sweep.direction == "right"
    if sign * start > sign * touch:
        allowed = f"at {'most' if more else 'least'} {touch:.6g}, where the tip first touches"
        remedy = "a sweep starts clear of the object"
        raise InputError("sweep.start", sweep.start, allowed, remedy)
    if sweep.stop is not None and not sign * (sweep.stop - start) > _SHORTEST * length:
        allowed = f"{'more' if more else 'less'} than the start, {start:.6g}"
        remedy = f"the foot moves to the {sweep.direction} (sweep.direction)"
        raise InputError("sweep.stop", sweep.stop, allowed, remedy)
