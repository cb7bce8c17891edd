"""The deflected vibrissa, drawn from what its clamp feels."""

import numpy as np

from analytic.checks.integration import march
from analytic.from_clamp.contact import Held, located
from analytic.problem.arrays import Floats
from analytic.problem.columns import SENSED
from analytic.problem.readings import Readings
from analytic.problem.unloaded import Unloaded

_STEPS = 64  # of a fourth-order method: far below the width of a line
_FREE = 16  # points of a free end that is an arc


def deflected_shapes(readings: Readings) -> tuple[Floats, Floats]:
    """Centrelines of the vibrissa at every station, from foot position, clamp force and moment.

    Integrates kappa(s) = kappa_0 - M_Az + F_Ay (x - x0) - F_Ax y from the clamp to the contact,
    beyond which the vibrissa is as it is at rest (paper, eqs. 4 and 14, with the natural curvature
    kappa_0): straight, or an arc.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.

    Returns
    -------
    x, y : array, shape (stations, 66)
        Coordinates [length]; shape (stations, 81) if the vibrissa is curved at rest.

    Raises
    ------
    InputError
        If the vibrissa varies along its length.
    """
    beam = readings.beam
    held = Held.of(readings)
    natural = held.way * held.vibrissa.natural_curvature
    foot_x = readings.values("foot_x") / beam.length
    force_x = readings.values("force_x") / beam.force_unit
    force_y = readings.values("force_y") / beam.force_unit
    moment = readings.values("moment_z") / beam.moment_unit
    loaded = located(readings).arc_length
    loaded = np.minimum(np.nan_to_num(loaded, nan=1.0), 1.0)

    def rate(state: Floats) -> Floats:
        x, y, phi = state
        kappa = natural - moment + force_y * x - force_x * y
        return np.stack([np.cos(phi), np.sin(phi), kappa])

    clamp = np.stack(
        [
            np.zeros_like(foot_x),
            np.zeros_like(foot_x),
            np.pi / 2 - held.vibrissa.compliance * moment,
        ]
    )
    states = march(rate, clamp, loaded, _STEPS)
    x, y, phi = states[-1]
    parts = np.linspace(0, 1, _FREE + 1)[1:] if natural else np.ones(1)
    rest = (1 - loaded) * parts[:, None]
    sine, cosine, _ = Unloaded(natural).at(rest)  # to the left of its start and along it
    free = np.stack(
        [
            x + cosine * np.cos(phi) + sine * np.sin(phi),
            y + cosine * np.sin(phi) - sine * np.cos(phi),
            phi + natural * rest,
        ],
        axis=1,
    )
    path = np.moveaxis(np.concatenate([states, free]), 0, -1)
    return (path[0] + foot_x[:, None]) * beam.length, path[1] * beam.length


def curvatures(readings: Readings, x: Floats, y: Floats) -> Floats:
    """Curvature along the centrelines that `deflected_shapes` drew of these readings.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.
    x, y : array, shape (stations, points)
        Coordinates [length]; those beyond the contact carry no moment.

    Returns
    -------
    array, shape (stations, points)
        kappa [1/length], positive where the vibrissa bends to the left of its way from clamp to
        tip.

    Raises
    ------
    InputError
        If the vibrissa varies along its length.
    """
    beam = readings.beam
    Held.of(readings)
    foot_x, force_x, force_y, moment = (readings.values(name)[:, None] for name in SENSED)
    kappa = (force_y * (x - foot_x) - force_x * y - moment) / beam.base_rigidity
    kappa[:, _STEPS + 1 :] = 0.0
    return np.asarray(kappa + beam.curvature_at(0.0))
