"""A loaded span from the contact back to the clamp: in closed form, and by collocation.

With the moment of a dead force F of slope angle phi_F about the span's end, the curvature obeys
kappa' = F cos(theta), theta = phi - phi_F: the pendulum's equation, whatever the natural curvature,
as long as that is constant. With chi = pi/4 - theta/2 the three functions

    p = sin(chi),  g = cos(chi),  v = -kappa/2    obey    p' = g v,  g' = -p v,  v' = -F p g,

so that p^2 + g^2 = 1 and F p^2 + v^2 = B stay. They are k sn, dn and sqrt(F) k cn with k^2 = B/F.
Let S(s) be the solution of S' = c d, c^2 = 1 - F S^2, d^2 = 1 - B S^2, S(0) = 0: it is sn/sqrt(F)
of modulus k for k < 1, sn/sqrt(B) of modulus 1/k for k > 1. The addition theorems of sn, cn and dn
(Byrd and Friedman, *Handbook of elliptic integrals*, 1971, 123.01) take p, g and v from the contact
to the clamp, and that of the second kind's integral (116.02) gives the position. Written so,
nothing is singular: neither where the curvature changes its sign, nor at k = 1, nor where the force
vanishes.

Of any rigidity and natural curvature the span obeys

    theta' = kappa0(s) + m EI(0)/EI(s),    m' = F cos(theta),

in the units of EI(0), and with a weight w by length, of which w (1 - s) hangs beyond a place,

    m' = F cos(theta) + (1 - s) (w_x sin(phi) - w_y cos(phi)).

On panels that resolve rigidity and natural curvature, and are shorter than
a wave of the pendulum's over 2 pi, the solution is a polynomial through the points of Gauss and
Legendre, which makes its end exact to order 24 (Hairer, Lubich and Wanner, *Geometric Numerical
Integration*, II.1.3). It is found by Picard's iteration, for all spans at a time.
"""

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from scipy.special import ellipj, elliprd, gammaln

from analytic.numerics.arrays import Floats, Integers
from analytic.numerics.batches import put, take
from analytic.numerics.panel import TO_NODES, WEIGHTS, Panel
from analytic.problem.rod import RodProperties

_TINY = 1e-300  # instead of nothing, to divide by

_ITERATIONS = np.arange(30)
_CLOSE = 1e-16  # rad; of what they leave of the slope
_PULLS = np.exp((math.log(_CLOSE) + gammaln(2 * _ITERATIONS + 3)) / (_ITERATIONS + 1))
_LOST = 1e-9  # rad; of the last change of the slope, of a span whose iteration does not end
_WAVE = 0.8  # rad; of the pendulum's phase on a panel
_MOST = 64  # parts of a panel


class Start(NamedTuple):
    """The clamp's end of the span, as seen from the contact; arrays of one shape."""

    p: Floats
    g: Floats  # sin(chi) and cos(chi) of the slope at the clamp
    kappa: Floats
    along: Floats
    across: Floats  # integrals of cos(theta) and sin(theta) from the clamp to the contact
    amplitude: Floats  # amplitude of the span: pi at half a period [rad]

    def way(self, direction: Floats) -> tuple[Floats, Floats]:
        """From the clamp to the contact along x and y, the force at a slope angle."""
        sin, cos = np.sin(direction), np.cos(direction)
        return self.along * cos - self.across * sin, self.along * sin + self.across * cos

    def angle_from(self, due: Floats) -> Floats:
        """The angle chi at the clamp, from another one [rad]."""
        sin, cos = np.sin(due), np.cos(due)
        return np.asarray(np.arctan2(self.p * cos - self.g * sin, self.g * cos + self.p * sin))


def back_to_clamp(theta: Floats, kappa: Floats, force: Floats, length: Floats) -> Start:
    chi = np.pi / 4 - theta / 2
    p1, g1, v1 = np.sin(chi), np.cos(chi), -kappa / 2
    energy = force * p1**2 + v1**2
    swings = energy <= force  # the pendulum does; else it turns over
    larger = np.maximum(np.where(swings, force, energy), _TINY)
    m = np.where(swings, energy, force) / larger
    root = np.sqrt(larger)
    sn, cn, dn, _ = ellipj(root * length, m)
    S = sn / root
    S_S = S * S
    c, d = np.where(swings, cn, dn), np.where(swings, dn, cn)
    down = energy * _second_kind(S, S_S, cn, dn, m, root)

    p1_S, g1_d, v1_S = p1 * S, g1 * d, v1 * S
    D = 1 - force * p1_S**2
    p = (p1 * c * d - v1_S * g1) / D
    g = (g1_d + p1 * v1_S * c) / D
    # (1 - c)/F, as it is best where the force is small or large.
    large = (1 - c) / np.maximum(force, _TINY)
    fall = np.where(c >= 0, S_S / (1 + np.maximum(c, 0)), large)
    gained = (v1 * (p1_S**2 - fall) + p1_S * g1_d) / D  # (v - v1)/F
    along = 2 * gained
    across = length - 2 * (down + p1_S * p)
    return Start(p, g, kappa - force * along, along, across, np.arctan2(sn, cn) % (2 * np.pi))


def _second_kind(S: Floats, S_S: Floats, cn: Floats, dn: Floats, m: Floats, root: Floats) -> Floats:
    """Integral of S^2 by arc length, from 0 (Carlson's R_D; DLMF 19.25.10)."""
    rising = np.abs(S) * S_S / 3 * elliprd(cn * cn, dn * dn, 1.0)
    first = ~((cn < 0) | (S < 0))
    if first.all():  # no longer than a quarter of a period
        return rising
    quarter = np.zeros_like(S)
    whole = np.maximum(3 * root[~first] ** 3, _TINY)
    quarter[~first] = elliprd(0.0, 1 - m[~first], 1.0) / whole
    return np.where(
        S >= 0,
        np.where(cn >= 0, rising, 2 * quarter - rising),
        np.where(cn < 0, 2 * quarter + rising, 4 * quarter - rising),
    )


class SpanEnd(NamedTuple):
    """Where spans have come to; arrays of shape (n,)."""

    theta: Floats  # slope angle from the force's [rad]
    m: Floats  # moment, as the curvature beyond the natural one where the rigidity is EI(0)
    along: Floats
    across: Floats  # integrals of cos(theta) and sin(theta) on the way
    amplitude: Floats  # by how much the pendulum's phase has changed [rad]


class Trail(NamedTuple):
    """Places on the way of n spans, shape (k, n)."""

    s: Floats
    along: Floats
    across: Floats
    theta: Floats  # slope angle from the force's [rad]
    m: Floats  # moment


def march(
    rod: RodProperties,
    theta: Floats,
    m: Floats,
    force: Floats,
    length: Floats,
    *,
    direction: Floats | float = 0.0,
    from_clamp: bool = False,
    finer: int = 1,
    trail: list[Trail] | None = None,
) -> SpanEnd:
    """March along spans from the contact to the clamp, or back."""
    nowhere = ~((force >= 0) & (length >= 0) & np.isfinite(direction))
    here = SpanEnd(np.where(nowhere, np.nan, theta), m, *np.zeros((3, len(theta))))
    force, direction = np.where(nowhere, 0.0, force), np.where(nowhere, 0.0, direction)
    pull = _Pull.of(rod, force, direction)
    ends = _panels(rod, pull.largest, length, finer).tolist()
    panels = list(pairwise(ends))
    for low, high in panels if from_clamp else reversed(panels):
        on = length > low
        if trail is None and not on.any():
            continue
        everywhere = trail is not None or bool(on.all())
        some = here if everywhere else take(here, on)
        end = length if everywhere else length[on]
        if end.min() >= high:
            panel = rod.known_panel(*((low, high) if from_clamp else (high, low)))
        else:
            end = np.minimum(np.maximum(end, low), high)
            begin = np.full_like(end, low)
            panel = rod.panel(*((begin, end) if from_clamp else (end, begin)))
        new = _step(panel, some, pull if everywhere else take(pull, on), trail)
        if everywhere:
            here = new
        else:
            put(here, on, new)
    return here


def back_by_collocation(
    rod: RodProperties,
    theta: Floats,
    m: Floats,
    force: Floats,
    length: Floats,
    direction: Floats | float = 0.0,
) -> Start:
    """As `back_to_clamp`, of a vibrissa that varies or is heavy."""
    given = np.broadcast_arrays(theta, m, force, length, direction)
    shape = given[0].shape
    *ends, direction = (np.array(values, dtype=float).ravel() for values in given)
    end = march(rod, *ends, direction=direction)
    theta, m, along, across, amplitude = (values.reshape(shape) for values in end)
    chi = np.pi / 4 - theta / 2
    return Start(np.sin(chi), np.cos(chi), m, along, across, np.abs(amplitude))


class _Pull(NamedTuple):
    """What bends n spans: a force, and along and across it the weight by length; shape (n,)."""

    force: Floats
    normal: Floats
    along: Floats
    heavy: bool

    @classmethod
    def of(cls, rod: RodProperties, force: Floats, direction: Floats) -> "_Pull":
        w_x, w_y = rod.weight
        sin, cos = np.sin(direction), np.cos(direction)
        across, along = w_x * sin - w_y * cos, w_x * cos + w_y * sin
        force, across, along = np.broadcast_arrays(force, across, along)
        return cls(force, across, along, any(rod.weight))

    @property
    def largest(self) -> Floats:
        """No less than the force anywhere."""
        return self.force + np.hypot(self.normal, self.along) if self.heavy else self.force

    def at(self, s: Floats, theta: Floats) -> Floats:
        beyond = 1 - s
        level = (self.force + beyond * self.normal) * np.cos(theta)
        return np.asarray(level + beyond * self.along * np.sin(theta))


def _panels(rod: RodProperties, force: Floats, length: Floats, finer: int) -> Floats:
    """The form's ends, and parts between as the forces ask for that reach there."""
    ends = rod.ends
    # A span is loaded up to its contact: what lies beyond does not ask for shorter panels.
    order = np.argsort(length)
    largest = np.append(np.maximum.accumulate(force[order][::-1])[::-1], 0.0)
    reached = largest[np.searchsorted(length[order], ends[:-1], side="right")]
    waves = np.ceil(rod.phases * np.sqrt(reached) / _WAVE)
    counts = finer * np.minimum(np.maximum(waves, 1), _MOST).astype(int)
    if counts.max() == 1:
        return ends
    begins: Integers = np.repeat(np.cumsum(counts) - counts, counts)
    share = (np.arange(counts.sum()) - begins) / np.repeat(counts, counts)
    inner = np.repeat(ends[:-1], counts) + share * np.repeat(np.diff(ends), counts)
    return np.append(inner, ends[-1])


def _step(panel: Panel, here: SpanEnd, pull: _Pull, trail: list[Trail] | None) -> SpanEnd:
    force = pull.force
    # By the natural curvature and the moment at the beginning; the force turns it further.
    reached = turned = here.theta + (panel.rest + panel.bend * here.m)
    # By a square phase of pull the k-th iteration leaves pull^(k + 1)/(2 k + 2)!.
    square = float(panel.give.max() * pull.largest.max())
    for _ in range(int(np.searchsorted(_PULLS, square)) + 1):
        theta = reached[:-1]
        cos = np.cos(theta)
        if pull.heavy:
            reached = turned + panel.turned(pull.at(panel.s, theta))
        else:
            reached = turned + force * panel.turned(cos)
    change = np.abs(reached[:-1] - theta).max(axis=0)
    last = np.where(change > _LOST, np.nan, reached[-1])
    bends = pull.at(panel.s, theta) if pull.heavy else cos
    scale = panel.length if pull.heavy else panel.length * force
    moment = here.m + scale * WEIGHTS.dot(bends)
    sin, size = np.sin(theta), np.abs(panel.length)
    if trail is not None:
        trail.append(
            Trail(
                np.broadcast_to(panel.s, cos.shape),
                here.along + size * TO_NODES.dot(cos),
                here.across + size * TO_NODES.dot(sin),
                theta,
                here.m + scale * TO_NODES.dot(bends),
            )
        )
    first, final = _phases(panel, np.array([here.theta, last]), np.array([here.m, moment]), force)
    return SpanEnd(
        last,
        moment,
        here.along + size * WEIGHTS.dot(cos),
        here.across + size * WEIGHTS.dot(sin),
        here.amplitude + (final - first + np.pi) % (2 * np.pi) - np.pi,
    )


def _phases(panel: Panel, theta: Floats, m: Floats, force: Floats) -> Floats:
    """The pendulum's phase at both ends: by half a period it changes by pi [rad]."""
    curvature = panel.natural + m * panel.flexible
    p = np.sqrt(force) * np.sin(np.pi / 4 - theta / 2)
    return np.asarray(np.arctan2(p, curvature / (-2 * np.sqrt(panel.flexible))))
