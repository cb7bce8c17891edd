"""The exact cantilever under a dead load on its tip, across its undeformed axis."""

import math

import numpy as np
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from analytic.problem.arrays import Floats


def tip_of(loads: Floats) -> Floats:
    """Where the tip of the inextensible elastica is.

    K. E. Bisshopp, D. C. Drucker, Large deflection of cantilever beams, Quarterly of Applied
    Mathematics 3 (1945), equations (8) to (13).
    """
    return np.array([_tip(math.sqrt(load)) for load in np.asarray(loads, dtype=float).tolist()])


def _tip(alpha: float) -> tuple[float, float]:
    """Of alpha = sqrt(P L^2/EI); the tip's slope is found from the length."""
    from scipy.optimize import brentq  # slow to load

    def length(slope: float) -> float:
        m, start = _modulus(slope)
        return float(ellipk(m) - ellipkinc(start, m)) - alpha

    slope = brentq(length, 1e-14, math.pi / 2 - 1e-14, xtol=1e-15)
    m, start = _modulus(slope)
    across = 1 - 2 * float(ellipe(m) - ellipeinc(start, m)) / alpha
    return across, 1 - math.sqrt(2 * math.sin(slope)) / alpha


def _modulus(slope: float) -> tuple[float, float]:
    """Parameter m = k^2 and the amplitude at the clamp, of the tip's slope."""
    m = (1 + math.sin(slope)) / 2
    return m, math.asin(1 / math.sqrt(2 * m))
