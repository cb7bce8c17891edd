"""Both contact phases at points of the contour the centreline feels; dimensionless throughout.

In Phase A: how far the tip has turned that rests on a point of given slope and height.
"""

from typing import NamedTuple

import numpy as np
from scipy.special import ellipe, ellipk

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.roots import zeros
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.solver.elastica import (
    Frame,
    Span,
    frame,
    least_rotation,
    span,
    span_by_alpha,
    span_by_excess,
    span_by_excess_twice,
    tangent_span,
)
from analytic.solver.general.states import INSIDE, States, Vibrissa

_STRAIGHT = 1e-30  # p of a tip that has not turned
_STEPS = 3  # of Halley's method, before those that need more of them are enclosed
_CLOSE = 1e-5  # of a step of third order, relative: the next one would change round-off only

_LEAST = 1e-40  # of the sag: less is rounding, but the square root of this one is not zero


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
        found[:, poor] = _enclosed(alpha[poor], sag[poor], high[poor])
    return found


def _enclosed(alpha: Floats, sag: Floats, high: Floats) -> Floats:
    """What `_turned` has, by enclosing p."""

    def sunk_farther(which: Integers, p: Floats) -> Floats:
        slope, loaded = alpha[which], span(2 * np.arcsin(p * p), alpha[which])
        return np.sqrt(np.maximum(1 - frame(loaded, slope).up / loaded.q, 0.0)) - sag[which]

    least = np.full_like(high, _STRAIGHT)
    hardly = sunk_farther(np.arange(least.size), least) >= 0  # but for rounding of the height
    excess = 2 * np.arcsin(np.where(hardly, least, zeros(sunk_farther, least, high)) ** 2)
    return np.array([excess, *span(excess, alpha)])


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


class Equilibria(NamedTuple):
    """Vibrissae at rest against points, shape (n,); NaN in `excess` where none can reach."""

    point: ContourPoint
    tip_rotation: Floats
    span: Span
    root_f: Floats
    tangent: Booleans
    frame: Frame  # the contact as seen from the clamp, times sqrt(f)

    @property
    def arc_length(self) -> Floats:
        return np.where(self.tangent, self._tangent_length, 1.0)

    @property
    def _tangent_length(self) -> Floats:
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(self.root_f == 0, self.point.eta, self.span.q / self.root_f)

    @property
    def foot_x(self) -> Floats:
        """Foot position x0 (Will et al., eqs. 13 and 22) [L]."""
        return np.asarray(self.point.xi - self.reach)

    @property
    def reach(self) -> Floats:
        """Distance of the contact from the foot along x."""
        with np.errstate(divide="ignore", invalid="ignore"):  # unloaded, the vibrissa is straight
            return np.where(self.root_f == 0, 0.0, self.frame.across / self.root_f)

    def states(self, vibrissa: Vibrissa) -> States:
        """The same as states of any vibrissa, which count the excess in another way."""
        excess = np.minimum(self._tangent_length - 1, INSIDE)
        tip = (~self.tangent).nonzero()[0]
        if tip.size:
            alpha = self.point.alpha[tip]
            leant = np.pi / 2 - alpha - least_rotation(alpha) - self.tip_rotation[tip]
            excess[tip] = np.maximum(leant, 0.0)
        force, moment = self.root_f * self.root_f, self.root_f * self.span.C
        up, none = self.point.eta, np.zeros(force.shape)
        return States(self.point, force, excess, moment, up, self.reach, none, none, vibrissa)

    def tangent_rate(self) -> Floats:
        """d(x0)/dt in Phase B; at its limits too, whichever phase is there."""
        alpha, _, eta, turning, stretch = self.point
        up, across = self.frame
        lean = across / up
        rise = 1 + lean**2 - lean / (self.span.C * up)
        return stretch * (np.cos(alpha) - np.sin(alpha) * lean) + turning * eta * rise

    def tip_rate(self) -> "TipRate":
        """The derivatives in Phase A; at its limits too, whichever phase is there."""
        alpha, _, _, turning, stretch = self.point
        height, reach = tip_rates(self.tip_rotation, self.span, alpha, self.frame)
        tip_rotation_rate = (stretch * np.sin(alpha) - turning * height.by_alpha) / height.by_excess
        along = stretch * np.cos(alpha) - turning * reach.by_alpha
        return TipRate(along - reach.by_excess * tip_rotation_rate, tip_rotation_rate)


class TipRate(NamedTuple):
    """How states change along the contour in Phase A; arrays of shape (n,)."""

    foot_x: Floats  # [L by the contour's parameter]
    tip_rotation: Floats  # [rad by the contour's parameter]


class LengthRates(NamedTuple):
    """Partial derivatives of a length of the tip-loaded vibrissa."""

    by_alpha: Floats
    by_excess: Floats


def tip_rates(
    tip_rotation: Floats, loaded: Span, alpha: Floats, end: Frame | None = None
) -> tuple[LengthRates, LengthRates]:
    """Derivatives of the tip's height y(1) and reach x(1) - x0 by alpha and excess rotation."""
    by_excess = span_by_excess(loaded, tip_rotation, alpha)
    up, across = frame(loaded, alpha) if end is None else end
    up_w, across_w = frame(by_excess, alpha)
    q, C = loaded.q, loaded.C
    y, x = up / q, across / q
    height_w, reach_w = (up_w - y * by_excess.q) / q, (across_w - x * by_excess.q) / q
    side = np.where(alpha < 0, -1.0, 1.0)
    height = LengthRates(side * height_w + x + (y - 1) / (C * q), height_w)
    reach = LengthRates(side * reach_w - y + x / (C * q), reach_w)
    return height, reach


def tangent_contact(point: ContourPoint) -> Equilibria:
    """Phase B (Will et al., eqs. 18-22), whether or not its arc length fits on the vibrissa."""
    tip_rotation = np.pi / 2 - np.abs(point.alpha)
    loaded = tangent_span(point.alpha)
    end = frame(loaded, point.alpha)
    every = np.ones(point.alpha.shape, dtype=bool)
    return Equilibria(point, tip_rotation, loaded, end.up / point.eta, every, end)


def contact(point: ContourPoint, tip_rotation: Floats, tangent: Booleans) -> Equilibria:
    """Contacts of known phase, and of known rotation if at the tip."""
    tip_rotation = np.where(tangent, np.pi / 2 - np.abs(point.alpha), tip_rotation)
    return _contact(point, tip_rotation, span(tip_rotation, point.alpha), tangent)


def contact_beside(states: Equilibria, point: ContourPoint, tip_rotation: Floats) -> Equilibria:
    """Contacts so near to known ones that their integrals follow without being computed."""
    alpha, tangent = states.point.alpha, states.tangent
    tip_rotation = np.where(tangent, np.pi / 2 - np.abs(point.alpha), tip_rotation)
    # By the root of the excess they are smooth where the clamp's moment vanishes.
    before, after = np.sqrt(states.tip_rotation), np.sqrt(tip_rotation)
    turned, leant = 2 * before * (after - before), point.alpha - alpha
    by_excess = span_by_excess(states.span, states.tip_rotation, alpha)
    by_alpha = span_by_alpha(states.span, by_excess, alpha)
    rates = zip(states.span, by_excess, by_alpha, strict=True)
    loaded = Span(*(x + turned * x_w + leant * x_a for x, x_w, x_a in rates))
    return _contact(point, tip_rotation, loaded, tangent)


def _contact(
    point: ContourPoint, tip_rotation: Floats, loaded: Span, tangent: Booleans
) -> Equilibria:
    end = frame(loaded, point.alpha)
    with np.errstate(divide="ignore", invalid="ignore"):
        root_f = np.where(tangent, end.up / point.eta, loaded.q)
    return Equilibria(point, tip_rotation, loaded, root_f, tangent, end)


def equilibria(contour: Contour, t: Floats) -> Equilibria:
    return equilibria_at(contour.at(t))


def equilibria_at(point: ContourPoint) -> Equilibria:
    """The vibrissa against each contour point: tangential if that fits on it, else at the tip."""
    found = tangent_contact(point)
    tip_rotation, loaded, root_f, _, end = found[1:]
    tangent = _fits(found)
    tip = (~tangent).nonzero()[0]
    if tip.size:
        alpha = point.alpha[tip]
        with np.errstate(invalid="ignore"):  # straight, against an upright side: out of reach
            lowest = end.up[tip] / loaded.q[tip]
        tip_rotation[tip], of_tip = tip_state(alpha, point.eta[tip], lowest)
        for values, at_tip in zip((*loaded, *end), (*of_tip, *frame(of_tip, alpha)), strict=True):
            values[tip] = at_tip
        root_f[tip] = of_tip.q
    return Equilibria(point, tip_rotation, loaded, root_f, tangent, end)


def _fits(tangential: Equilibria) -> Booleans:
    """Whether tangential contacts fit on the vibrissa; below -52.906 deg there is none."""
    root_f = tangential.root_f
    return np.asarray((root_f > 0) & (tangential.span.q < root_f))


def surplus(contour: Contour, t: Floats) -> Floats:
    """1 - 1/s1 with s1 of eq. 21 (Will et al.): negative in Phase B, smooth at the pole of s1.

    Parameters
    ----------
    contour : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    t : array, shape (n,)
        Contour parameters.

    Returns
    -------
    array, shape (n,)
        Dimensionless.
    """
    return surplus_and_rate(contour.at(t))[0]


def surplus_and_rate(point: ContourPoint) -> tuple[Floats, Floats]:
    """`surplus`, and its derivative along the contour."""
    states = tangent_contact(point)
    alpha, _, eta, turning, stretch = states.point
    up, across = states.frame
    q, C, _ = states.span
    with np.errstate(divide="ignore", invalid="ignore"):  # straight, against an upright side
        value = np.where(q == 0, 1 - 1 / eta, 1 - states.root_f / q)
        by_alpha = (across - 1 / C + up / (C * q)) / (eta * q)
        rate = states.root_f / q * stretch * np.sin(alpha) / eta - turning * by_alpha
    return value, np.where(q == 0, np.nan, rate)
