"""How well readings satisfy their conditions, by way from the clamp to the contact.

The solver goes from the contact to the clamp; this is the way back, from the clamp's readings
alone. Where rigidity or natural curvature vary it is the solver's way on panels of half the length,
so that it shows the error of collocation: clamp readings of double precision do not determine the
slope of a tip that is sharp.
"""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from analytic.checks.of_two import Reached, dimensionless, misses_of_two, touches_twice
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.columns import PHASE_NUMBER, STATUS_NUMBER
from analytic.solver.elastica import span_of_moment
from analytic.solver.general.columns import Numbers, ReadingColumns, Units, without
from analytic.solver.general.span import back_to_clamp, march
from analytic.solver.general.states import Vibrissa

_ROUNDING = 1e-13  # of the weight; of the moment of one that touches nothing
_SOLVED = 1e-11  # of what a state misses: hundreds of roundings at the sharpest bends


def inexact(checked: Mapping[str, Floats], status: Numbers) -> Booleans:
    """Which stations of a sweep are not solved, but for those that are known to be none."""
    solved = np.maximum(*checked.values()) <= _SOLVED
    return np.asarray(~solved & (status != STATUS_NUMBER["touches again"]))


def without_inexact(columns: ReadingColumns, vibrissa: Vibrissa, units: Units) -> ReadingColumns:
    """The readings of states at rest, but for those that collocation has not solved well enough."""
    if vibrissa.rod is None:
        return columns
    ok = columns["status"] == STATUS_NUMBER["ok"]
    wrong = ok & inexact(residuals(columns, vibrissa, units), columns["status"])
    return without(columns, wrong, "diverged")


@np.errstate(divide="ignore", invalid="ignore")  # free stations: no force, no contact
def residuals(columns: ReadingColumns, vibrissa: Vibrissa, units: Units) -> dict[str, Floats]:
    """What the stations of a table of readings miss; nothing where they are free."""

    def column(name: str, unit: float | Floats = 1.0) -> Floats:
        return np.asarray(columns[name], dtype=float) / unit

    mu = vibrissa.friction
    w_x, w_y = vibrissa.weight  # the clamp carries it beside the contact's force
    force_x = column("force_x", units.force) + w_x
    force_y = column("force_y", units.force) + w_y
    moment = column("moment_z", units.moment)
    foot_x, xi, eta, length = (
        column(name, units.length)
        for name in ("foot_x", "contact_x", "contact_y", "contact_arc_length")
    )
    alpha, foot_y = column("contact_angle"), np.zeros_like(xi)
    if "foot_y" in columns:
        foot_y = column("foot_y", units.length)
    if "clamp_angle" in columns:
        vibrissa = vibrissa._replace(clamp_angle=column("clamp_angle"))
    tip_angle = column("tip_angle")
    slope = tip_angle - vibrissa.turn_after(length)
    along = alpha + vibrissa.lean
    on_side = np.where(slope - alpha > np.pi / 2, alpha + np.pi - vibrissa.lean, along)
    tangent = columns["phase"] == PHASE_NUMBER["tangent"]
    held = np.where(tangent, on_side, tip_angle)
    hung = vibrissa.hung(held, length)
    radius = vibrissa.radius_at(length)
    x, y = xi + radius * np.sin(alpha) - foot_x, eta - radius * np.cos(alpha) - foot_y
    force, lean = np.hypot(force_x, force_y), np.arctan(mu)
    # Of no force, as where a tip leaves the object, any direction is right.
    direction = np.where(force > 0, np.arctan2(-force_x, force_y), alpha + lean)
    couple = mu / np.sqrt(1 + mu**2) * radius * force
    turned, tip_missed = direction - lean - alpha, np.zeros_like(x)
    if hung is not None:  # of a small force beside a large weight the direction is lost
        direction, turned = alpha + lean, force * turned
        slope, tip_missed = held, hung.slope[:, -1] - tip_angle
        couple = couple - hung.base
    span = _span(vibrissa, moment, slope - direction, couple, force, direction, length)
    sin, cos = np.sin(direction), np.cos(direction)
    missed = [
        span.along * cos - span.across * sin - x,
        span.along * sin + span.across * cos - y,
        span.first,
        span.second,
        turned,
        tip_missed,
        np.maximum(0.0, length - 1),
        np.maximum(0.0, along - slope),
        np.where(tangent, slope - on_side, 0.0),
    ]
    extent = np.maximum(1.0, np.abs(xi))
    unbalanced = moment - (force_y * x - force_x * y) - couple if hung is None else span.second
    free = np.isnan(length) & (moment == 0)
    if hung is not None:
        unheld = np.abs(moment - vibrissa.at_rest.moment) <= _ROUNDING * np.hypot(w_x, w_y)
        free = np.isnan(length) & unheld
    checked = {
        "residual_boundary": np.where(free, 0.0, np.abs(missed).max(axis=0) / extent),
        "residual_moment": np.where(
            free, 0.0, np.abs(unbalanced) / np.maximum(extent, np.abs(moment))
        ),
    }
    if (two := touches_twice(columns)).any():
        found = _of_two(columns, two, vibrissa, units)
        for values, missed_by in zip(checked.values(), found, strict=True):
            values[two] = missed_by
    return checked


def _of_two(
    columns: ReadingColumns, two: Booleans, vibrissa: Vibrissa, units: Units
) -> tuple[Floats, Floats]:
    natural = vibrissa.natural_curvature

    def span(
        force_x: Floats, force_y: Floats, moment: Floats, slope: Floats, length: Floats
    ) -> Reached:
        direction = np.arctan2(-force_x, force_y)
        force = np.hypot(force_x, force_y)
        end = back_to_clamp(slope - direction, moment - natural, force, length)
        phi = direction + np.pi / 2 - 2 * np.arctan2(end.p, end.g)
        return Reached(*end.way(direction), phi, -end.kappa - natural)

    read = dimensionless(columns, two, *map(float, units))
    mu, radius = float(vibrissa.friction), float(vibrissa.radius)
    return misses_of_two(read, mu, radius, natural, vibrissa.compliance, span)


class _Span(NamedTuple):
    """A span along and across the force, and what it misses at the end to which it is marched."""

    along: Floats
    across: Floats
    first: Floats
    second: Floats


def _span(
    vibrissa: Vibrissa,
    moment: Floats,
    slope: Floats,
    couple: Floats,
    force: Floats,
    direction: Floats,
    length: Floats,
) -> _Span:
    """The span from the moment at the clamp to slope, from the force's, and couple at its end."""
    if vibrissa.is_plain:
        # Up to where the curvature vanishes, by the first integral sin(slope) there.
        root_f = np.sqrt(force)
        q, C, S = (values / root_f for values in span_of_moment(moment / root_f, direction))
        sine = np.cos(direction) - moment**2 / (2 * force)
        return _Span(C, S, q - length, sine - np.sin(slope))
    clamp = np.pi / 2 + vibrissa.clamp_angle - vibrissa.compliance * moment - direction
    if vibrissa.rod is not None:
        ends = slope, -couple, force, length
        end = march(vibrissa.rod, *ends, direction=direction, finer=2)
        return _Span(end.along, end.across, end.theta - clamp, end.m + moment)
    # A span run through from its other end has the opposite curvature.
    natural = vibrissa.natural_curvature
    start = back_to_clamp(clamp, moment - natural, force, length)
    reached = np.pi / 2 - 2 * np.arctan2(start.p, start.g)
    return _Span(start.along, start.across, reached - slope, couple - start.kappa - natural)
