"""A certificate for every station: its conditions, checked by a route of their own."""

import math
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from analytic.checks.integration import integrate_span
from analytic.checks.of_two import Reached, dimensionless, misses_of_two, touches_twice
from analytic.numerics.arrays import Floats
from analytic.problem.readings import Readings, require_readings
from analytic.problem.support import is_plain, support_of

if TYPE_CHECKING:
    import pandas as pd


def certify(readings: Readings) -> "pd.DataFrame":
    """How well each station meets its boundary conditions and the balance of moments.

    The clamp's force and moment are marched along the elastica by a Runge-Kutta method up to the
    contact that the readings state; no elliptic integral takes part.

    Parameters
    ----------
    readings : Readings
        A sweep with its contact columns.

    Returns
    -------
    pandas.DataFrame
        A row a station, dimensionless. ``residual_boundary`` is the largest of the misses of the
        contact's position, of its moment (friction's couple on the surface), of the slope there
        (the contour's in Phase B, on either side, and a cone's lean; the tip's in Phase A) and of
        the force's direction, normal to the contour, or off it by friction's angle; of what the arc
        length exceeds L by; and of the tip's slope, if it comes from inside the object. For the
        paper's vibrissa it is that of what the slope falls below the contour's by on the way, too:
        above it the vibrissa stays below the tangent at the contact, and so outside a convex body.
        ``residual_moment`` is that of M = F_y (xi - x0) - F_x eta + mu r f. Zero where the vibrissa
        is free, NaN where the readings have no contact to check. With a weight the march goes on to
        the tip, contact or none: ``residual_moment`` is the moment that is left there, and
        ``residual_boundary`` has what the tip's slope angle misses, too.
    """
    require_readings(readings)
    held = support_of(readings.provenance)
    clamp_stiffness, friction, _, weight = held
    beam = readings.beam
    turns = "clamp_angle" in readings.table
    plain = is_plain(beam, held) and not turns
    if readings.bends_left if plain else readings.runs_right:
        return certify(readings.mirrored())
    length = beam.length
    force_x = readings.values("force_x") / beam.force_unit
    force_y = readings.values("force_y") / beam.force_unit
    moment = readings.values("moment_z") / beam.moment_unit
    alpha = readings.values("contact_angle")
    radius = beam.radius_at(readings.values("contact_arc_length"))
    x = (readings.values("contact_x") + radius * np.sin(alpha) - readings.values("foot_x")) / length
    y = (readings.values("contact_y") - radius * np.cos(alpha) - readings.foot_y) / length
    arc_length = readings.values("contact_arc_length") / length
    phase = readings.table["phase"].to_numpy()
    along = alpha + beam.unloaded.lean
    tip_angle = readings.values("tip_angle")
    turned = tip_angle - alpha - beam.unloaded.turn_between(arc_length, 1.0)
    on_side = np.where(turned > np.pi / 2, alpha + np.pi - beam.unloaded.lean, along)
    slope = np.where(phase == "tangent", on_side, tip_angle)
    compliance = beam.moment_unit / clamp_stiffness
    # Friction acts on the surface, and turns the force by the friction angle.
    arm = friction / math.sqrt(1 + friction**2) * radius / length
    heavy = any(weight)
    w_x, w_y = (w * length / beam.force_unit for w in weight)
    pushed = np.hypot(force_x + w_x, force_y + w_y)  # by the object
    couple = arm * pushed

    free = phase == "free"
    touching = np.isfinite(arc_length) | (free & heavy)
    touching &= np.isfinite(force_x + force_y + moment)  # without them a march has no end
    boundary = np.where(free, 0.0, np.nan)
    balance = np.where(free, np.abs(moment), np.nan)
    if touching.any():
        march = partial(
            integrate_span,
            natural=lambda s: length * beam.curvature_at(length * s),
            breaks=beam.breaks / length,
            flexibility=lambda s: beam.base_rigidity / beam.rigidity_at(length * s),
            weight=(w_x, w_y),
        )
        reached = np.where(free, 1.0, arc_length)[touching]
        end = march(
            force_x[touching],
            force_y[touching],
            moment[touching],
            reached,
            compliance=compliance,
            clamp_angle=readings.clamp_angle[touching],
        )
        turned = np.arctan2(-force_x - w_x, force_y + w_y) - math.atan(friction) - alpha
        if heavy:  # of a small force beside a large weight the direction is lost
            turned = pushed * turned
        misses = [
            end.x - x[touching],
            end.y - y[touching],
            end.phi - slope[touching],
            end.moment + couple[touching],
            turned[touching],
            np.maximum(0.0, arc_length[touching] - 1),
            np.maximum(0.0, slope[touching] - alpha[touching] - np.pi),
            np.maximum(0.0, along[touching] - (end.least_phi if plain else slope[touching])),
        ]
        left = (moment - (force_y * x - force_x * y) - couple)[touching]
        if heavy:
            held = np.where(free, 0.0, couple)[touching] + end.moment
            beyond = march(
                -w_x * (1 - reached),
                -w_y * (1 - reached),
                -held,
                np.ones_like(reached),
                clamp_angle=end.phi - np.pi / 2,
                begin=reached,
            )
            left = misses[3] = beyond.moment
            misses = [np.where(free[touching], 0.0, missed) for missed in misses]
            misses += [beyond.phi - tip_angle[touching], np.where(free, pushed, 0.0)[touching]]
        boundary[touching] = np.abs(misses).max(axis=0)
        balance[touching] = np.abs(left)
    if (two := touches_twice(readings.table)).any():
        natural = length * float(beam.curvature_at(0.0))

        def span(
            force_x: Floats, force_y: Floats, moment: Floats, slope: Floats, along: Floats
        ) -> Reached:
            end = integrate_span(
                force_x,
                force_y,
                moment,
                along,
                clamp_angle=slope - np.pi / 2,
                natural=lambda s: np.full_like(s, natural),
            )
            return Reached(end.x, end.y, end.phi, end.moment)

        read = dimensionless(readings.table, two, length, beam.force_unit, beam.moment_unit)
        tip_radius = beam.unloaded.tip_radius
        boundary[two], balance[two] = misses_of_two(
            read, friction, tip_radius, natural, compliance, span
        )
    import pandas as pd  # slow to load, and a sweep that is not certified needs none of it

    return pd.DataFrame({"residual_boundary": boundary, "residual_moment": balance})
