"""The elastica integrated from the clamp: what the closed forms are checked against."""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from analytic.problem.arrays import Floats


class End(NamedTuple):
    """The state at the end of each span, shape (n,): position, slope angle, curvature."""

    x: Floats
    y: Floats
    phi: Floats
    kappa: Floats


def integrate_span(
    force_x: Floats, force_y: Floats, moment: Floats, length: Floats, tolerance: float = 1e-13
) -> End:
    """March from the clamp along the loaded span (paper, eqs. 4 and 15), no elliptic integral used.

    The initial value problem of section 5 takes kappa from a square root that vanishes at the
    contact, where its solution is not unique; kappa' = f cos(phi - alpha) is smooth throughout.

    Parameters
    ----------
    force_x, force_y, moment : array, shape (n,)
        The clamp's action on the vibrissa, dimensionless.
    length : array, shape (n,)
        Arc length up to the contact [L].
    tolerance : float
        Relative and absolute, of the Dormand-Prince method of order 8.

    Returns
    -------
    End
        Positions relative to the foot [L].
    """
    n = len(moment)

    def rate(_: float, state: Floats) -> Floats:
        phi, kappa = state.reshape(4, n)[2:]
        cos, sin = np.cos(phi), np.sin(phi)
        return np.concatenate(
            [length * cos, length * sin, length * kappa, length * (force_y * cos - force_x * sin)]
        )

    start = np.concatenate([np.zeros(2 * n), np.full(n, np.pi / 2), -moment])
    found = solve_ivp(
        rate, (0.0, 1.0), start, method="DOP853", rtol=tolerance, atol=tolerance, t_eval=[1.0]
    )
    return End(*found.y[:, -1].reshape(4, n))
