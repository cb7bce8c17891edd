"""A panel of a vibrissa that varies: what polynomials through its nodes integrate there."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from analytic.numerics.arrays import Floats

NODES = 12  # of Gauss and Legendre on a panel
POINTS, WEIGHTS = (v / 2 for v in legendre.leggauss(NODES))
POINTS = POINTS + 0.5  # from 0 to 1
TO_SERIES = np.linalg.inv(legendre.legvander(2 * POINTS - 1, NODES - 1))
_SHARES = np.concatenate([[0.0], POINTS, [1.0]])[:, None]


def _integrals() -> Floats:
    """Integrals of the nodes' polynomials from 0 to each node."""
    columns = [legendre.legval(2 * POINTS - 1, legendre.legint(c, lbnd=-1)) for c in TO_SERIES.T]
    return np.array(columns).T / 2


TO_NODES = _integrals()
_TO_ALL = np.vstack([TO_NODES, WEIGHTS])  # and to the end


class Panel(NamedTuple):
    """A part of n vibrissae, or k = 1 that is the same for all; integrals begin where it does."""

    length: Floats  # shape (k,) [L]; negative on the way to the clamp
    s: Floats  # arc lengths of the nodes, shape (NODES, k) [L]
    natural: Floats
    flexible: Floats  # natural curvature and EI(0)/EI at both ends, shape (2, k)
    rest: Floats
    # by how much natural curvature, and a moment of 1, turn nodes and end, (NODES + 1, k) [rad]
    bend: Floats
    give: Floats  # EI(0)/EI at the nodes, times the length squared, shape (NODES, k)
    # what integrates twice, with that between, shape (NODES + 1, NODES), if k is 1.
    twice: Floats | None

    @classmethod
    def between(
        cls,
        begin: Floats,
        end: Floats,
        flexibility: Callable[[Floats], Floats],
        curvature: Callable[[Floats], Floats],
    ) -> "Panel":
        length = end - begin
        s = begin + _SHARES * length
        flexible, natural = flexibility(s), curvature(s)
        give = length * length * flexible[1:-1]
        return cls(
            length,
            s[1:-1],
            natural[[0, -1]],
            flexible[[0, -1]],
            length * _TO_ALL.dot(natural[1:-1]),
            length * _TO_ALL.dot(flexible[1:-1]),
            give,
            _TO_ALL.dot(give * TO_NODES) if length.size == 1 else None,
        )

    def turned(self, pull: Floats) -> Floats:
        """By how much a pull across the vibrissa turns nodes and end."""
        if self.twice is not None:
            return np.asarray(self.twice.dot(pull))
        return np.asarray(_TO_ALL.dot(self.give * TO_NODES.dot(pull)))
