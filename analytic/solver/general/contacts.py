"""States of the general vibrissa at given points of a contour."""

import numpy as np

from analytic.problem.arrays import Floats, Integers
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.solver.equilibria import equilibria
from analytic.solver.general.newton import solve
from analytic.solver.general.states import States, Vibrissa, states, with_rates

_SHARES = (4, 32)  # steps from the paper's vibrissa; the more where the fewer fail
_BALANCED = 1e-12  # L, rad


def contacts(centreline: Contour, t: Floats, vibrissa: Vibrissa) -> States:
    """The vibrissa against each contour point, tangential or at the tip.

    The paper's vibrissa against the same point is followed as it is given its curvature, its
    elastic clamp and its friction.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    t : array, shape (n,)
        Contour parameters.
    vibrissa : Vibrissa
        Its numbers.

    Returns
    -------
    States
        Of n contacts; the excess is NaN where none was found.
    """
    point = centreline.at(t)
    plain = equilibria(centreline, t)
    straight = np.where(plain.tangent, plain.arc_length - 1, plain.tip_angle - point.alpha)
    begin = np.stack([plain.root_f**2, straight], axis=1)
    found = np.full_like(begin, np.nan)
    for steps in _SHARES:
        left = np.flatnonzero(np.isnan(found[:, 1]) & np.isfinite(begin).all(axis=1))
        if left.size == 0:
            break
        z, missed = begin[left], np.zeros(left.size)
        at = ContourPoint(*(values[left] for values in point))
        for share in np.linspace(0, 1, steps + 1)[1:]:
            z, missed = _balanced(at, vibrissa.scaled(share), z)
        good = missed <= _BALANCED
        found[left[good]] = z[good]
    return states(point, found[:, 0], found[:, 1], vibrissa)


def _balanced(point: ContourPoint, vibrissa: Vibrissa, start: Floats) -> tuple[Floats, Floats]:
    """Force and excess at given points, shape (n, 2), and what they miss, shape (n,)."""

    def at(which: Integers) -> ContourPoint:
        return ContourPoint(*(values[which] for values in point))

    def misses(z: Floats, which: Integers) -> Floats:
        found = states(at(which), z[:, 0], z[:, 1], vibrissa)
        return np.stack([found.twist, found.up - found.point.eta], axis=1)

    def jacobian(z: Floats, which: Integers) -> Floats:
        _, rates = with_rates(at(which), z[:, 0], z[:, 1], vibrissa)
        return np.stack([rates.twist, rates.above], axis=1)[:, :, 1:]

    return solve(misses, jacobian, start)
