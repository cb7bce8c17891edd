"""The readings of the general vibrissa, column by column."""

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.beam import Beam
from analytic.solver.equilibria import Column
from analytic.solver.general.states import States


def to_columns(found: States, again: Booleans, beam: Beam) -> dict[str, Column]:
    """The readings of states at rest."""
    alpha, xi, eta = found.point[:3]
    force, mu = found.force * beam.force_unit, found.vibrissa.friction
    radius, length = found.vibrissa.radius, found.arc_length
    rest = found.vibrissa.unloaded
    missing = np.isnan(found.excess) | again

    def where_there(values: Floats) -> Floats:
        return np.where(missing, np.nan, values)

    return {
        "foot_x": where_there(found.foot_x) * beam.length,
        "force_x": where_there(-force * (np.sin(alpha) + mu * np.cos(alpha))),
        "force_y": where_there(force * (np.cos(alpha) - mu * np.sin(alpha))),
        "moment_z": where_there(found.moment) * beam.moment_unit,
        "phase": np.where(found.tangent, "tangent", "tip"),
        "contact_angle": alpha,
        "contact_arc_length": where_there(length) * beam.length,
        "contact_x": (xi - radius * np.sin(alpha)) * beam.length,
        "contact_y": (eta + radius * np.cos(alpha)) * beam.length,
        "tip_angle": where_there(found.tip_angle + rest.turn_between(length, 1.0)),
        "status": np.where(again, "touches again", np.where(missing, "unreachable", "ok")),
    }
