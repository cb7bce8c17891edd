"""The unloaded vibrissa of constant natural curvature, an arc, and what it touches first."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.contours.contour import Contour
from analytic.problem.errors import InputError
from analytic.problem.roots import zeros

_SAMPLES = 513  # of the contour, between which its distance from the arc has one minimum


class Touch(NamedTuple):
    """The first contact, unloaded; dimensionless."""

    t: float
    """Contour parameter."""
    excess: float
    """phi1 - alpha >= 0 at the tip, s1 - 1 < 0 elsewhere."""
    foot_x: float


def arc(natural: float, s: Floats) -> tuple[Floats, Floats, Floats]:
    """The unloaded vibrissa.

    Parameters
    ----------
    natural : float
        Natural curvature [1/L].
    s : array, any shape
        Arc length from the clamp [L].

    Returns
    -------
    x, y, phi : array, shape of `s`
        Position as seen from the foot [L], slope angle [rad].
    """
    turn = natural * s
    half = np.sinc(turn / 2 / np.pi)  # sin(u/2)/(u/2)
    chord = s * half
    return -chord * np.sin(turn / 2), chord * np.cos(turn / 2), np.pi / 2 + turn


def first_touch(centreline: Contour, reach: tuple[float, float], natural: float) -> Touch:
    """What the unloaded vibrissa touches first when its foot comes from the right.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    reach : tuple of float
        Contour parameters of the leftmost and the rightmost point not above the length.
    natural : float
        Natural curvature, less than pi/2 [1/L].

    Returns
    -------
    Touch
        At the tip, or tangential.

    Raises
    ------
    InputError
        If the vibrissa at rest passes below the object.
    """
    _, tip_y, tip_angle = (float(v) for v in arc(natural, np.array(1.0)))
    first = reach[1]
    lowest = float(centreline.parameter(np.zeros(1))[0])

    def height(t: Floats) -> Floats:
        return centreline.at(t).eta

    ends = np.array([lowest]), np.array([first])
    if height(ends[0])[0] >= tip_y:
        raise InputError(
            f"height of the lowest point of the object ({centreline.label}), less the radius,",
            f"{height(ends[0])[0]:.6g} L",
            f"below {tip_y:.6g} L, the tip of the vibrissa at rest",
            "lower the object or lessen the natural curvature",
        )
    top = (
        first
        if height(ends[1])[0] <= tip_y
        else float(zeros(lambda t: height(t) - tip_y, *ends)[0])
    )

    def arc_length(t: Floats) -> Floats:
        """Arc length at which the vibrissa is as high as the contour at t."""
        with np.errstate(invalid="ignore"):
            turn = np.arcsin(np.clip(natural * height(t), -1, 1))
        return np.where(natural == 0, height(t), turn / (natural or 1.0))

    def lean(t: Floats) -> Floats:
        """Positive where the contour is steeper than the vibrissa beside it."""
        return centreline.at(t).alpha - np.pi / 2 - natural * arc_length(t)

    grid = np.linspace(top, lowest, _SAMPLES)
    steep = lean(grid)
    at_tip = top < first or height(ends[1])[0] >= tip_y * (1 - 1e-15)
    if not at_tip and steep[0] < 0:
        raise InputError(
            "beam.natural_curvature",
            f"{natural:.6g}/L",
            "such that the vibrissa at rest does not lean over the object from its upper side "
            f"({centreline.label})",
            "lessen it; only the object's lower side can be touched",
        )
    crossings = np.flatnonzero((steep[:-1] > 0) & (steep[1:] <= 0))
    tangents = zeros(lean, grid[crossings + 1], grid[crossings])
    places = np.append(top, tangents)
    lengths = arc_length(places)
    lengths[0] = 1.0 if at_tip else lengths[0]
    point = centreline.at(places)
    feet = point.xi - arc(natural, lengths)[0]
    best = int(np.argmax(feet))
    excess = float(lengths[best] - 1)
    if best == 0 and at_tip:
        excess = max(tip_angle - float(point.alpha[0]), 0.0)
    return Touch(float(places[best]), excess, float(feet[best]))
