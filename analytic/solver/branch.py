"""The equilibria from first contact to snap-off, and which of them a sweep visits.

Along the contour, from first contact on, the foot position x0(t) falls until it folds. On a smooth
contour it folds once. On a polygon it does so at every corner, which the contact passes in a jump:
a sweep visits the points where x0 falls below all it was before, and the vibrissa snaps off at the
least of all. Cells between grid points are smooth and belong to one phase; the first whose end lies
left of a foot position holds the state there.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.numerics.batches import take
from analytic.problem.contours.many import Contours
from analytic.solver.equilibria import surplus_and_rate
from analytic.solver.general.path import cells, phase_limits
from analytic.solver.grid import Samples, along, folded

_ROUNDING = 8 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Branch:
    """Equilibria on a grid of contour parameters."""

    # Shape (n,); Contour parameters, decreasing along the sweep; the last is the snap-off.
    t: Floats
    samples: Samples  # the states there
    tangent: Booleans  # shape (n - 1,); Whether the cell between two parameters is in Phase B
    # Contour parameter of the contour's lowest point, which is one of `t` if it comes before the
    # snap-off.
    lowest: float

    @property
    def foot_x(self) -> Floats:
        return self.samples.foot_x

    def events(self) -> dict[str, int | None]:
        start, end = phase_limits(self.tangent)
        # The last that is stable in space: the lowest, or what comes before it is passed in a jump.
        before = np.where(self.t >= self.lowest, self.foot_x, np.inf)
        return {
            "first_contact": 0,
            "phase_b_start": start,
            "phase_b_end": end,
            "back_start": None,  # a straight vibrissa does not lie down on its other side
            "back_end": None,
            "out_of_plane": int(np.argmin(before)) if self.lowest > self.t[-1] else None,
            "snap_off": len(self.t) - 1,
        }

    def cells(self, foot_x: Floats) -> Integers:
        return cells(self.foot_x, foot_x)


def trace(many: Contours, reaches: Sequence[tuple[float, float]]) -> list[Branch]:
    """Follow the equilibria along dimensionless contours, from first contact to snap-off."""
    last, first = np.array(reaches).T
    grid, samples = folded(many, along(many, first, last))
    ends = np.searchsorted(grid.owner, np.arange(len(many) + 1))
    parts = [
        _to_snap_off(grid.t[begin:end], take(samples, slice(begin, end)))
        for begin, end in pairwise(ends)
    ]
    counts = [len(t) - 1 for t, _ in parts]
    owner = np.repeat(np.arange(len(many)), counts)
    middles = np.concatenate([(t[1:] + t[:-1]) / 2 for t, _ in parts])
    tangent = surplus_and_rate(many.at(owner, middles))[0] < 0
    bounds = pairwise([0, *accumulate(counts)])
    return [
        Branch(*part, tangent[begin:end], lowest)
        for part, (begin, end), lowest in zip(parts, bounds, many.lowest.tolist(), strict=True)
    ]


def _to_snap_off(t: Floats, samples: Samples) -> tuple[Floats, Samples]:
    """Up to the least foot position, at least two points; of one found twice the first."""
    snap_off = t[np.argmin(samples.foot_x)]
    least = int(np.argmax(t <= snap_off + _ROUNDING * max(1.0, abs(snap_off))))
    which = np.arange(least + 1) if least else np.zeros(2, dtype=int)
    return t[which], take(samples, which)
