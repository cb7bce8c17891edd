"""Section 3.1.1: substitution of variable, eq. 12 by numerical quadrature."""

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq


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

    highest = min(np.pi / 2, np.pi / 2 + 2 * alpha)
    margin = 1e-9 * (highest - alpha)
    return float(brentq(height_missed, alpha + margin, highest - margin, xtol=1e-14))
