"""The deflected vibrissa, drawn from what its clamp feels."""

import numpy as np

from analytic.checks.integration import march
from analytic.from_clamp.contact import located
from analytic.problem.arrays import Floats
from analytic.problem.columns import SENSED
from analytic.problem.readings import Readings

_STEPS = 64  # of a fourth-order method: far below the width of a line


def deflected_shapes(readings: Readings) -> tuple[Floats, Floats]:
    """Centrelines of the vibrissa at every station, from foot position, clamp force and moment.

    Integrates kappa(s) = -M_Az + F_Ay (x - x0) - F_Ax y from the clamp to the contact, beyond which
    the vibrissa is straight (paper, eqs. 4 and 14).

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.

    Returns
    -------
    x, y : array, shape (stations, 66)
        Coordinates [length].

    Raises
    ------
    InputError
        If the vibrissa is curved at rest, its clamp turns, or the object rubs.
    """
    beam = readings.beam
    foot_x = readings.values("foot_x") / beam.length
    force_x = readings.values("force_x") / beam.force_unit
    force_y = readings.values("force_y") / beam.force_unit
    moment = readings.values("moment_z") / beam.moment_unit
    loaded = located(readings).arc_length
    loaded = np.minimum(np.nan_to_num(loaded, nan=1.0), 1.0)

    def rate(state: Floats) -> Floats:
        x, y, phi = state
        kappa = -moment + force_y * x - force_x * y
        return np.stack([np.cos(phi), np.sin(phi), kappa])

    clamp = np.stack(
        [np.zeros_like(foot_x), np.zeros_like(foot_x), np.full_like(foot_x, np.pi / 2)]
    )
    states = march(rate, clamp, loaded, _STEPS)
    x, y, phi = states[-1]
    rest = 1 - loaded
    tip = np.stack([x + rest * np.cos(phi), y + rest * np.sin(phi), phi])
    path = np.moveaxis(np.concatenate([states, tip[None]]), 0, -1)
    return (path[0] + foot_x[:, None]) * beam.length, path[1] * beam.length


def curvatures(readings: Readings, x: Floats, y: Floats) -> Floats:
    """Curvature along the centrelines that `deflected_shapes` drew of these readings.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.
    x, y : array, shape (stations, points)
        Coordinates [length]; the last point is the tip, which carries no moment.

    Returns
    -------
    array, shape (stations, points)
        kappa [1/length], positive where the vibrissa bends to the left of its way from clamp to
        tip.

    Raises
    ------
    InputError
        If the vibrissa is curved at rest, its clamp turns, or the object rubs.
    """
    readings.require_plain("the curvature from the clamp")
    foot_x, force_x, force_y, moment = (readings.values(name)[:, None] for name in SENSED)
    kappa = (force_y * (x - foot_x) - force_x * y - moment) / readings.beam.base_rigidity
    kappa[:, -1] = 0.0
    return kappa
