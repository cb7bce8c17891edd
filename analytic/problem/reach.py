"""What geometry alone says of a sweep: where it can touch, and where it no longer can.

Lengths here are in units of the vibrissa's length; ``centreline`` is the contour that the
vibrissa's centreline feels (`Profile.offset`).
"""

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from analytic.problem.errors import InputError
from analytic.problem.profile import Profile


def contact_range(centreline: Profile) -> tuple[float, float]:
    """The contour parameters between which the contour lies within reach, eta <= 1.

    Returns
    -------
    last, first : float
        Parameter on the far (left) side, and of the first contact: the larger root of eta = 1,
        where the tip of the straight vibrissa meets the contour.

    Raises
    ------
    InputError
        If the contour starts below the foot line, lies out of reach, or ends before its right
        side has risen to the height of the tip.
    """
    low, high = centreline.alpha_range
    bottom = min(max(0.0, low), high)
    lowest = _height(centreline, bottom)
    name = f"height of the contour ({centreline.label}) at its lowest point"
    if lowest <= 0:
        raise InputError(
            name, f"{lowest:.6g} L above the beam's radius", "above the foot line", "raise it"
        )
    if lowest >= 1:
        raise InputError(
            name, f"{lowest:.6g} L", "below the tip, 1 L", "lower it or lengthen the vibrissa"
        )
    if _height(centreline, high) < 1:
        raise InputError(
            f"right end of the contour ({centreline.label})",
            f"{_height(centreline, high):.6g} L high",
            "at least 1 L high, so that the tip touches first",
            "extend alpha_range, or place or scale the object so that it rises above the tip",
        )
    first = brentq(lambda t: _height(centreline, t) - 1, bottom, high, xtol=1e-300, rtol=1e-15)
    if _height(centreline, low) <= 1:
        return low, float(first)
    last = brentq(lambda t: _height(centreline, t) - 1, low, bottom, xtol=1e-300, rtol=1e-15)
    return float(last), float(first)


def out_of_reach(centreline: Profile) -> float:
    """The foot position, left of the contour, from which all of it is farther away than 1."""
    last, first = contact_range(centreline)

    def leftmost_foot(t: float) -> float:
        point = centreline.at(np.array(t))
        return float(point.xi - np.sqrt(max(0.0, 1 - float(point.eta) ** 2)))

    grid = np.linspace(last, first, 257)
    best = int(np.argmin([leftmost_foot(t) for t in grid]))
    bounds = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    return float(minimize_scalar(leftmost_foot, bounds=bounds, method="bounded").fun)


def _height(centreline: Profile, t: float) -> float:
    return float(centreline.at(np.array(t)).eta)
