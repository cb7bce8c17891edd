"""The paper's own routes to one contact, slower than `analytic.solver`, which they check.

To the tip's angle by section 3.1.1, quadrature, and 3.1.2, shooting; and the boundary value
problems (4)-(5) and (15)-(16) by collocation.
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.integrate import quad, solve_bvp
from scipy.optimize import brentq
from scipy.special import ellipj, ellipkinc

from analytic.numerics.arrays import Floats


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


class Solution(NamedTuple):
    """The solution of the boundary value problem of one contact, dimensionless."""

    force: float
    moment: float
    reach: float  # x(s1) - x0
    arc_length: float
    slope: float  # phi at the contact [rad]


def boundary_value_problem(
    alpha: float, eta: float, tangent: bool, tolerance: float = 1e-10
) -> Solution:
    """One contact by `scipy.integrate.solve_bvp`, with the force (and in Phase B s1) unknown.

    Parameters
    ----------
    alpha, eta : float
        Slope angle [rad] and height [L] of the contact.
    tangent : bool
        Phase B, the slope given and the arc length unknown; else Phase A.
    tolerance : float
        Of the collocation's relative residual.

    Returns
    -------
    Solution
        Force, clamp moment and contact.

    Raises
    ------
    ArithmeticError
        If the collocation does not converge.
    """

    def rate(sigma: Floats, state: Floats, parameters: Floats) -> Floats:
        _, _, phi, kappa = state
        force, length = parameters[0], parameters[1] if tangent else 1.0
        slope = np.stack([np.cos(phi), np.sin(phi), kappa, force * np.cos(phi - alpha)])
        return np.asarray(length * slope)

    def misses(at_clamp: Floats, at_contact: Floats, parameters: Floats) -> Floats:
        clamped = [at_clamp[0], at_clamp[1], at_clamp[2] - np.pi / 2]
        touching = [at_contact[1] - eta, at_contact[3]]
        return np.array([*clamped, *touching, *([at_contact[2] - alpha] if tangent else [])])

    sigma = np.linspace(0, 1, 41)
    end = alpha if tangent else max(alpha, 0.2)  # a first guess
    phi = np.pi / 2 - (np.pi / 2 - end) * (2 * sigma - sigma**2)
    kappa = -2 * (np.pi / 2 - end) * (1 - sigma)
    height = np.cumsum(np.sin(phi)) / len(phi)
    guess = np.stack([np.cumsum(np.cos(phi)) / len(phi), height * eta / height[-1], phi, kappa])
    parameters = np.array([3.0, 0.8]) if tangent else np.array([3.0])
    found = solve_bvp(rate, misses, sigma, guess, p=parameters, tol=tolerance, max_nodes=20_000)
    if not found.success:
        raise ArithmeticError(f"alpha = {alpha}, eta = {eta}: {found.message}")
    x, _, slope, _ = found.y[:, -1]
    assert found.p is not None
    length = float(found.p[1]) if tangent else 1.0
    return Solution(float(found.p[0]), float(-found.y[3, 0]), float(x), length, float(slope))
