"""The elastica under one contact force, in closed form.

Everything is dimensionless: lengths in L, forces in EI/L^2, moments in EI/L. The loaded span runs
from the clamp (slope pi/2) to the contact, where the frictionless contour of slope angle alpha
presses with force f. With theta = phi - alpha its first integral is kappa^2 = 2 f (sin theta -
sin theta_1), theta_1 the value at the contact (Will, Steigenberger and Behn, *Quasi-static object
scanning using technical vibrissae*, 2014, eqs. 6 and 17), so that the span depends on
alpha and on the rotation u = pi/2 - phi_1 of its end alone:

    q = sqrt(f) * span length
    C = sqrt(f) * integral of cos theta = |kappa(0)| / sqrt(f)
    S = sqrt(f) * integral of sin theta

are elliptic integrals of modulus k = sin((u + alpha)/2). The substitution k sin(psi) =
sin(pi/4 - theta/2) of eq. 9 gives them from psi_0 to pi/2; the addition theorem (Byrd and Friedman,
116.01) turns that into *one* incomplete integral to psi', tan(psi') = cos(psi_0)/(k' sin(psi_0)),
so nothing cancels when the span is hardly bent.

The rotation is counted from the smallest possible one, u = w + max(0, -2 alpha), so that nothing
cancels where the clamp moment vanishes either: w = 0 is the straight span for alpha >= 0 and the
span with zero moment at the clamp for alpha < 0.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev, legendre
from scipy.special import ellipeinc, ellipkinc

from analytic.numerics.arrays import Floats

_FEW = 150  # amplitudes; up to so many, two calls of SciPy's are faster than sixty of NumPy's
_AT_ONCE = 8192  # amplitudes: what is computed on the way stays in the processor's cache
_LAST = 5.0  # rad; beyond, it is the fourth quadrant, whatever a rounding of the sine says
_SMALL = 0.8  # modulus, up to which two of Landen's steps leave less than rounding to the series

_DEGREE = 13  # of the polynomials for Phase B: the next coefficients are below 2e-16


def elliptic_integrals(
    opposite: Floats, adjacent: Floats, k: Floats, k_: Floats
) -> tuple[Floats, Floats, Floats]:
    """F(psi, k), E(psi, k) and sin psi of amplitudes from -pi to pi (DLMF 19.8.12, 19.8.13)."""
    psi = np.arctan2(opposite, adjacent + 0.0)  # an adjacent -0 would make 0 and 0 half a turn
    if psi.size <= _FEW:
        return ellipkinc(psi, k * k), ellipeinc(psi, k * k), np.sin(psi)
    if psi.size > _AT_ONCE:
        every = [x.ravel() for x in np.broadcast_arrays(opposite, adjacent, k, k_)]
        parts = (slice(i, i + _AT_ONCE) for i in range(0, psi.size, _AT_ONCE))
        found = [elliptic_integrals(*(x[part] for x in every)) for part in parts]
        F, E, s = (np.concatenate(x).reshape(psi.shape) for x in zip(*found, strict=True))
        return F, E, s
    radius = np.hypot(opposite, adjacent)
    with np.errstate(invalid="ignore"):
        s, c = opposite / radius, adjacent / radius
    none = radius == 0
    s[none], c[none] = 0.0, 1.0
    F, E = _descended(np.abs(psi), np.abs(s), c, k, k_)
    F, E = np.copysign(F, psi), np.copysign(E, psi)
    large = k > _SMALL
    if large.any():
        F[large] = ellipkinc(psi[large], k[large] ** 2)
        E[large] = ellipeinc(psi[large], k[large] ** 2)
    return F, E, s


def _descended(psi: Floats, s: Floats, c: Floats, k: Floats, k_: Floats) -> tuple[Floats, Floats]:
    """The integrals of amplitudes from 0 to pi."""
    sum0, root = 1 + k_, np.sqrt(k_)
    k1, k1_ = (k / sum0) ** 2, 2 * root / sum0
    sum1 = 1 + k1_
    k2 = (k1 / sum1) ** 2
    psi1, s1, c1 = _lowered(psi, s, c, k_)
    psi2, s2, c2 = _lowered(psi1, s1, c1, k1_)
    F2, E2 = _series(psi2, s2, c2, k2 * k2)
    F1 = (1 + k2) / 2 * F2
    F = (1 + k1) / 2 * F1
    E1 = sum1 / 2 * E2 - k1_ * F1 + (1 - k1_) / 2 * s2
    return F, sum0 / 2 * E1 - k_ * F + (1 - k_) / 2 * s1


def _lowered(psi: Floats, s: Floats, c: Floats, k_: Floats) -> tuple[Floats, Floats, Floats]:
    """The amplitude that belongs to the next smaller modulus, its sine and its cosine."""
    turned = k_ * s
    lowered = psi + np.arctan2(turned, c)
    lowered[(s < 0) | (psi > _LAST)] += 2 * np.pi
    sine, cosine = s * (c + k_ * c) + 0.0, c * c - turned * s  # + 0.0: never -0
    radius = np.sqrt(sine * sine + cosine * cosine)
    return lowered, sine / radius, cosine / radius


def _series(psi: Floats, s: Floats, c: Floats, m: Floats) -> tuple[Floats, Floats]:
    """The integrals of small modulus, m its square, from those of sin^2, sin^4 and sin^6."""
    product, square = s * c, s * s
    second = (psi - product) / 2
    product = product * square
    fourth = (3 * second - product) / 4
    sixth = (5 * fourth - product * square) / 6
    one, two, three = m / 2 * second, m * m * fourth, m * m * m * sixth
    return psi + one + 3 / 8 * two + 5 / 16 * three, psi - one - two / 8 - three / 16


class Span(NamedTuple):
    """The three integrals of a loaded span; arrays of one shape."""

    q: Floats
    C: Floats
    S: Floats


class Frame(NamedTuple):
    """Where the span ends: up and across from the clamp, times sqrt(f)."""

    up: Floats
    across: Floats


def span(excess: Floats, alpha: Floats) -> Span:
    """Integrals of the span whose end has turned by `excess` over the least possible rotation."""
    w, sharp = excess, np.abs(alpha)
    k, k_ = np.sin((w + sharp) / 2), np.cos((w + sharp) / 2)
    return _span(2 * np.sqrt(np.sin(w / 2) * np.sin(w / 2 + sharp)), k, k_, alpha)


def tangent_span(alpha: Floats) -> Span:
    """Integrals of the span in tangential contact (Phase B), which depend on `alpha` alone.

    With v = pi/2 - |alpha|, for alpha >= 0 (theta from 0 to v, put theta = v t^2),

        q = integral of 1/sqrt(2 sin theta) = sqrt(2 v) g(v^2),
        S = integral of sqrt(sin(theta)/2) = v^(3/2) h(v^2),

    g and h being analytic; for alpha < 0, where theta passes pi/2, twice the integrals up to there
    less these.
    """
    v = np.pi / 2 - np.abs(alpha)
    root = np.sqrt(v)
    q, S = _polynomials(v * v * (2 / _WIDEST) - 1)
    q *= root
    S *= root
    S *= v
    past = alpha < 0
    np.subtract(2 * _UPRIGHT[0], q, out=q, where=past)
    np.subtract(2 * _UPRIGHT[1], S, out=S, where=past)
    return Span(q, np.sqrt(2 * np.sin(v)), S)


def span_of_moment(C: Floats, alpha: Floats) -> Span:
    """Integrals of the span whose clamp moment is C sqrt(f): what reconstruction starts from."""
    k = np.hypot(np.sin(alpha / 2), C / 2)
    with np.errstate(invalid="ignore"):
        return _span(C, k, np.sqrt(1 - k * k), alpha)


def _span(C: Floats, k: Floats, k_: Floats, alpha: Floats) -> Span:
    a = np.sin(alpha / 2)  # k sin(psi_0); k cos(psi_0) is C/2
    q, E, sine = elliptic_integrals(C / 2, k_ * a, k, k_)
    return Span(q, C, 2 * (E - k * a * sine) - q)


def _polynomials(z: Floats) -> tuple[Floats, Floats]:
    """sqrt(2) g and h, of -1 <= z <= 1: from all powers, that of 8 by three multiplications."""
    powers = np.empty((_DEGREE + 1, z.size))
    powers[0], powers[1] = 1.0, z.ravel()
    known = 2
    while known <= _DEGREE:
        more = min(known, _DEGREE + 1 - known)
        np.multiply(powers[:more], powers[1] * powers[known - 1], out=powers[known : known + more])
        known += more
    g, h = _COEFFICIENTS @ powers
    return g.reshape(z.shape), h.reshape(z.shape)


def _means(z: Floats) -> Floats:
    """sqrt(2) g and h of v^2 = `_WIDEST` (1 + z)/2, shape (2, n), by Gauss's quadrature over t."""
    nodes, weights = legendre.leggauss(24)
    t, weights = (nodes + 1) / 2, weights / 2
    v = np.sqrt(_WIDEST * (1 + z) / 2)
    root = np.sqrt(2 * np.sinc(v[:, None] * t**2 / np.pi))
    return np.stack([2 * (weights / root).sum(axis=1), (weights * t**2 * root).sum(axis=1)])


_WIDEST = (np.pi / 2) ** 2  # of v^2
_NODES = chebyshev.chebpts1(_DEGREE + 1)
_COEFFICIENTS = np.array(
    [chebyshev.cheb2poly(chebyshev.chebfit(_NODES, x, _DEGREE)) for x in _means(_NODES)]
)
_UPRIGHT = np.array([np.sqrt(np.pi / 2), (np.pi / 2) ** 1.5]) * _COEFFICIENTS.sum(axis=1)
"""q and S up to theta = pi/2."""


def least_rotation(alpha: Floats) -> Floats:
    """Rotation from which the excess w is counted: u = w + max(0, -2 alpha)."""
    return np.maximum(0.0, -2 * alpha)


def frame(span: Span, alpha: Floats) -> Frame:
    sin, cos = np.sin(alpha), np.cos(alpha)
    return Frame(span.C * sin + span.S * cos, span.C * cos - span.S * sin)


def span_by_excess(span: Span, excess: Floats, alpha: Floats) -> Span:
    """Derivatives of `span` by the excess (Byrd and Friedman, 710.07 and 710.09)."""
    q, C, S = span
    angle = excess + np.abs(alpha)  # pi/2 - theta_1
    sin_1, cos_1 = np.cos(angle), np.sin(angle)
    pull = np.sin(alpha) / C
    return Span(
        ((S - q * sin_1) / 2 + pull) / cos_1,
        cos_1 / C,
        (sin_1 * (S / 2 + pull) - q / 2) / cos_1,
    )


def span_by_excess_twice(span: Span, by_excess: Span, excess: Floats, alpha: Floats) -> Span:
    """Second derivatives of `span` with respect to the excess rotation, at fixed alpha."""
    q, C, S = span
    q_w, C_w, S_w = by_excess
    angle = excess + np.abs(alpha)
    sin_1, cos_1 = np.cos(angle), np.sin(angle)
    pull = np.sin(alpha) / C
    pull_w = -pull * C_w / C
    return Span(
        ((S_w - q_w * sin_1 + q * cos_1) / 2 + pull_w - q_w * sin_1) / cos_1,
        (sin_1 - cos_1 * C_w / C) / C,
        (sin_1 * (S_w / 2 + pull_w - S_w) - cos_1 * (S / 2 + pull) - q_w / 2) / cos_1,
    )


def span_by_alpha(span: Span, by_excess: Span, alpha: Floats) -> Span:
    """Derivatives of `span` by alpha, at fixed excess: both limits of the integrals move."""
    side = np.where(alpha < 0, -1.0, 1.0)
    return Span(
        side * by_excess.q - 1 / span.C,
        side * by_excess.C - np.sin(alpha) / span.C,
        side * by_excess.S - np.cos(alpha) / span.C,
    )
