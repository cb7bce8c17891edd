"""What states of one contact, or of a pair of them, miss on a way of the clamp."""

import numpy as np

from analytic.numerics.arrays import Floats
from analytic.problem.clamp_path import Pose, Poses
from analytic.problem.contours.contour import Contour
from analytic.solver.general.pair import Pair
from analytic.solver.general.states import States, Vibrissa, states, with_rates


def states_at(contour: Contour | Pair, z: Floats, vibrissa: Vibrissa) -> States:
    """The states of given contour parameter, force and excess, (n, 3), or of two contacts."""
    if isinstance(contour, Pair):
        return contour.states(z, vibrissa)
    return states(contour.at(z[:, 0]), z[:, 1], z[:, 2], vibrissa)


def rates_at(contour: Contour | Pair, z: Floats, vibrissa: Vibrissa) -> tuple[States, Floats]:
    """`states_at`, and the derivatives of what they miss by the same numbers, shape (n, k, k)."""
    if isinstance(contour, Pair):
        return contour.rates(z, vibrissa)
    return with_rates(contour.at(z[:, 0]), z[:, 1], z[:, 2], vibrissa)


def misses(found: States, pose: Pose) -> Floats:
    """What states miss in poses: angle, height and place, (n, 3), and at a second contact."""
    missed = [
        found.angle - pose.angle,
        found.height_residual + pose.foot_y,
        found.foot_x - pose.foot_x,
    ]
    inner = () if found.inner is None else found.inner.missed
    return np.stack([*missed, *inner], axis=1)


def balance(
    contour: Contour | Pair, vibrissa: Vibrissa, poses: Poses, z: Floats
) -> tuple[Floats, Floats, States]:
    """What states on a way of the clamp miss, and the derivatives by their numbers and its own."""
    here, rates = rates_at(contour, z[:, :-1], vibrissa)
    pose, rate = poses.at(z[:, -1]), poses.rate(z[:, -1])
    by_p = np.zeros((*rates.shape[:2], 1))
    by_p[:, :3, 0] = np.stack([-rate.angle, rate.foot_y, -rate.foot_x], axis=1)
    return misses(here, pose), np.concatenate([rates, by_p], axis=2), here
