"""How well readings of the general vibrissa satisfy their conditions, from the clamp's end."""

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.beam import Beam
from analytic.solver.equilibria import Column
from analytic.solver.general.span import back_to_clamp
from analytic.solver.general.states import Vibrissa


def residuals(columns: dict[str, Column], beam: Beam, vibrissa: Vibrissa) -> dict[str, Floats]:
    """What the stations of a table of readings miss, by the closed form from clamp to contact.

    The solver goes from the contact to the clamp; this is the way back, from the clamp's readings
    alone. A span run through from its other end has the opposite curvature.

    Parameters
    ----------
    columns : dict of array, shape (n,)
        Columns of `Readings.table`, of a sweep to the left.
    beam : Beam
        The vibrissa.
    vibrissa : Vibrissa
        Its dimensionless numbers.

    Returns
    -------
    dict of array, shape (n,)
        As `analytic.solver.residuals.residuals`; the curvature at the contact is one of the misses.
    """

    def column(name: str, unit: float) -> Floats:
        return np.asarray(columns[name], dtype=float) / unit

    natural, compliance, mu, radius = vibrissa
    force_x, force_y = (column(name, beam.force_unit) for name in ("force_x", "force_y"))
    moment = column("moment_z", beam.moment_unit)
    foot_x, xi, eta, length = (
        column(name, beam.length)
        for name in ("foot_x", "contact_x", "contact_y", "contact_arc_length")
    )
    alpha, tip_angle = column("contact_angle", 1.0), column("tip_angle", 1.0)
    x, y = xi + radius * np.sin(alpha) - foot_x, eta - radius * np.cos(alpha)
    slope = tip_angle - natural * (1 - length)
    force, direction = np.hypot(force_x, force_y), np.arctan2(-force_x, force_y)
    couple = mu * radius * force / np.sqrt(1 + mu**2)

    begin = np.pi / 2 - compliance * moment - direction
    end = back_to_clamp(begin, moment - natural, force, length)
    sin, cos = np.sin(direction), np.cos(direction)
    missed = [
        end.along * cos - end.across * sin - x,
        end.along * sin + end.across * cos - y,
        np.pi / 2 - 2 * np.arctan2(end.p, end.g) + direction - slope,
        -end.kappa - natural + couple,
        direction - np.arctan(mu) - alpha,
        np.maximum(0.0, length - 1),
        np.maximum(0.0, alpha - slope),
        np.where(columns["phase"] == "tangent", slope - alpha, 0.0),
    ]
    extent = np.maximum(1.0, np.abs(xi))
    balance = moment - (force_y * x - force_x * y) - couple
    free = np.isnan(length) & (moment == 0)
    return {
        "residual_boundary": np.where(free, 0.0, np.abs(missed).max(axis=0) / extent),
        "residual_moment": np.where(
            free, 0.0, np.abs(balance) / np.maximum(extent, np.abs(moment))
        ),
    }
