"""Phase A: how far the tip has turned that rests on a contour point of given slope and height."""

from typing import NamedTuple

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
_STEPS = 3  # of Halley's method, before those that need more of them are enclosed
_CLOSE = 1e-5  # of a step of third order, relative: the next one would change round-off only

_LEAST = 1e-40  # of the sag: less is rounding, but the square root of this one is not zero
_ROUNDING = float(np.finfo(float).eps)  # of the height [L]


def greatest_height(alpha: Floats) -> Floats:
    """Height of the tip whose excess rotation is zero: contour points above are out of reach."""
    m = _m(alpha)
    return np.where(alpha < 0, np.cos(alpha) * (2 * ellipe(m) / ellipk(m) - 1), 1.0)


def tangent_height(alpha: Floats) -> Floats:
    """Height of the tip in tangential contact: contour points below are touched by the side."""
    tangential = tangent_span(alpha)
    return frame(tangential, alpha).up / tangential.q


def within_reach(alpha: Floats, eta: Floats) -> Booleans:
    """Whether a vibrissa can rest against contour points."""
    return np.asarray((eta < greatest_height(alpha)) & (np.abs(alpha) < np.pi / 2))


def tip_state(alpha: Floats, eta: Floats, lowest: Floats | None = None) -> tuple[Floats, Span]:
    """The vibrissa whose tip touches at slope `alpha` and height `eta`, by Halley's method."""
    # In p = sqrt(sin(w/2)) the height is smooth even where the clamp moment vanishes.
    top = greatest_height(alpha)
    # Against an upright side the vibrissa is straight and carries no load.
    active = ((eta < top) & (np.abs(alpha) < np.pi / 2)).nonzero()[0]
    found = np.full((4, alpha.size), np.nan)
    if active.size:
        alpha, sag = alpha[active], np.sqrt(np.maximum(1 - eta[active], 0.0))
        # A little beyond tangential contact, where nothing is singular: a root there stays inside.
        high = np.sqrt(np.sin((np.pi / 2 - np.abs(alpha)) / 2)) * (1 + 1e-6)
        lowest = tangent_height(alpha) if lowest is None else lowest[active]
        p = _start(alpha, sag, np.sqrt(1 - top[active]), np.sqrt(1 - lowest), high)
        found[:, active] = _turned(alpha, sag, p, high)
    return found[0], Span(*found[1:])


def _turned(alpha: Floats, sag: Floats, p: Floats, high: Floats) -> Floats:
    """Excess and integrals, shape (4, n), of tips that have sunk by the square of `sag`."""
    start = p
    with np.errstate(all="ignore"):  # hardly bent: no step
        for _ in range(_STEPS):
            tried = _tried(p, alpha)
            step = _halley(p, tried, sag)[1]
            new = p - step
            # After a small enough step the next would change round-off only. That is not done to
            # one because another needs it: what a tip is does not depend on the others.
            close = np.abs(step) <= _CLOSE * new
            if close.all():
                break
            p = np.where(close, p, new)
        found: Floats = tried.turned_to(new)
    poor = (~(close & (new <= high))).nonzero()[0]
    if poor.size:
        found[:, poor] = _enclosed(alpha[poor], sag[poor], start[poor], high[poor])
    return found


def _enclosed(alpha: Floats, sag: Floats, p: Floats, high: Floats) -> Floats:
    """What `_turned` has, by the same steps, but halves of a bracket where one leaves it."""
    found, left, low = np.empty((4, p.size)), np.arange(p.size), np.zeros_like(p)
    for last in range(_MAX_ITERATIONS, 0, -1):
        with np.errstate(divide="ignore", invalid="ignore"):  # hardly bent: no step, but a half
            tried = _tried(p, alpha)
            deviation, step = _halley(p, tried, sag)
        low = np.where(deviation < 0, p, low)
        high = np.where(deviation > 0, p, high)
        new = p - step
        inside = (new >= low) & (new <= high)
        # Where the height agrees to a rounding it is done: hardly bent, steps would go to and fro.
        agrees = np.abs(deviation) * np.abs(deviation + 2 * sag) <= _ROUNDING
        new = np.where(inside, new, np.where(agrees, p, (low + high) / 2))
        done = agrees | (np.abs(new - p) <= np.where(inside, _CLOSE, 1e-15) * new) | (last == 1)
        found[:, left] = tried.turned_to(new)
        left = left[~done]
        if not left.size:
            break
        p, low, high, alpha, sag = (x[~done] for x in (new, low, high, alpha, sag))
    return found


def _start(alpha: Floats, sag: Floats, first: Floats, last: Floats, high: Floats) -> Floats:
    """Where to begin, within 10 % of p, given the largest p: the sag is nearly quadratic."""
    slope = np.zeros_like(alpha)
    bent = (alpha < 0).nonzero()[0]
    slope[bent] = first[bent] / (2 * ellipk(_m(alpha[bent])) * np.sqrt(-np.sin(alpha[bent])))
    square = np.maximum((last - first - slope * high) / (high * high), 0.0)
    way = np.maximum(sag - first, _LEAST)
    p: Floats = 2 * way / (slope + np.sqrt(slope * slope + 4 * square * way))
    return np.minimum(p, high / (1 + 1e-6))


def _m(alpha: Floats) -> Floats:
    """k^2 where the clamp moment vanishes; 0 where it never does."""
    return np.sin(np.minimum(alpha, 0.0) / 2) ** 2


class _Tried(NamedTuple):
    """Tips of some rotation, with the integrals and how they change by it."""

    excess: Floats
    loaded: Span
    by_excess: Span
    twice: Span
    up: tuple[Floats, Floats, Floats]  # height times sqrt(f), and its derivatives

    def turned_to(self, p: Floats) -> Floats:
        """Excess and integrals, shape (4, n), a step of third order away."""
        excess = 2 * np.arcsin(p * p)
        turned = excess - self.excess
        found = [excess]
        for x, x_w, x_ww in zip(self.loaded, self.by_excess, self.twice, strict=True):
            found.append(x + turned * (x_w + turned / 2 * x_ww))
        return np.array(found)


def _tried(p: Floats, alpha: Floats) -> _Tried:
    w = 2 * np.arcsin(p * p)
    loaded = span(w, alpha)
    by_w = span_by_excess(loaded, w, alpha)
    twice = span_by_excess_twice(loaded, by_w, w, alpha)
    sine, cosine = np.sin(alpha), np.cos(alpha)
    up, up_w, up_ww = (s.C * sine + s.S * cosine for s in (loaded, by_w, twice))
    return _Tried(w, loaded, by_w, twice, (up, up_w, up_ww))


def _halley(p: Floats, tried: _Tried, sag: Floats) -> tuple[Floats, Floats]:
    """How much farther the tip has sunk than `sag`, as a root, and Halley's step of p."""
    square = p * p
    cosine = np.sqrt(1 - square * square)  # of w/2
    q, q_w, q_ww = tried.loaded.q, tried.by_excess.q, tried.twice.q
    up, up_w, up_ww = tried.up
    height = up / q
    fall = (height * q_w - up_w) / q
    fall_w = (height * q_ww - 2 * fall * q_w - up_ww) / q
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
