"""What varies along a vibrissa, dimensionless, and how the end of a heavy one hangs.

Panels are such that polynomials resolve what varies on each. Of the weight w by length, the part
w (1 - s) hangs beyond a place s that is held. With M' = (1 - s) (w_x sin(phi) - w_y cos(phi)) and
M(1) = 0 the slope angle there obeys

    phi(s) = phi_0 + int kappa_0 ds + int M EI(0)/EI ds,

on Gauss's points of panels a set of equations, solved by Newton's method as the weight grows.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from analytic.numerics.arrays import Booleans, Floats
from analytic.numerics.panel import NODES, POINTS, TO_NODES, TO_SERIES, WEIGHTS, Panel
from analytic.problem.along import Along, rescaled
from analytic.problem.beam import Beam, Unloaded

_TAIL = 2  # coefficients
_EXACT = 1e-8  # of a panel's largest value; of the integral over it then the square
_HALVINGS = 12
_PLACES = 257
_KNOWN = 512  # panels: a sweep of a stiff vibrissa asks for some ten, a calibration for a hundred

# Of the pendulum that the weight makes of a panel [rad]: its end is exact, or all on the way to it.
_OF_ENDS, _ALL_ALONG = 3.0, 1.0
_LOAD = 2.0  # EI/L^3; by which the weight grows from one solution to the next
_ROUNDS = 12
_CLOSE = 5e-16  # rad; rounding
_NOTHING = 1e-14  # 1/L; rounding of the curvature of one that stands upright
_TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(2 * POINTS - 1, NODES - 1))


@dataclass(frozen=True)
class RodProperties:
    unloaded: Unloaded  # natural curvature and radius
    # EI(s)/EI(0); or the ratio of a cone's radii, whose fourth power it follows.
    rigidity: Along | float
    # Exponent of the rigidity: 1, or less on the way from the uniform vibrissa to this one.
    share: float = 1.0
    weight: tuple[float, float] = (0.0, 0.0)  # along x and y, by length [EI(0)/L^3]

    @classmethod
    def of(
        cls, beam: Beam, rest: Unloaded, weight: tuple[float, float] = (0.0, 0.0)
    ) -> "RodProperties":
        w_x, w_y = (w * beam.length / beam.force_unit for w in weight)
        rigidity: Along | float = rest.tip_radius / rest.base_radius if rest.base_radius else 1.0
        if isinstance(beam.flexural_rigidity, Along):
            rigidity = beam.flexural_rigidity.times(1 / beam.base_rigidity, 1 / beam.length)
        return cls(rest, rigidity, weight=(w_x, w_y))

    def scaled(self, share: float) -> "RodProperties":
        """The form a part of the way from the uniform, straight vibrissa to this one."""
        rest = self.unloaded
        less = rescaled(rest.natural, share)
        base = rest.tip_radius + share * (rest.base_radius - rest.tip_radius)
        less_leant = replace(rest, natural=less, base_radius=base, angle=share * rest.angle)
        w_x, w_y = self.weight
        less_heavy = share * w_x, share * w_y
        return replace(self, unloaded=less_leant, share=share, weight=less_heavy)

    def flexibility(self, s: Floats) -> Floats:
        """EI(0)/EI(s)."""
        if isinstance(self.rigidity, Along):
            inverse = 1 / self.rigidity(s)
            return inverse if self.share == 1 else inverse**self.share
        inverse = 1 / (1 - (1 - self.rigidity) * s) ** 2
        return np.asarray(inverse**2 if self.share == 1 else inverse ** (2 * self.share))

    def panel(self, begin: Floats, end: Floats) -> Panel:
        return Panel.between(begin, end, self.flexibility, self.unloaded.curvature)

    @cached_property
    def known_panel(self) -> Callable[[float, float], Panel]:
        """The form between two places that many spans run through, the last ones computed once."""
        return lru_cache(_KNOWN)(lambda *ends: self.panel(*np.reshape(ends, (2, 1))))

    @cached_property
    def ends(self) -> Floats:
        """Arc lengths between which the form is smooth and resolved, from 0 to 1 [L]."""
        given = self.rigidity, self.unloaded.natural
        marks = {0.0, 1.0}
        for along in given:
            if isinstance(along, Along):
                marks |= set(along.ends[1:-1])
        ends, ahead = [0.0], sorted(marks)[:0:-1]
        least = 0.5**_HALVINGS
        while ahead:
            begin, end = ends[-1], ahead[-1]
            if end - begin < least or self._is_resolved(begin, end):
                ends.append(ahead.pop())
            else:
                ahead.append((begin + end) / 2)
        return np.array(ends)

    @cached_property
    def phases(self) -> Floats:
        """The pendulum's phase between two ends under a force of 1, nearly; shape (panels,)."""
        share, widths = np.linspace(0, 1, NODES)[:, None], np.diff(self.ends)
        flexible = self.flexibility(self.ends[:-1] + share * widths)
        return np.asarray(widths * np.sqrt(flexible.max(axis=0)))

    @cached_property
    def least_force(self) -> float:
        """Force across the tip that turns it by half a radian, if that were little; at most 1."""
        turn = 0.0
        for begin, end in pairwise(self.ends):
            s = begin + (end - begin) * POINTS
            turn += float((end - begin) * (WEIGHTS @ ((1 - s) * self.flexibility(s))))
        return min(1.0, 0.5 / turn)

    @cached_property
    def most_curved(self) -> float:
        return float(self.unloaded.curvature(np.linspace(0, 1, _PLACES)).max())

    def _is_resolved(self, begin: float, end: float) -> bool:
        s = begin + (end - begin) * POINTS
        natural = self.unloaded.curvature(s)
        for values, least in ((self.flexibility(s), 0.0), (natural, 1.0)):
            series = np.abs(TO_SERIES @ values)
            if series[-_TAIL:].max() > _EXACT * max(least, np.abs(values).max()):
                return False
        return True


class Hung(NamedTuple):
    """Ends of n vibrissae; places of shape (n, k), the last one the tip."""

    s: Floats
    slope: Floats  # angle [rad]
    x: Floats
    y: Floats  # from where the end begins [L]
    m: Floats  # moment at the Gauss points [EI(0)/L]
    base: Floats  # moment where the end begins, shape (n,) [EI(0)/L]
    stands: Booleans  # whether it does, rather than buckle, shape (n,)


def hang(
    rod: RodProperties,
    slope: Floats,
    begin: Floats,
    compliance: float = 0.0,
    phase: float = _OF_ENDS,
) -> Hung:
    """The ends beyond arc lengths `begin`, shape (n,), held at slope angles by what may turn."""
    places = _panels(rod, phase)
    first = max(
        int(np.searchsorted(places, np.fmin.reduce(begin, initial=1.0), side="right")) - 1, 0
    )
    ends = np.maximum(places[first:], begin[:, None])
    widths = np.diff(ends)
    s = (ends[:, :-1, None] + widths[..., None] * POINTS).reshape(len(begin), -1)
    to_end = np.repeat(widths, NODES, axis=1) * np.tile(WEIGHTS, widths.shape[1])
    number = np.repeat(np.arange(widths.shape[1]), NODES)
    inside = np.tile(TO_NODES, (widths.shape[1],) * 2) * np.repeat(widths, NODES, axis=1)[:, None]
    earlier = (number[:, None] > number) * to_end[:, None]
    to_node = np.where(number[:, None] == number, inside, earlier)

    beyond = (to_end[:, None] - to_node) * (1 - s)[:, None]
    to_base = to_end * (1 - s)
    turned = (to_node * rod.flexibility(s)[:, None]) @ beyond + compliance * to_base[:, None]
    natural = rod.unloaded.curvature(s)
    phi_0 = slope[:, None] + np.einsum("nij,nj->ni", to_node, natural)
    phi, unit = phi_0, np.eye(s.shape[1])
    steps = 1 + int(np.hypot(*rod.weight) / _LOAD)
    stands = np.ones(len(begin), dtype=bool)
    for share in np.arange(1, steps + 1) / steps:
        w_x, w_y = (share * w for w in rod.weight)
        for _ in range(_ROUNDS):
            sin, cos = np.sin(phi), np.cos(phi)
            missed = phi - phi_0 + np.einsum("nij,nj->ni", turned, w_x * sin - w_y * cos)
            slopes = unit + turned * (w_x * cos + w_y * sin)[:, None]
            if not (np.abs(missed) > _CLOSE).any():
                break
            phi = phi - np.linalg.solve(slopes, missed[..., None])[..., 0]
        stands &= np.linalg.det(slopes) > 0
    pull = rod.weight[0] * np.sin(phi) - rod.weight[1] * np.cos(phi)
    m, base = -np.einsum("nij,nj->ni", beyond, pull), -np.einsum("nj,nj->n", to_base, pull)
    curvature = natural + m * rod.flexibility(s)
    tip = slope + compliance * base + np.einsum("nj,nj->n", to_end, curvature)
    x, y = (np.einsum("nij,nj->ni", to_node, f(phi)) for f in (np.cos, np.sin))
    last = (np.einsum("nj,nj->n", to_end, f(phi))[:, None] for f in (np.cos, np.sin))
    x, y = (np.append(at, end, axis=1) for at, end in zip((x, y), last, strict=True))
    s = np.append(s, np.ones((len(begin), 1)), axis=1)
    return Hung(s, np.append(phi, tip[:, None], axis=1), x, y, m, base, stands)


def _panels(rod: RodProperties, phase: float) -> Floats:
    """The rod's ends, and parts between as the weight asks for."""
    counts = 1 + (rod.phases * np.sqrt(np.hypot(*rod.weight)) / phase).astype(int)
    parts = [
        np.linspace(begin, end, count, endpoint=False)
        for begin, end, count in zip(rod.ends[:-1], rod.ends[1:], counts, strict=True)
    ]
    return np.append(np.concatenate(parts), 1.0)


class AtRest(NamedTuple):
    """A vibrissa in its clamp that touches nothing."""

    shape: Unloaded  # as that of one without weight, and so curved
    moment: float  # M_Az, on the vibrissa [EI(0)/L]
    stands: bool


@lru_cache(64)
def at_rest(rod: RodProperties, compliance: float) -> AtRest:
    unloaded = rod.unloaded
    slope, clamp = np.array([np.pi / 2 + unloaded.angle]), np.zeros(1)
    hung = hang(rod, slope, clamp, compliance, _ALL_ALONG)
    moment, stands = -float(hung.base[0]), bool(hung.stands[0])
    if np.abs(hung.m).max() < _NOTHING:
        return AtRest(unloaded, 0.0, stands)
    series = hung.m.reshape(-1, NODES) @ _TO_CHEBYSHEV.T
    m = Along(tuple(_panels(rod, _ALL_ALONG).tolist()), tuple(map(tuple, series.tolist())))

    def curvature(s: Floats) -> Floats:
        return unloaded.curvature(s) + m(s) * rod.flexibility(s)

    natural = Along.of("the vibrissa under its weight", curvature, 1.0)
    leant = unloaded.angle - compliance * moment
    shape = Unloaded(natural, unloaded.base_radius, unloaded.tip_radius, leant)
    return AtRest(shape, moment, stands)
