"""The equilibria from first contact to snap-off, and which of them a sweep visits.

Along the contour, from first contact on, the foot position x0(t) falls until it folds. On a smooth
contour it folds once. On a polygon it does so at every corner, which the contact passes in a jump:
a sweep visits the points where x0 falls below all it was before, and the vibrissa snaps off at the
least of all. Cells between grid points are smooth and belong to one phase; the first whose end lies
left of a foot position holds the state there.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.contour import Contour
from analytic.solver.contact_length import surplus
from analytic.solver.equilibria import equilibria
from analytic.solver.grid import along, folded

_ASIDE = 1e-3  # of a cell: next to a fold x0 is higher by far more than rounding there
_ROUNDING = 8 * float(np.finfo(float).eps)


@dataclass(frozen=True)
class Branch:
    """Equilibria on a grid of contour parameters.

    Attributes
    ----------
    t : array, shape (n,)
        Contour parameters, decreasing along the sweep; the last is the snap-off.
    foot_x, excess : array, shape (n,)
        Foot position [L] and excess rotation of the tip [rad] there.
    tangent : array of bool, shape (n - 1,)
        Whether the cell between two parameters is in Phase B.
    """

    centreline: Contour
    t: Floats
    foot_x: Floats
    excess: Floats
    tangent: Booleans

    @property
    def first_contact(self) -> float:
        """Contour parameter of the first contact."""
        return float(self.t[0])

    @property
    def snap_off(self) -> float:
        """Contour parameter at which the vibrissa snaps off."""
        return float(self.t[-1])

    @property
    def sideways_limit(self) -> float | None:
        """Contour parameter of the last equilibrium that is stable in space; None if all are.

        It is the contour's lowest point, or what a sweep along a polygon visits last before it
        passes that in a jump; see `analytic.from_clamp.sideways`.
        """
        lowest = self.centreline.parameter(np.zeros(1))
        if lowest[0] <= self.snap_off:
            return None
        before = self.t > lowest[0]
        t = np.append(self.t[before], lowest)
        foot_x = np.append(self.foot_x[before], equilibria(self.centreline, lowest).foot_x)
        return float(t[np.argmin(foot_x)])

    @property
    def phase_changes(self) -> Floats:
        """Contour parameters at which Phases A and B take turns, decreasing."""
        return np.asarray(self.t[1:-1][self.tangent[1:] != self.tangent[:-1]])

    def events(self) -> dict[str, float | None]:
        """Where what happens along the branch happens.

        Returns
        -------
        dict
            Foot positions [L] of the first contact, of the first start and the last end of Phase B,
            of the last equilibrium that is stable in space, and of the snap-off; None where there
            is none.
        """
        change = np.append(self.tangent[1:] != self.tangent[:-1], False)
        at, into_b = self.foot_x[1:][change], self.tangent[1:][change[:-1]]
        starts, ends = at[into_b], at[~into_b]
        start = self.foot_x[0] if self.tangent[0] else (starts[0] if starts.size else None)
        end = None if self.tangent[-1] or not ends.size else ends[-1]
        limit = self.sideways_limit
        out = None if limit is None else equilibria(self.centreline, np.array([limit])).foot_x[0]
        places = (self.foot_x[0], start, end, out, self.foot_x[-1])
        names = ("first_contact", "phase_b_start", "phase_b_end", "out_of_plane", "snap_off")
        return {n: None if x is None else float(x) for n, x in zip(names, places, strict=True)}

    def cells(self, foot_x: Floats) -> Integers:
        """Cell that holds the state at each foot position on the branch.

        Parameters
        ----------
        foot_x : array, shape (n,)
            Foot positions between first contact and snap-off [L].

        Returns
        -------
        array of int, shape (n,)
            Of the first cell whose end lies at or left of the foot position.
        """
        least = np.minimum.accumulate(self.foot_x)
        end = np.searchsorted(-least, -foot_x, side="left")
        return np.clip(end, 1, len(self.t) - 1) - 1


def trace(centreline: Contour, reach: tuple[float, float]) -> Branch:
    """Follow the equilibria along a dimensionless contour, from first contact to snap-off.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    reach : tuple of float
        Contour parameters of the last point within reach and of the first contact, as
        `contact_range` has them.

    Returns
    -------
    Branch
        At least two points; all in one place if nothing but the first contact can be reached.
    """
    last, first = reach
    t, foot_x, excess = folded(centreline, along(centreline, first, last))
    least = int(np.argmin(foot_x))
    t, foot_x, excess = (values[: least + 1] for values in (t, foot_x, excess))
    if least == 0:
        t, foot_x, excess = (np.repeat(values, 2) for values in (t, foot_x, excess))
    else:
        t[-1], foot_x[-1], excess[-1] = _lowest(centreline, t[-1], (t[-2], foot_x[-1], excess[-1]))
    return Branch(centreline, t, foot_x, excess, surplus(centreline, (t[1:] + t[:-1]) / 2) < 0)


def _lowest(
    centreline: Contour, at: float, found: tuple[float, float, float]
) -> tuple[float, float, float]:
    """The snap-off's parameter, foot position and excess rotation.

    It is what was `found` where the derivative of x0 vanishes, unless that is inexact, as without a
    radius of curvature: then x0 is lower next to it.
    """
    before, foot_x, excess = found
    width = before - at
    aside = at + _ASIDE * width * np.array([-1, 1])
    lower = equilibria(centreline, aside).foot_x < foot_x - _ROUNDING * max(1, abs(foot_x))
    if not lower.any():
        return at, foot_x, excess

    def place(t: float) -> float:
        value = float(equilibria(centreline, np.array([t])).foot_x[0])
        return foot_x + 1 if np.isnan(value) else value  # out of reach

    search = minimize_scalar(
        place, bounds=(at - width, before), method="bounded", options={"xatol": 1e-9 * width}
    )
    lowest = equilibria(centreline, np.array([search.x]))
    return float(search.x), float(lowest.foot_x[0]), float(lowest.excess[0])
