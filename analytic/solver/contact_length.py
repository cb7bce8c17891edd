"""How long the loaded part of a vibrissa is in tangential contact, and where along a contour."""

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.solver.equilibria import tangent_contact


def surplus(contour: Contour, t: Floats) -> Floats:
    """1 - 1/s1 with s1 of eq. 21 (Will et al.): negative in Phase B, smooth at the pole of s1.

    Parameters
    ----------
    contour : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    t : array, shape (n,)
        Contour parameters.

    Returns
    -------
    array, shape (n,)
        Dimensionless.
    """
    return surplus_and_rate(contour.at(t))[0]


def surplus_and_rate(point: ContourPoint) -> tuple[Floats, Floats]:
    """`surplus`, and its derivative along the contour."""
    states = tangent_contact(point)
    alpha, _, eta, turning, stretch = states.point
    up, across = states.frame
    q, C, _ = states.span
    with np.errstate(divide="ignore", invalid="ignore"):  # straight, against an upright side
        value = np.where(q == 0, 1 - 1 / eta, 1 - states.root_f / q)
        by_alpha = (across - 1 / C + up / (C * q)) / (eta * q)
        rate = states.root_f / q * stretch * np.sin(alpha) / eta - turning * by_alpha
    return value, np.where(q == 0, np.nan, rate)
