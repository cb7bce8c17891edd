"""Vertices of the beams that MuJoCo builds from a row of points."""

import numpy as np

from analytic.problem.arrays import Floats
from mujoco_models.settings import Settings


def vertices(settings: Settings, grading: float = 0.0) -> Floats:
    """Arc lengths of the vertices of N segments, shape (N + 1,) [L].

    The first segment is rigid in the clamp. If it straddles the clamp, as much before it as behind,
    the vertices that bend sit at the centres of their cells, and the beam is of second order; if it
    begins there (the naive beam), it is of first order.

    Parameters
    ----------
    settings : Settings
        Number of segments, and which clamp.
    grading : float
        How much longer segments grow towards the tip: by (1 + 3 grading) from the clamp on. The
        naive beam has equal ones.
    """
    n = settings.segments
    if settings.clamp == "naive":
        return np.asarray(np.arange(n + 1) / n)
    # An odd and smooth map of equal segments: it keeps the symmetry at the clamp, and the order.
    u = (np.arange(n + 1) - 0.5) / (n - 0.5)
    return np.asarray(u * (1 + grading * u**2) / (1 + grading))
