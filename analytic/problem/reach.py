"""What geometry alone says of a sweep: where it can touch, and where it no longer can.

Lengths here are in units of the vibrissa's length; ``centreline`` is the contour that the
vibrissa's centreline feels (`Contour.offset`).
"""

import numpy as np

from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.roots import zeros

FARTHEST = 1e4  # L, from the origin: positions are then good to 2e-12 L
_WIDEST = 1e3  # L; a wider object turns by less than 1e-3 rad while the vibrissa passes


def contact_range(centreline: Contour) -> tuple[float, float]:
    """The contour parameters between which the contour lies within reach, eta <= 1.

    Parameters
    ----------
    centreline : Contour
        What the vibrissa's centreline feels [L].

    Returns
    -------
    last, first : float
        Parameter on the far (left) side, and of the first contact. That is where the tip of the
        straight vibrissa meets the contour, the larger root of eta = 1; or, if the object ends
        below the tip, its right end, which the side of the straight vibrissa meets.

    Raises
    ------
    InputError
        If the contour starts below the foot line, lies out of reach, or is so wide or so far away
        that it is lost in rounding.
    """
    low, high = centreline.t_range
    bottom = float(centreline.parameter(np.array([0.0]))[0])
    lowest = _height(centreline, bottom)
    name = f"height of the lowest point of the object ({centreline.label}), less the beam's radius,"
    if lowest <= 0:
        raise InputError(name, f"{lowest:.6g} L", "above the foot line, y = 0", "raise the object")
    if lowest >= 1:
        raise InputError(
            name,
            f"{lowest:.6g} L",
            "below 1 L, the tip of the vibrissa",
            "lower the object or lengthen the vibrissa",
        )
    ends = _height_one(centreline, low, bottom, high)
    _check_place(centreline, ends)
    return ends


def out_of_reach(centreline: Contour, last: float, first: float) -> float:
    """The foot position, left of the contour, from which all of it is farther away than 1.

    Parameters
    ----------
    centreline : Contour
        What the vibrissa's centreline feels [L].
    last, first : float
        Contour parameters, those of `contact_range`.

    Returns
    -------
    float
        Foot position [L].
    """
    from scipy.optimize import minimize_scalar  # slow to load, and stating a case needs none of it

    def leftmost_foot(t: float) -> float:
        point = centreline.at(np.array([t]))
        return float(point.xi[0] - np.sqrt(max(0.0, 1 - float(point.eta[0]) ** 2)))

    grid = np.linspace(last, first, 257)
    points = centreline.at(grid)
    best = int(np.argmin(points.xi - np.sqrt(np.maximum(0.0, 1 - points.eta**2))))
    bounds = grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    return float(minimize_scalar(leftmost_foot, bounds=bounds, method="bounded").fun)


def _check_place(centreline: Contour, ends: tuple[float, float]) -> None:
    left, right = (float(x) for x in centreline.at(np.array(ends)).xi)
    if right - left > _WIDEST:
        raise InputError(
            f"width of the object within reach ({centreline.label})",
            f"{right - left:.6g} L",
            f"at most {_WIDEST:g} L",
            "the vibrissa feels a straight wall: check the units, or cut a part out",
        )
    if not max(abs(left), abs(right)) <= FARTHEST:
        raise InputError(
            f"place of the object ({centreline.label})",
            f"x from {left:.6g} L to {right:.6g} L",
            f"within {FARTHEST:g} L of the origin",
            "move the origin to the object, or check the units of object and beam",
        )


def _height_one(centreline: Contour, low: float, bottom: float, high: float) -> tuple[float, float]:
    """Where the contour passes the height 1 on both sides of its lowest point, or its ends."""
    outer = np.array([low, high])
    above = np.flatnonzero(centreline.at(outer).eta > 1)
    outer[above] = zeros(
        lambda _, t: centreline.at(t).eta - 1,
        np.where(above == 0, low, bottom),
        np.where(above == 0, bottom, high),
    )
    return float(outer[0]), float(outer[1])


def _height(centreline: Contour, t: float) -> float:
    return float(centreline.at(np.array([t])).eta[0])
