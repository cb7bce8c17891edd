"""The boundary value problems (4)-(5) and (15)-(16) by collocation."""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_bvp

from analytic.problem.arrays import Floats


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
