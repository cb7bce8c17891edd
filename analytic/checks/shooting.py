"""Section 3.1.2: shooting for the tip angle with the slope in Jacobi's elliptic functions."""

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipj, ellipkinc


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

    highest = min(np.pi / 2, np.pi / 2 + 2 * alpha)
    margin = 1e-9 * (highest - alpha)
    return float(brentq(height_missed, alpha + margin, highest - margin, xtol=1e-13))
