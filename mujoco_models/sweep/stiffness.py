"""The stiffness of beam and contacts, factorised at a cost that is linear in the segments.

In the angles of the links themselves, not of the joints between them, springs couple neighbours
only and the lever of a force turns with one link at a time: the matrix is tridiagonal, plus one of
low rank for each contact. It is solved by Sherman, Morrison and Woodbury's formula, and whether it
is positive definite follows from the inertia of the two (E. V. Haynsworth, Linear Algebra and its
Applications 1, 1968).
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg.lapack import dgttrf, dgttrs, dposv, dpttrf, dpttrs, dstebz, dsysv

from analytic.numerics.arrays import Floats, Integers
from mujoco_models.errors import DivergedError

_LEAST_SHIFT = 0.02  # EI/L, times the number of joints: what makes it positive definite
_LEAST_COUNT = 3  # of links for LAPACK's tridiagonal routines, as scipy has them
_IN_RANGE = 1  # LAPACK's dstebz: count the eigenvalues between two bounds


@dataclass(frozen=True)
class Stiffness:
    """Second derivative of an energy by the angles of the links."""

    springs: Floats  # shape (n,); Of the joints [EI/L]
    links: Floats  # shape (n,); What each link's own turn adds [EI/L]
    directions: Floats  # shape (m, n); Of what has low rank
    weights: Floats  # shape (m,); The stiffness in each of them, not 0 [EI/L]

    def solve(self, moments: Floats, near: int = 0) -> tuple[Floats, int]:
        """The turns of the links under moments."""
        rows = np.concatenate([moments, self.directions])
        if not math.isfinite((self.springs + self.links).sum() + rows.sum()):
            raise DivergedError("the stiffness is not finite")
        found = self._attempt(0, rows)
        if found is not None:
            return found, 0
        if np.count_nonzero(pulls := self.weights < 0):
            # A corner that turns the normal weighs a thousand times what the beam does: without it
            # there are steps, with as large an addition to all springs there are hardly any.
            rest = Stiffness(
                self.springs, self.links, self.directions[~pulls], self.weights[~pulls]
            )
            return rest.solve(moments, near)
        level = near = max(near, 1)
        while (found := self._attempt(level, rows)) is None:
            level += 1
        if level == near:
            while level > 1 and (softer := self._attempt(level - 1, rows)) is not None:
                level, found = level - 1, softer
        return found, level

    def _attempt(self, level: int, rows: Floats) -> Floats | None:
        """The turns with an addition of this level, if it makes the stiffness positive definite."""
        shift = _LEAST_SHIFT * len(self.springs) * 2.0 ** (level - 1) if level else 0.0
        count = len(rows) - len(self.directions)
        if len(self.springs) < max(len(self.weights), _LEAST_COUNT):
            return self._solved_whole(shift, rows[:count])
        turns, negative = self._tridiagonal(shift, rows.T)
        if len(self.weights) == 0:
            return None if negative else turns.T
        plain, low = turns[:, :count], turns[:, count:]
        within = self.directions @ low
        within.reshape(-1)[:: len(within) + 1] += 1 / self.weights
        factors, pivots, met, singular = dsysv(within, self.directions @ plain)
        of_weights = np.count_nonzero(self.weights > 0)
        if singular or negative + _positive(factors, pivots) != of_weights:
            return None
        return np.asarray((plain - low @ met).T)

    def _solved_whole(self, shift: float, moments: Floats) -> Floats | None:
        """The same where contacts outnumber links, or links are hardly any."""
        diagonal, beside = self._bands(shift)
        whole = np.diag(diagonal) + np.diag(beside, 1) + np.diag(beside, -1)
        whole += (self.directions.T * self.weights) @ self.directions
        _, turns, failed = dposv(whole, moments.T)
        return None if failed else np.asarray(turns.T)

    def _bands(self, shift: float) -> tuple[Floats, Floats]:
        """Of the tridiagonal part: the diagonal, and what is beside it."""
        springs = self.springs + shift
        diagonal = springs + self.links
        diagonal[:-1] += springs[1:]
        return diagonal, -springs[1:]

    def _tridiagonal(self, shift: float, moments: Floats) -> tuple[Floats, int]:
        """What the tridiagonal part makes of moments, and how many negative eigenvalues it has."""
        diagonal, beside = self._bands(shift)
        *factors, failed = dpttrf(diagonal, beside)
        if not failed:
            return np.asarray(dpttrs(*factors, moments)[0]), 0
        *factors, singular = dgttrf(beside, diagonal, beside)
        if singular:
            return np.zeros_like(moments), len(diagonal) + 1  # more than any: another shift
        lowest = -np.abs(diagonal).max() - 2 * np.abs(beside).max(initial=0.0) - 1.0
        # A tolerance wider than the range: the eigenvalues are counted, not located.
        negative = dstebz(diagonal, beside, _IN_RANGE, lowest, 0.0, 1, 1, -2 * lowest, b"E")[0]
        return np.asarray(dgttrs(*factors, moments)[0]), int(negative)


def _positive(factors: Floats, pivots: Integers) -> float:
    """How many eigenvalues of a symmetric matrix are positive, by LAPACK's factors of it.

    Bunch and Kaufman's blocks have the same inertia: those of two rows, whose pivots are negative,
    have an eigenvalue of either sign.
    """
    single = pivots >= 0
    positive = np.count_nonzero(factors.diagonal()[single] > 0)
    return positive + np.count_nonzero(~single) / 2
