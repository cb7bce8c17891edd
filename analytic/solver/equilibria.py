"""Both contact phases at points of the contour the centreline feels; dimensionless throughout."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.solver.elastica import (
    Frame,
    Span,
    frame,
    least_rotation,
    span,
    span_by_alpha,
    span_by_excess,
    tangent_span,
)
from analytic.solver.general.states import INSIDE, States, Vibrissa
from analytic.solver.tip import tip_state


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
