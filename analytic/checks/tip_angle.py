"""The paper's two routes to the tip's angle: section 3.1.1, quadrature, and 3.1.2, shooting."""

from collections.abc import Callable

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipj, ellipkinc


def tip_angle_by_quadrature(alpha: float, eta: float) -> float:
    """Tip angle phi_1 in Phase A as the root of eq. 12 [rad].

    Both integrals are taken in v with phi = phi_1 + (pi/2 - phi_1) v^2, which removes the
    integrand's root singularity at the tip.

    Parameters
    ----------
    alpha, eta : float
        Slope angle [rad] and height [L] of the contact.

    Returns
    -------
    float
        [rad]
    """

    def height_missed(phi_1: float) -> float:
        width = np.pi / 2 - phi_1

        def weight(v: float) -> float:
            rise = width * v * v
            # sin(phi - alpha) - sin(phi_1 - alpha) without cancellation
            difference = 2 * np.cos(phi_1 - alpha + rise / 2) * np.sin(rise / 2)
            return float(2 * width * v / np.sqrt(2 * difference))

        root_f = quad(weight, 0, 1, epsabs=1e-13)[0]
        up = quad(lambda v: weight(v) * np.sin(phi_1 + width * v * v), 0, 1, epsabs=1e-13)[0]
        return float(eta * root_f - up)

    return _tip_angle(height_missed, alpha, 1e-14)


def tip_angle_by_shooting(alpha: float, eta: float) -> float:
    """Tip angle phi_1 in Phase A by the shooting method of Will et al. [rad].

    phi(s) comes from the inverse of H_A (after eq. 12), y(1) from numerical quadrature of sin(phi).

    Parameters
    ----------
    alpha, eta : float
        Slope angle [rad] and height [L] of the contact.

    Returns
    -------
    float
        [rad]
    """

    def height_missed(phi_1: float) -> float:
        k = np.sin(np.pi / 4 - (phi_1 - alpha) / 2)
        begin = ellipkinc(np.arcsin(np.clip(np.sin(alpha / 2) / k, -1, 1)), k * k)
        root_f = ellipkinc(np.pi / 2, k * k) - begin

        def climb(s: float) -> float:
            sn = ellipj(root_f * s + begin, k * k)[0]
            return float(np.sin(alpha - np.pi / 2 + 2 * np.arccos(k * sn)))

        return float(quad(climb, 0, 1, epsabs=1e-12, epsrel=1e-12)[0] - eta)

    return _tip_angle(height_missed, alpha, 1e-13)


def _tip_angle(height_missed: Callable[[float], float], alpha: float, exact: float) -> float:
    highest = min(np.pi / 2, np.pi / 2 + 2 * alpha)
    margin = 1e-9 * (highest - alpha)
    return float(brentq(height_missed, alpha + margin, highest - margin, xtol=exact))
