"""Phase A: how far the tip has turned that rests on a contour point of given slope and height."""

import numpy as np

from analytic.problem.arrays import Floats
from analytic.solver.elastica import frame, least_rotation, span, span_by_excess

_MAX_ITERATIONS = 60  # bisection alone would halve the bracket to round-off in 53


def tip_height(excess: Floats, alpha: Floats) -> Floats:
    """Height of a loaded tip above the foot line.

    Parameters
    ----------
    excess, alpha : array, shape (n,)
        Excess rotation of the tip and slope angle of the contour there [rad].

    Returns
    -------
    array, shape (n,)
        [L]
    """
    loaded = span(excess, alpha)
    return frame(loaded, alpha).up / loaded.q


def greatest_height(alpha: Floats) -> Floats:
    """Height of the tip whose excess rotation is zero: contour points above are out of reach.

    Parameters
    ----------
    alpha : array, shape (n,)
        Slope angle of the contour [rad].

    Returns
    -------
    array, shape (n,)
        [L]
    """
    bent = np.minimum(alpha, -1e-300)  # for alpha >= 0 the vibrissa is straight, of height 1
    return np.where(alpha < 0, tip_height(np.zeros_like(bent), bent), 1.0)


def tip_excess(alpha: Floats, eta: Floats) -> Floats:
    """Excess rotation w of the tip of a vibrissa that touches at slope `alpha` and height `eta`.

    The height falls steadily as the tip turns, from `greatest_height` to tangential contact, and
    sqrt(1 - height) is nearly proportional to the rotation (0.516 u at alpha > 0, 0.5 u at
    alpha = 0): Newton's method on it needs a few steps, and a bracket keeps it safe. Its unknown is
    p = sqrt(sin(w/2)), in which the height is smooth even where the clamp moment vanishes.

    Parameters
    ----------
    alpha, eta : array, shape (n,)
        Slope angle [rad] and height of the contour points, not below tangential contact.

    Returns
    -------
    array, shape (n,)
        [rad]; NaN where the point is out of reach: no vibrissa that bends one way ends there.
    """
    sag = np.sqrt(np.maximum(1 - eta, 0.0))
    low = np.zeros_like(alpha)
    # A little beyond tangential contact, where nothing is singular: a root there stays inside.
    high = np.sqrt(np.sin((np.pi / 2 - np.abs(alpha)) / 2)) * (1 + 1e-6)
    guess = np.maximum(sag / 0.49 - least_rotation(alpha), 1e-3 * sag)
    p = np.minimum(np.sqrt(np.sin(np.minimum(guess, 1.0) / 2)), high)

    excess = np.full_like(alpha, np.nan)
    # Against an upright side (high = 0) the vibrissa is straight and carries no load.
    active = np.flatnonzero((eta < greatest_height(alpha)) & (high > 0))
    for _ in range(_MAX_ITERATIONS):
        if active.size == 0:
            break
        old, slope_angle = p[active], alpha[active]
        w = 2 * np.arcsin(old**2)
        loaded = span(w, slope_angle)
        height = frame(loaded, slope_angle).up / loaded.q
        rates = span_by_excess(loaded, w, slope_angle)
        fall = (height * rates.q - frame(rates, slope_angle).up) / loaded.q
        reached = np.sqrt(np.maximum(1 - height, 0.0))
        deviation = reached - sag[active]
        low[active] = np.where(deviation < 0, old, low[active])
        high[active] = np.where(deviation > 0, old, high[active])
        new = old - deviation * reached * np.sqrt(1 - old**4) / (2 * old * fall)
        inside = (new >= low[active]) & (new <= high[active])
        new = np.where(inside, new, (low[active] + high[active]) / 2)
        p[active] = new
        # After such a step of Newton's the next would change round-off only; halving goes on.
        done = np.abs(new - old) <= np.where(inside, 1e-9, 1e-15) * new
        excess[active[done]] = 2 * np.arcsin(new[done] ** 2)
        active = active[~done]
    excess[active] = 2 * np.arcsin(p[active] ** 2)  # halved to rounding
    return excess
