"""The states of the general vibrissa at given poses of its clamp."""

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.newton import solve
from analytic.problem.clamp_path import Pose, Poses
from analytic.problem.contours.contour import Contour
from analytic.solver.general.balance import misses, rates_at, states_at
from analytic.solver.general.pair import Pair
from analytic.solver.general.path import Path, refined
from analytic.solver.general.states import States, Vibrissa

_NEAR = 0.5  # of a cell's length: by how much its interpolation may err
_ASIDE = 1e-6  # a state may lie so far beyond its cell: close to a fold p does not distinguish
_MANY = 2000  # states: a finer path pays; so many at a time stay in the processor's cache
_BALANCED = 1e-11  # L, rad; beyond, no state was found


def solve_beside(
    contour: Contour, vibrissa: Vibrissa, pose: Pose, z: Floats, slopes: Floats
) -> States:
    """States next to those of a problem that is solved, by one step of Newton's method."""
    missed = misses(states_at(contour, z, vibrissa), pose)
    z = z - np.linalg.solve(slopes, missed[..., None])[..., 0]
    z[:, 1] = np.maximum(z[:, 1], 0.0)
    return states_at(contour, z, vibrissa)


def solve_near(
    contour: Contour | Pair,
    vibrissa: Vibrissa,
    pose: Pose,
    start: Floats,
    slopes: Floats | None = None,
) -> tuple[Floats, Booleans]:
    """Contour parameter, force and excess in each pose, and whether in balance."""

    def missed_at(z: Floats, which: Integers) -> Floats:
        here = Pose(*(values[which] for values in pose))
        return misses(states_at(contour, z, vibrissa), here)

    def jacobian(z: Floats, which: Integers) -> Floats:
        return rates_at(contour, z, vibrissa)[1] if slopes is None else slopes[which]

    z, missed = solve(missed_at, jacobian, start)
    return z, missed <= _BALANCED * np.maximum(1.0, np.abs(pose.foot_x))


def solve_places(path: Path, poses: Poses, p: Floats) -> tuple[Floats, Booleans]:
    """Contour parameter, force and excess of the state at each parameter of the clamp's way."""
    if len(p) <= _MANY:
        return _solve_few(path, poses, p)
    path, slopes = refined(path, poses)
    parts = [
        _solve_few(path, poses, few, slopes[..., :-1])
        for few in np.array_split(p, 1 + len(p) // _MANY)
    ]
    z, found = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    return z, found


def _solve_few(
    path: Path, poses: Poses, p: Floats, slopes: Floats | None = None
) -> tuple[Floats, Booleans]:
    cells = path.cells(p)
    share = path.share(cells, p, -1)
    guess, between = path.at(cells, share), None
    if slopes is not None:
        between = slopes[cells] + share[:, None, None] * (slopes[cells + 1] - slopes[cells])
    begin, way, length = path.z[cells], path.z[cells + 1] - path.z[cells], path.length(cells)
    contour, vibrissa = path.contour, path.vibrissa
    scale = vibrissa.sizes(begin)

    z, balanced = solve_near(contour, vibrissa, poses.at(p), guess[:, :-1], between)
    there = np.column_stack([z, p])
    along = np.einsum("nk,nk->n", (there - begin) / scale, way / scale) / length
    strayed = np.linalg.norm((there - guess) / scale, axis=1)
    found = balanced & (vibrissa.side(z[:, 2]) == path.side[cells])
    found &= strayed <= _NEAR * length + _ASIDE
    found &= (along >= -_ASIDE) & (along <= length + _ASIDE)  # not beyond a fold
    return z, found
