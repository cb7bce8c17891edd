"""How well readings of the general vibrissa satisfy their conditions, from the clamp's end."""

from typing import NamedTuple

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.beam import Beam
from analytic.problem.columns import CLAMP_READINGS
from analytic.solver.equilibria import Column
from analytic.solver.general.march import march
from analytic.solver.general.span import back_to_clamp
from analytic.solver.general.states import Vibrissa

SOLVED = 1e-11  # of what a state misses: hundreds of roundings at the sharpest bends


def residuals(columns: dict[str, Column], beam: Beam, vibrissa: Vibrissa) -> dict[str, Floats]:
    """What the stations of a table of readings miss, from clamp to contact.

    The solver goes from the contact to the clamp; this is the way back, from the clamp's readings
    alone. Where rigidity or natural curvature vary it is the solver's way on panels of half the
    length, so that it shows the error of collocation: clamp readings of double precision do not
    determine the slope of a tip that is sharp.
    """

    def column(name: str, unit: float) -> Floats:
        return np.asarray(columns[name], dtype=float) / unit

    compliance, mu = vibrissa.compliance, vibrissa.friction
    force_x, force_y = (column(name, beam.force_unit) for name in ("force_x", "force_y"))
    moment = column("moment_z", beam.moment_unit)
    foot_x, xi, eta, length = (
        column(name, beam.length)
        for name in ("foot_x", "contact_x", "contact_y", "contact_arc_length")
    )
    alpha, tip_angle = column("contact_angle", 1.0), column("tip_angle", 1.0)
    radius = vibrissa.radius_at(length)
    x, y = xi + radius * np.sin(alpha) - foot_x, eta - radius * np.cos(alpha)
    slope = tip_angle - vibrissa.unloaded.turn_between(length, 1.0)
    force, lean = np.hypot(force_x, force_y), np.arctan(mu)
    # Of no force, as where a tip leaves the object, any direction is right.
    direction = np.where(force > 0, np.arctan2(-force_x, force_y), alpha + lean)
    couple = mu * radius * force / np.sqrt(1 + mu**2)

    clamp = np.pi / 2 - compliance * moment - direction, -moment
    contact = slope - direction, -couple
    span = _span(vibrissa, clamp, contact, force, length)
    sin, cos = np.sin(direction), np.cos(direction)
    along = alpha + vibrissa.lean
    missed = [
        span.along * cos - span.across * sin - x,
        span.along * sin + span.across * cos - y,
        span.theta,
        span.m,
        direction - lean - alpha,
        np.maximum(0.0, length - 1),
        np.maximum(0.0, along - slope),
        np.where(columns["phase"] == "tangent", slope - along, 0.0),
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


def without_inexact(
    columns: dict[str, Column], beam: Beam, vibrissa: Vibrissa
) -> dict[str, Column]:
    """The readings of states at rest, but for those that collocation has not solved well enough."""
    if vibrissa.form is None:
        return columns
    missed = np.maximum(*residuals(columns, beam, vibrissa).values())
    inexact = (columns["status"] == "ok") & ~(missed <= SOLVED)
    if not inexact.any():
        return columns
    found = dict(columns)
    for name in (*CLAMP_READINGS, "foot_x", "contact_arc_length", "tip_angle"):
        found[name] = np.where(inexact, np.nan, columns[name])
    found["status"] = np.where(inexact, "diverged", columns["status"])
    return found


class _Span(NamedTuple):
    """A span, and what it misses at its other end of slope and moment."""

    along: Floats
    across: Floats
    theta: Floats
    m: Floats


def _span(
    vibrissa: Vibrissa,
    clamp: tuple[Floats, Floats],
    contact: tuple[Floats, Floats],
    force: Floats,
    length: Floats,
) -> _Span:
    """The span between slope and moment at the clamp and at the contact."""
    if vibrissa.form is not None:
        end = march(vibrissa.form, *contact, force, length, finer=2)
        return _Span(end.along, end.across, end.theta - clamp[0], end.m - clamp[1])
    # A span run through from its other end has the opposite curvature.
    natural = vibrissa.natural_curvature
    start = back_to_clamp(clamp[0], -clamp[1] - natural, force, length)
    slope = np.pi / 2 - 2 * np.arctan2(start.p, start.g)
    return _Span(start.along, start.across, slope - contact[0], -start.kappa - natural - contact[1])
