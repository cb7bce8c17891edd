"""The states of the general vibrissa at given foot positions."""

import numpy as np

from analytic.numerics.newton import solve
from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.contour import Contour
from analytic.solver.general.path import Path
from analytic.solver.general.states import States, Vibrissa, states_at, with_rates

_NEAR = 0.5  # of a cell's length: by how much its interpolation may err
_ASIDE = 1e-6  # a state may lie so far beyond its cell: close to a fold x0 does not distinguish
_BALANCED = 1e-11  # L, rad; beyond, no state was found


def solve_beside(
    contour: Contour, vibrissa: Vibrissa, foot_x: Floats, z: Floats, slopes: Floats
) -> States:
    """States next to those of a problem that is solved, by one step of Newton's method."""
    missed = _misses(contour, vibrissa, foot_x, z)
    z = z - np.linalg.solve(slopes, missed[..., None])[..., 0]
    z[:, 1] = np.maximum(z[:, 1], 0.0)
    return states_at(contour, z, vibrissa)


def slopes_at(contour: Contour, vibrissa: Vibrissa, z: Floats) -> Floats:
    """Derivatives of what states miss and of their foot positions."""
    _, rates = with_rates(contour.at(z[:, 0]), z[:, 1], z[:, 2], vibrissa)
    return np.stack(rates, axis=1)


def _misses(contour: Contour, vibrissa: Vibrissa, foot_x: Floats, z: Floats) -> Floats:
    """What states miss at the clamp's slope, at the contact's height and at the foot."""
    here = states_at(contour, z, vibrissa)
    return np.stack([here.slope_residual, here.height_residual, here.foot_x - foot_x], axis=1)


def solve_near(
    contour: Contour, vibrissa: Vibrissa, foot_x: Floats, start: Floats
) -> tuple[Floats, Booleans]:
    """Contour parameter, force and excess at each foot position, and whether in balance."""

    def misses(z: Floats, which: Integers) -> Floats:
        return _misses(contour, vibrissa, foot_x[which], z)

    def jacobian(z: Floats, which: Integers) -> Floats:
        return slopes_at(contour, vibrissa, z)

    z, missed = solve(misses, jacobian, start)
    return z, missed <= _BALANCED * np.maximum(1.0, np.abs(foot_x))


def solve_places(
    contour: Contour, vibrissa: Vibrissa, path: Path, foot_x: Floats
) -> tuple[Floats, Booleans]:
    """Contour parameter, force and excess of the state at each foot position on the path.

    Newton's method starts from the cubic through the path's points and directions.
    """
    cells = path.cells(foot_x)
    guess = path.at(cells, path.share(cells, foot_x, None))
    begin, way, length = path.z[cells], path.z[cells + 1] - path.z[cells], path.length(cells)
    scale = np.ones_like(begin)
    scale[:, 1] = np.maximum(vibrissa.least_force, begin[:, 1])

    z, balanced = solve_near(contour, vibrissa, foot_x, guess)
    along = np.einsum("nk,nk->n", (z - begin) / scale, way / scale) / length
    strayed = np.linalg.norm((z - guess) / scale, axis=1)
    found = balanced & (vibrissa.side(z[:, 2]) == path.side[cells])
    found &= strayed <= _NEAR * length + _ASIDE
    found &= (along >= -_ASIDE) & (along <= length + _ASIDE)  # not beyond a fold
    return z, found
