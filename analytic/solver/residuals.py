"""How well the readings of a station satisfy their conditions, from the readings alone."""

from collections.abc import Mapping

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.solver.elastica import frame, span_of_moment
from analytic.solver.equilibria import Column, Numbers, Units


def residuals(
    columns: Mapping[str, Column | Numbers], free: Booleans, units: Units
) -> dict[str, Floats]:
    """What the stations of a table of readings miss, by the closed form of their clamp readings.

    The elastica that has the clamp's force and moment, up to where its curvature vanishes, is
    compared with the contact that the table states. That is another route than the solver's, which
    goes from the contact to the clamp; elliptic integrals are common to both (`certify` uses none).
    """

    def column(name: str, unit: float | Floats) -> Floats:
        return np.asarray(columns[name], dtype=float) / unit

    force_x, force_y = (column(name, units.force) for name in ("force_x", "force_y"))
    moment = column("moment_z", units.moment)
    foot_x, xi, eta, arc_length = (
        column(name, units.length)
        for name in ("foot_x", "contact_x", "contact_y", "contact_arc_length")
    )
    alpha, tip_angle = column("contact_angle", 1.0), column("tip_angle", 1.0)
    x, y = xi + units.radius * np.sin(alpha) - foot_x, eta - units.radius * np.cos(alpha)
    extent = np.maximum(1.0, np.abs(xi))
    with np.errstate(divide="ignore", invalid="ignore"):  # free stations: no force, no contact
        force = np.hypot(force_x, force_y)
        root_f = np.sqrt(force)
        direction = np.arctan2(-force_x, force_y)
        loaded = span_of_moment(moment / root_f, direction)
        up, across = frame(loaded, direction)
        # The first integral between clamp and contact: sin(phi1 - alpha) = cos(alpha) - M^2/(2 f).
        missed = [
            across / root_f - x,
            up / root_f - y,
            loaded.q / root_f - arc_length,
            np.cos(direction) - moment**2 / (2 * force) - np.sin(tip_angle - alpha),
            direction - alpha,
            np.maximum(0.0, arc_length - 1),
            np.maximum(0.0, alpha - tip_angle),
        ]
        boundary = np.abs(missed).max(axis=0) / extent
        balance = np.abs(moment - (force_y * x - force_x * y)) / np.maximum(extent, moment)
    return {
        "residual_boundary": np.where(free, 0.0, boundary),
        "residual_moment": np.where(free, np.abs(moment), balance),
    }
