"""One signature laid over a disagreement: how large it is, and what it leaves."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Floats


class Fitted(NamedTuple):
    """The best size of a signature."""

    size: float
    left: float
    """Sum of squares that it leaves."""
    fraction: float
    """Of the disagreement's sum of squares that it accounts for."""


class Explanation(NamedTuple):
    """One mistake or fault, as it fits a disagreement best."""

    text: str
    """What it is, with its size."""
    left: float
    """Sum of squares that it leaves."""
    sizes: int = 1
    """How many numbers were fitted."""
    size: float = 0.0
    """The one that was, if it is one."""


def fitted(error: Floats, signature: Floats) -> Fitted:
    """Fit the size of `signature` to `error` by least squares."""
    known = np.isfinite(signature).all(axis=0)
    s, e = signature[:, known].ravel(), error[:, known].ravel()
    weight, all_ = float(s @ s), float(e @ e)
    size = float(s @ e) / weight if weight > 0 else 0.0
    left = float(np.sum((e - size * s) ** 2))
    return Fitted(size, left, 1 - left / all_ if all_ > 0 else 0.0)
