"""The object from the clamp readings alone (paper, section 5), without a phase decision."""

import numpy as np
import pandas as pd

from analytic.problem.arrays import Floats
from analytic.problem.readings import Readings
from analytic.solver.elastica import frame, span_of_moment

_FREE = 1e-9  # of EI/L^2: below, a force has no direction to speak of


def reconstruct(readings: Readings, phase_tolerance: float = 1e-6) -> pd.DataFrame:
    """Contact points from foot position, clamp force and clamp moment, in closed form.

    The force's direction is the contour's normal, so tan(alpha) = -F_x/F_y; force and moment fix
    the modulus, k^2 = (1 + (M^2 - 2 F_y)/(2 f))/2, and with it the whole elastica up to where its
    curvature vanishes, which is the contact. No decision between the phases is needed for that:
    the phase follows from the contact's arc length.

    Parameters
    ----------
    readings : Readings
        Only the four sensed columns are used.
    phase_tolerance : float
        By how much of its length the contact may miss the tip and still be called a tip contact.

    Returns
    -------
    pandas.DataFrame
        A row a station: ``contact_x``, ``contact_y``, ``contact_arc_length`` [length], on the
        body's surface, ``phase``; also ``contact_angle`` [rad]. NaN and ``"free"`` where no force
        acts; NaN and ``"unexplained"`` where no elastica has such a force and moment.
    """
    beam = readings.beam
    foot_x = readings.values("foot_x") / beam.length
    force_x = readings.values("force_x") / beam.force_unit
    force_y = readings.values("force_y") / beam.force_unit
    moment = readings.values("moment_z") / beam.moment_unit
    f = np.hypot(force_x, force_y)
    loaded = f > _FREE
    alpha, arc_length, xi, eta = _contact(
        *(np.where(loaded, x, np.nan) for x in (foot_x, force_x, force_y, moment))
    )
    explained = np.isfinite(arc_length)
    phase = np.where(arc_length < 1 - phase_tolerance, "tangent", "tip")
    phase = np.where(explained, phase, np.where(loaded, "unexplained", "free"))
    return pd.DataFrame(
        {
            "contact_x": xi * beam.length - beam.radius * np.sin(alpha),
            "contact_y": eta * beam.length + beam.radius * np.cos(alpha),
            "contact_arc_length": arc_length * beam.length,
            "phase": phase,
            "contact_angle": alpha,
        }
    )


def _contact(
    foot_x: Floats, force_x: Floats, force_y: Floats, moment: Floats
) -> tuple[Floats, Floats, Floats, Floats]:
    """Slope angle, arc length and position of the centreline's contact, dimensionless."""
    root_f = np.sqrt(np.hypot(force_x, force_y))
    alpha = np.arctan2(-force_x, force_y)
    loaded = span_of_moment(moment / root_f, alpha)
    up, across = frame(loaded, alpha)
    return alpha, loaded.q / root_f, foot_x + across / root_f, up / root_f
