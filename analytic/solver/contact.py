"""Readings of the vibrissa against given points of a contour."""

import math
from itertools import pairwise

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Floats, Integers
from analytic.numerics.batches import take
from analytic.numerics.newton import solve
from analytic.problem.beam import Beam
from analytic.problem.clamp_path import along_x
from analytic.problem.columns import COLUMNS
from analytic.problem.contours.contour import Contour, ContourPoint
from analytic.problem.errors import InputError
from analytic.problem.numbers import pair
from analytic.problem.reach import contact_range
from analytic.problem.rest import first_touch
from analytic.problem.support import Support, check_support, given_contour
from analytic.problem.table import as_table
from analytic.solver.equilibria import equilibria
from analytic.solver.general.clearance import is_clear
from analytic.solver.general.columns import Units, to_columns, without
from analytic.solver.general.path import Path, follow
from analytic.solver.general.states import States, Vibrissa, states, with_rates
from analytic.solver.residuals import without_inexact

_AT_ONCE = 4096  # contacts: their intermediate results stay in the processor's cache
_STEPS = 8  # from the paper's vibrissa
_BALANCED = 1e-12  # L, rad


def solve_contact(
    profile: Contour,
    alpha: ArrayLike,
    beam: Beam | None = None,
    *,
    clamp_stiffness: float = math.inf,
    friction: float = 0.0,
    clamp_angle: float = 0.0,
    weight: tuple[float, float] = (0.0, 0.0),
) -> pd.DataFrame:
    """Clamp readings and contact of a vibrissa that touches `profile` where its slope is `alpha`.

    Parameters
    ----------
    profile : Contour
        The body's contour [length].
    alpha : array_like, shape (n,)
        Slope angles of the contact points [rad].
    beam : Beam, optional
        The vibrissa; ``Beam()`` if not given.
    clamp_stiffness : float
        Moment of the clamp by its rotation [force length/rad]; by default it is rigid.
    friction : float
        Coulomb's coefficient, positive where the object pushes the vibrissa along its contour to
        the right, as in a sweep to the left; negative for the other sense of sliding.
    clamp_angle : float
        By which the clamp leans to the left of the upright [rad].
    weight : tuple of float
        That of the vibrissa along x and y, by length [force/length].

    Returns
    -------
    pandas.DataFrame
        n rows with the columns of `Readings.table`, in the units of `beam`. ``status`` is
        ``"unreachable"``, and the readings NaN, where no vibrissa reaches. If rigidity, radius or
        natural curvature vary along the vibrissa, it is ``"diverged"``, without readings, where
        collocation misses a condition by more than 1e-11. With a natural
        curvature, friction or an elastic clamp it is so, too, where the state of the paper's
        vibrissa cannot be followed to this one; and ``"touches again"`` where it would touch the
        object in a second place. Such a vibrissa may have two states at one point of the contour;
        the one that a sweep comes to is that of `solve_sweep`.

    Raises
    ------
    InputError
        If an angle is not within [-pi/2, pi/2], or a number is out of range.
    """
    beam = Beam() if beam is None else beam
    contour = given_contour(profile, beam)
    held = Support(clamp_stiffness, friction, clamp_angle, pair("weight", weight))
    check_support(held, beam, signed=True)
    try:
        angles = np.atleast_1d(np.asarray(alpha, dtype=float)).ravel()
    except (TypeError, ValueError) as error:
        raise InputError("alpha", repr(alpha)[:80], "numbers", "angles are in rad") from error
    outside = ~(np.abs(angles) <= np.pi / 2)
    if outside.any():
        what, allowed = f"{angles[outside][0]} rad", "between -pi/2 and pi/2 rad"
        raise InputError("alpha", what, allowed, "they are slope angles of the lower side")
    t = contour.parameter(angles)
    vibrissa, units = Vibrissa.of(beam, held), Units.of(beam)
    if vibrissa.is_plain:
        return _plain(contour, t, vibrissa, units)
    found = contacts(contour, t, vibrissa)
    again = np.isfinite(found.excess) & ~is_clear(contour, found)
    columns = without(to_columns(found, units), again, "touches again")
    return as_table(without_inexact(columns, vibrissa, units))


def _plain(contour: Contour, t: Floats, vibrissa: Vibrissa, units: Units) -> pd.DataFrame:
    """The paper's vibrissa, some contacts at a time."""
    parts = [
        to_columns(equilibria(contour, t[first : first + _AT_ONCE]).states(vibrissa), units)
        for first in range(0, max(t.size, 1), _AT_ONCE)
    ]
    return as_table({name: np.concatenate([part[name] for part in parts]) for name in COLUMNS})


def contacts(contour: Contour, t: Floats, vibrissa: Vibrissa) -> States:
    """The vibrissa against each contour point, tangential or at the tip."""
    reach = contact_range(contour)
    touch = first_touch(contour, reach, vibrissa.at_rest.shape)
    path = follow(contour, vibrissa, touch, reach, along_x(vibrissa.clamp_angle))
    z = _solved(contour, vibrissa, path, t)
    return states(contour.at(t), z[:, 0], z[:, 1], vibrissa)


def _solved(contour: Contour, vibrissa: Vibrissa, path: Path, t: Floats) -> Floats:
    """Force and excess at each contour parameter, shape (n, 2); NaN where there is no contact."""
    point = contour.at(t)
    z, missed = _balanced(point, vibrissa, _on_path(path, t))
    left = np.flatnonzero(~(missed <= _BALANCED))
    if left.size:
        at = take(point, left)
        z[left], missed[left] = _from_plain(contour, t[left], at, vibrissa)
    z[~(missed <= _BALANCED)] = np.nan
    return z


def _on_path(path: Path, t: Floats) -> Floats:
    """Force and excess of a path's last place of each contour parameter, shape (n, 2), or NaN."""
    cells = np.full(len(t), -1)
    for i, (begin, end) in enumerate(pairwise(path.z[:, 0])):
        if begin != end:
            cells[(t - begin) * (t - end) <= 0] = i
    found = np.full((len(t), 2), np.nan)
    on = cells >= 0
    found[on] = path.at(cells[on], path.share(cells[on], t[on], 0))[:, 1:3]
    return found


def _from_plain(
    contour: Contour, t: Floats, point: ContourPoint, vibrissa: Vibrissa
) -> tuple[Floats, Floats]:
    """Force and excess, shape (n, 2), and what they miss, followed from the paper's vibrissa."""
    plain = equilibria(contour, t).states(Vibrissa())
    z = np.stack([plain.force, plain.excess], axis=1)
    missed = np.where(np.isfinite(z).all(axis=1), 0.0, np.inf)
    for share in np.linspace(0, 1, _STEPS + 1)[1:]:
        held = np.flatnonzero(missed <= _BALANCED)
        if held.size == 0:
            break
        at = take(point, held)
        z[held], missed[held] = _balanced(at, vibrissa.scaled(share), z[held])
    return z, missed


def _balanced(point: ContourPoint, vibrissa: Vibrissa, start: Floats) -> tuple[Floats, Floats]:
    """Force and excess at given points, shape (n, 2), and what they miss, shape (n,)."""

    def misses(z: Floats, which: Integers) -> Floats:
        found = states(take(point, which), z[:, 0], z[:, 1], vibrissa)
        return np.stack([found.slope_residual, found.height_residual], axis=1)

    def jacobian(z: Floats, which: Integers) -> Floats:
        return with_rates(take(point, which), z[:, 0], z[:, 1], vibrissa)[1][:, :2, 1:]

    return solve(misses, jacobian, start)
