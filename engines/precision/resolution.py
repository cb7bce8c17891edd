"""What single precision can make of a contact's depth, before anything is computed with it.

A sphere's depth in a cylinder is the difference of numbers as large as the cylinder's radius, and
its place the end of a chain of sums. Each of these is rounded to a multiple of the spacing of
float32 there, so it is off by a number that is equally likely anywhere in one spacing: its standard
deviation is the spacing over sqrt(12) (Higham, Accuracy and Stability of Numerical Algorithms,
2002, section 2.8). The errors add up as independent ones do. Nothing here is fitted.
"""

import numpy as np
from scipy.stats import multivariate_normal, norm

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.model.model import BeamModel

# rad; a product of unit quaternions rounds each of two components three times, to half of 2**-24
# at most, and an angle is off by twice the component across: 2 sqrt(3) 2**-24 / sqrt(12).
_TURN = 2.0**-24
_CERTAIN = 5.0  # standard deviations; a depth is not off by more


def covariance(model: BeamModel, normal: Floats, beads: Integers) -> Floats:
    """Of the depths in single precision.

    Neighbours share most of what is rounded: the cylinder's radius and place, the joints before
    them and the turns there. Only their own places and distances are rounded apart.
    """
    obstacle, layout = model.obstacle, model.layout
    centre, radius = obstacle.circle(model.lookout.window)  # type: ignore[attr-defined]
    joints, places = model.joint_positions(), model.bead_positions(beads)
    own = model.radius * layout.vibrissa.thickness(layout.beads[beads])
    carried = np.arange(len(joints)) <= layout.links[beads][:, None]
    arms = carried * ((places[:, None] - joints) @ across(normal)[:, :, None])[:, :, 0]
    # A column for each number that is rounded, a row for each depth: how much it counts there.
    shared = [
        np.full((len(beads), 1), _spacing(radius)),
        normal * _spacing(centre),
        carried * normal[:, :1] * _spacing(joints[:, 0]),
        carried * normal[:, 1:] * _spacing(joints[:, 1]),
        np.sqrt(12) * _TURN * arms,
    ]
    distance = np.hypot(*(places - centre).T)
    apart = [*(normal * _spacing(places)).T, *_spacing([own, distance, radius + own])]
    counts = np.hstack(shared)
    return np.asarray(counts @ counts.T + np.diag(np.square(apart).sum(axis=0))) / 12


def across(normal: Floats) -> Floats:
    """How a turn of a lever shifts its end along the normal."""
    return np.column_stack([normal[:, 1], -normal[:, 0]])


def chance_of_loss(depth: Floats, together: Floats) -> float:
    """How likely it is that none of the contacts is seen."""
    deviation = np.sqrt(np.diag(together))
    uncertain = depth > -_CERTAIN * deviation
    if (depth > _CERTAIN * deviation).any():
        return 0.0
    scale = deviation[uncertain]
    correlation = together[np.ix_(uncertain, uncertain)] / np.outer(scale, scale)
    # A seed of its own: the integral is one over random places.
    normal = multivariate_normal(cov=correlation, allow_singular=True, seed=0)
    return float(normal.cdf(-depth[uncertain] / scale))


def force_deviation(depth: Floats, deviation: Floats) -> Floats:
    """How far off the force of a contact is, over its stiffness: the rms of max(depth, 0)."""
    ratio, held = depth / deviation, np.maximum(depth, 0)
    mean = depth * norm.cdf(ratio) + deviation * norm.pdf(ratio)
    square = (depth**2 + deviation**2) * norm.cdf(ratio) + depth * deviation * norm.pdf(ratio)
    return np.asarray(np.sqrt(np.maximum(square - 2 * held * mean + held**2, 0)))


def _spacing(numbers: object) -> Floats:
    """Of float32 at these numbers."""
    return np.spacing(np.abs(np.asarray(numbers, dtype=np.float32))).astype(float)
