"""The equilibria from first contact to snap-off, and which of them a sweep visits.

Along the contour, from first contact on, the foot position x0(t) falls until it folds. On a smooth
contour it folds once. On a polygon it does so at every corner, which the contact passes in a jump:
a sweep visits the points where x0 falls below all it was before, and the vibrissa snaps off at the
least of all. Cells between grid points are smooth and belong to one phase; the first whose end lies
left of a foot position holds the state there.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from analytic.problem.arrays import Booleans, Floats, Integers
from analytic.problem.contours.contour import Contour
from analytic.solver.equilibria import equilibria, tangent_contact

_COARSE = 301  # samples of the whole contour to find the snap-off between; the fold is then exact
_FINE = 129  # samples of the branch to start Newton's method from


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
        """Foot positions of first contact, limits of Phase B and of the plane, snap-off [L]."""
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
        """Cell that holds the state at each foot position; they must lie on the branch."""
        least = np.minimum.accumulate(self.foot_x)
        end = np.searchsorted(-least, -foot_x, side="left")
        return np.clip(end, 1, len(self.t) - 1) - 1


def trace(centreline: Contour, first: float) -> Branch:
    """Follow the equilibria along a dimensionless contour, from first contact to snap-off.

    Parameters
    ----------
    centreline : Contour
        Contour that the centreline feels, in units of the vibrissa's length.
    first : float
        Contour parameter of the first contact, as `contact_range` has it.
    """
    last = _snap_off(centreline, first)
    # Dense at both ends: x0 starts like a square root at first contact and folds at snap-off.
    fraction = (1 - np.cos(np.linspace(0, np.pi, _FINE))) / 2
    corners = centreline.breaks()
    corners = corners[(corners > last) & (corners < first)]
    grid = _descending(first + (last - first) * fraction, corners)
    grid = _descending(grid, _phase_changes(centreline, grid))
    states = equilibria(centreline, grid[1:])
    return Branch(
        centreline,
        grid,
        np.append(centreline.at(grid[:1]).xi, states.foot_x),
        np.append(0.0, states.excess),
        surplus(centreline, (grid[1:] + grid[:-1]) / 2) < 0,
    )


def surplus(centreline: Contour, t: Floats) -> Floats:
    """1 - 1/s1 with s1 of eq. 21: negative in Phase B, and smooth through the pole of s1."""
    states = tangent_contact(centreline.at(t))
    straight = states.span.q == 0  # against an upright side, at first contact
    q, root_f = np.where(straight, 1.0, states.span.q), np.where(straight, 1.0, states.root_f)
    return np.where(straight, 1 - 1 / states.point.eta, 1 - root_f / q)


def _phase_changes(centreline: Contour, grid: Floats) -> Floats:
    """Contour parameters between neighbours in `grid` where s1 passes 1."""
    tangential = surplus(centreline, grid) < 0
    turns = np.flatnonzero(tangential[1:] != tangential[:-1])

    def at(t: float) -> float:
        return float(surplus(centreline, np.array([t]))[0])

    return np.array([brentq(at, grid[i + 1], grid[i], xtol=1e-300, rtol=9e-16) for i in turns])


def _descending(*grids: Floats) -> Floats:
    return np.unique(np.concatenate(grids))[::-1]


def _snap_off(centreline: Contour, first: float) -> float:
    """The parameter of the least foot position that is reached without a gap."""
    low = centreline.t_range[0]
    breaks = centreline.breaks()
    grid = _descending(np.linspace(first, low, _COARSE), breaks[(breaks > low) & (breaks < first)])
    foot_x = equilibria(centreline, grid[1:]).foot_x
    beyond = np.flatnonzero(np.isnan(foot_x))
    reached = foot_x[: beyond[0]] if beyond.size else foot_x
    least = 1 + int(np.argmin(reached))

    def rate(t: float) -> float:
        states = equilibria(centreline, np.array([t]))
        return float(states.foot_x_rate[0]) if np.isfinite(states.excess[0]) else -1.0

    before, after = grid[max(least - 1, 1)], grid[min(least + 1, len(grid) - 1)]
    if not rate(before) > 0 > rate(after):
        return float(grid[least])  # a corner of x0, on the grid itself
    return float(brentq(rate, after, before, xtol=1e-300, rtol=9e-16))
