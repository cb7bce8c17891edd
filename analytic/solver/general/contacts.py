"""States of the general vibrissa at given points of a contour."""

from itertools import pairwise

import numpy as np

from analytic.numerics.batches import take
from analytic.numerics.newton import solve
from analytic.problem.arrays import Floats, Integers
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.poses import along_x
from analytic.problem.reach import contact_range
from analytic.problem.rest import first_touch
from analytic.solver.equilibria import equilibria
from analytic.solver.general.path import Path, follow
from analytic.solver.general.states import States, Vibrissa, states, with_rates

_STEPS = 8  # from the paper's vibrissa
_BALANCED = 1e-12  # L, rad


def contacts(contour: Contour, t: Floats, vibrissa: Vibrissa) -> States:
    """The vibrissa against each contour point, tangential or at the tip."""
    reach = contact_range(contour)
    touch = first_touch(contour, reach, vibrissa.at_rest.shape)
    path = follow(contour, vibrissa, touch, reach, along_x(vibrissa.clamp_angle))
    z = _solved(contour, vibrissa, path, t)
    return states(contour.at(t), z[:, 0], z[:, 1], vibrissa)


def _solved(contour: Contour, vibrissa: Vibrissa, path: Path, t: Floats) -> Floats:
    """Force and excess at each contour parameter, shape (n, 2); NaN where there is no contact."""
    point = contour.at(t)
    z, missed = _balanced(point, vibrissa, _on_path(path, t))
    left = np.flatnonzero(~(missed <= _BALANCED))
    if left.size:
        at = take(point, left)
        z[left], missed[left] = _from_plain(contour, t[left], at, vibrissa)
    z[~(missed <= _BALANCED)] = np.nan
    return z


def _on_path(path: Path, t: Floats) -> Floats:
    """Force and excess of a path's last place of each contour parameter, shape (n, 2), or NaN."""
    cells = np.full(len(t), -1)
    for i, (begin, end) in enumerate(pairwise(path.z[:, 0])):
        if begin != end:
            cells[(t - begin) * (t - end) <= 0] = i
    found = np.full((len(t), 2), np.nan)
    on = cells >= 0
    found[on] = path.at(cells[on], path.share(cells[on], t[on], 0))[:, 1:3]
    return found


def _from_plain(
    contour: Contour, t: Floats, point: ContourPoint, vibrissa: Vibrissa
) -> tuple[Floats, Floats]:
    """Force and excess, shape (n, 2), and what they miss, followed from the paper's vibrissa."""
    plain = equilibria(contour, t).states(Vibrissa())
    z = np.stack([plain.force, plain.excess], axis=1)
    missed = np.where(np.isfinite(z).all(axis=1), 0.0, np.inf)
    for share in np.linspace(0, 1, _STEPS + 1)[1:]:
        held = np.flatnonzero(missed <= _BALANCED)
        if held.size == 0:
            break
        at = take(point, held)
        z[held], missed[held] = _balanced(at, vibrissa.scaled(share), z[held])
    return z, missed


def _balanced(point: ContourPoint, vibrissa: Vibrissa, start: Floats) -> tuple[Floats, Floats]:
    """Force and excess at given points, shape (n, 2), and what they miss, shape (n,)."""

    def misses(z: Floats, which: Integers) -> Floats:
        found = states(take(point, which), z[:, 0], z[:, 1], vibrissa)
        return np.stack([found.slope_residual, found.height_residual], axis=1)

    def jacobian(z: Floats, which: Integers) -> Floats:
        return with_rates(take(point, which), z[:, 0], z[:, 1], vibrissa)[1][:, :2, 1:]

    return solve(misses, jacobian, start)
