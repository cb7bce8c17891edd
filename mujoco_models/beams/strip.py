"""Vertices of the beams that MuJoCo builds from a row of points."""

import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.settings import Settings


def half_cell_off(settings: Settings) -> Floats:
    """Arc lengths of the vertices of N equal segments, shape (N + 1,) [L].

    The first segment is rigid in the clamp. If it straddles the clamp, from -h/2 to +h/2, the
    vertices that bend sit at the centres of their cells, and the beam is of second order; if it
    begins there (the naive beam), it is of first order.
    """
    n = settings.segments
    if settings.clamp == "second-order":
        return np.asarray((np.arange(n + 1) - 0.5) / (n - 0.5))
    return np.asarray(np.arange(n + 1) / n)
