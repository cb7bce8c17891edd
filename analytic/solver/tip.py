"""Phase A: how far the tip has turned that rests on a contour point of given slope and height."""

import numpy as np
from scipy.special import ellipe, ellipk

from analytic.problem.arrays import Booleans, Floats
from analytic.solver.elastica import (
    Span,
    frame,
    span,
    span_by_excess,
    span_by_excess_twice,
    tangent_span,
)

_MAX_ITERATIONS = 60  # bisection alone would halve the bracket to round-off in 53
_CLOSE = 1e-5  # of a step of third order, relative: the next one would change round-off only

_ROUNDING = float(np.finfo(float).eps)  # of the height [L]


def tip_height(excess: Floats, alpha: Floats) -> Floats:
    """Height of a loaded tip above the foot line.

    Parameters
    ----------
    excess, alpha : array, shape (n,)
        Excess rotation of the tip and slope angle of the contour there [rad].

    Returns
    -------
    array, shape (n,)
        [L]
    """
    loaded = span(excess, alpha)
    return frame(loaded, alpha).up / loaded.q


def greatest_height(alpha: Floats) -> Floats:
    """Height of the tip whose excess rotation is zero: contour points above are out of reach.

    For alpha >= 0 the vibrissa is straight then; for alpha < 0 its clamp carries no moment, and the
    integrals are complete ones.

    Parameters
    ----------
    alpha : array, shape (n,)
        Slope angle of the contour [rad].

    Returns
    -------
    array, shape (n,)
        [L]
    """
    m = _m(alpha)
    return np.where(alpha < 0, np.cos(alpha) * (2 * ellipe(m) / ellipk(m) - 1), 1.0)


def tangent_height(alpha: Floats) -> Floats:
    """Height of the tip in tangential contact: contour points below are touched by the side.

    Parameters
    ----------
    alpha : array, shape (n,)
        Slope angle of the contour [rad].

    Returns
    -------
    array, shape (n,)
        [L]
    """
    tangential = tangent_span(alpha)
    return frame(tangential, alpha).up / tangential.q


def has_tip_state(alpha: Floats, eta: Floats) -> Booleans:
    """Whether a tip can rest on contour points that are not below tangential contact.

    Parameters
    ----------
    alpha, eta : array, shape (n,)
        Slope angle [rad] and height of the contour points.

    Returns
    -------
    array of bool, shape (n,)
        False where no vibrissa that bends one way ends there.
    """
    return np.asarray((eta < greatest_height(alpha)) & (np.abs(alpha) < np.pi / 2))


def tip_excess(alpha: Floats, eta: Floats, lowest: Floats | None = None) -> Floats:
    """Excess rotation w of the tip of a vibrissa that touches at slope `alpha` and height `eta`.

    The height falls steadily as the tip turns, from `greatest_height` to tangential contact, and
    sqrt(1 - height) is nearly proportional to the rotation (0.516 u at alpha > 0, 0.5 u at
    alpha = 0): Halley's method on it needs two steps, and a bracket keeps it safe. Its unknown is
    p = sqrt(sin(w/2)), in which the height is smooth even where the clamp moment vanishes.

    Parameters
    ----------
    alpha, eta : array, shape (n,)
        Slope angle [rad] and height of the contour points, not below tangential contact.
    lowest : array, shape (n,), optional
        `tangent_height`, where it is known.

    Returns
    -------
    array, shape (n,)
        [rad]; NaN where the point is out of reach: no vibrissa that bends one way ends there.
    """
    excess = np.full_like(alpha, np.nan)
    # Against an upright side the vibrissa is straight and carries no load.
    top = greatest_height(alpha)
    active = np.flatnonzero((eta < top) & (np.abs(alpha) < np.pi / 2))
    alpha, sag = alpha[active], np.sqrt(np.maximum(1 - eta[active], 0.0))
    lowest = tangent_height(alpha) if lowest is None else lowest[active]
    p, high = _start(alpha, sag, np.sqrt(1 - top[active]), np.sqrt(1 - lowest))
    low = np.zeros_like(alpha)
    for _ in range(_MAX_ITERATIONS):
        if active.size == 0:
            return excess
        with np.errstate(divide="ignore", invalid="ignore"):  # hardly bent: no step, but a half
            deviation, step = _halley(p, alpha, sag)
        low = np.where(deviation < 0, p, low)
        high = np.where(deviation > 0, p, high)
        new = p - step
        inside = (new >= low) & (new <= high)
        # Where the height agrees to a rounding it is done: hardly bent, steps would go to and fro.
        agrees = np.abs(deviation) * np.abs(deviation + 2 * sag) <= _ROUNDING
        new = np.where(inside, new, np.where(agrees, p, (low + high) / 2))
        # After a small enough step the next would change round-off only; halving goes on.
        done = agrees | (np.abs(new - p) <= np.where(inside, _CLOSE, 1e-15) * new)
        p = new
        if done.any():
            excess[active[done]] = 2 * np.arcsin(p[done] ** 2)
            going = ~done
            active, p, low, high = active[going], p[going], low[going], high[going]
            alpha, sag = alpha[going], sag[going]
    excess[active] = 2 * np.arcsin(p**2)  # halved to rounding
    return excess


def _start(alpha: Floats, sag: Floats, first: Floats, last: Floats) -> tuple[Floats, Floats]:
    """Where to begin, within 10 % of p, and the largest p.

    The sag is taken for a quadratic function of p: from `first`, where the clamp moment vanishes,
    with its slope there, first/(q sqrt(-sin(alpha))) for alpha < 0 and 0 else, to `last`, in
    tangential contact.
    """
    high = np.sqrt(np.sin((np.pi / 2 - np.abs(alpha)) / 2))
    slope = np.zeros_like(alpha)
    bent = np.flatnonzero(alpha < 0)
    slope[bent] = first[bent] / (2 * ellipk(_m(alpha[bent])) * np.sqrt(-np.sin(alpha[bent])))
    square = np.maximum((last - first - slope * high) / (high * high), 0.0)
    way = np.maximum(sag - first, 1e-300)
    p = 2 * way / (slope + np.sqrt(slope * slope + 4 * square * way))
    # A little beyond tangential contact, where nothing is singular: a root there stays inside.
    return np.minimum(p, high), high * (1 + 1e-6)


def _m(alpha: Floats) -> Floats:
    """k^2 where the clamp moment vanishes; 0 where it never does."""
    return np.sin(np.minimum(alpha, 0.0) / 2) ** 2


def _halley(p: Floats, alpha: Floats, sag: Floats) -> tuple[Floats, Floats]:
    """How much farther the tip has sunk than `sag`, as a root, and Halley's step of p."""
    square = p * p
    cosine = np.sqrt(1 - square * square)  # of w/2
    w = 2 * np.arcsin(square)
    loaded = span(w, alpha)
    by_w = span_by_excess(loaded, w, alpha)
    by_w_twice = span_by_excess_twice(loaded, by_w, w, alpha)
    sine, cosine_alpha = np.sin(alpha), np.cos(alpha)

    def up(s: Span) -> Floats:
        return s.C * sine + s.S * cosine_alpha

    height = up(loaded) / loaded.q
    fall = (height * by_w.q - up(by_w)) / loaded.q
    fall_w = (height * by_w_twice.q - 2 * fall * by_w.q - up(by_w_twice)) / loaded.q
    reached = np.sqrt(np.maximum(1 - height, 0.0))
    # By w, the root's slope is fall/(2 reached); w by p is 4 p/cosine.
    slope = fall / (2 * reached)
    curvature = (fall_w / 2 - slope * slope) / reached
    w_p = 4 * p / cosine
    w_pp = (4 + 8 * square * square / (cosine * cosine)) / cosine
    slope_p, curvature_p = slope * w_p, curvature * w_p * w_p + slope * w_pp
    deviation = reached - sag
    newton = deviation / slope_p
    return deviation, newton / (1 - newton * curvature_p / (2 * slope_p))
