"""A damped step down an energy that keeps off what bars it."""

import numpy as np
from scipy.optimize import nnls

from analytic.numerics.arrays import Floats


def barring_forces(compliance: Floats, gaps: Floats, singular: float) -> Floats:
    """The forces f >= 0 that keep gaps + compliance . f >= 0 where they act, by least squares."""
    root = np.linalg.cholesky(compliance + singular * np.eye(len(gaps)))
    forces, _ = nnls(root.T, -np.linalg.solve(root, gaps))
    return np.asarray(forces)
