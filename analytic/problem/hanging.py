"""The end of a vibrissa beyond a place that is held there, under its own weight alone.

Dimensionless, as in `analytic.problem.rod`. Of the weight w by length, the part w (1 - s) hangs
beyond a place s. With M' = (1 - s) (w_x sin(phi) - w_y cos(phi)) and M(1) = 0 the slope angle obeys

    phi(s) = phi_0 + int kappa_0 ds + int M EI(0)/EI ds,

on Gauss's points of panels a set of equations, solved by Newton's method as the weight grows.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from analytic.numerics.panel import NODES, POINTS, TO_NODES, WEIGHTS
from analytic.problem.along import Along
from analytic.problem.arrays import Booleans, Floats
from analytic.problem.rod import RodProperties
from analytic.problem.unloaded import Unloaded

# Of the pendulum that the weight makes of a panel [rad]: its end is exact, or all on the way to it.
_OF_ENDS, _ALL_ALONG = 3.0, 1.0
_LOAD = 2.0  # EI/L^3; by which the weight grows from one solution to the next
_ROUNDS = 12
_CLOSE = 5e-16  # rad; rounding
_NOTHING = 1e-14  # 1/L; rounding of the curvature of one that stands upright
_TO_CHEBYSHEV = np.linalg.inv(chebyshev.chebvander(2 * POINTS - 1, NODES - 1))


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
