"""Incomplete elliptic integrals of the first and second kind, many at a time."""

import numpy as np
from scipy.special import ellipeinc, ellipkinc

from analytic.problem.arrays import Floats

_FEW = 150  # amplitudes; up to so many, two calls of SciPy's are faster than sixty of NumPy's
_AT_ONCE = 8192  # amplitudes: what is computed on the way stays in the processor's cache
_LAST = 5.0  # rad; beyond, it is the fourth quadrant, whatever a rounding of the sine says
_SMALL = 0.8  # modulus, up to which two of Landen's steps leave less than rounding to the series


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
