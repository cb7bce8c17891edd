"""The readings of vibrissae at rest, column by column, and what is recorded of their sweep.

Phase and status are by their numbers.
"""

from collections.abc import Mapping, Sequence
from functools import cache, partial
from importlib.metadata import version
from typing import NamedTuple, TypeAlias

import numpy as np

from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.problem.beam import Beam
from analytic.problem.case import Case
from analytic.problem.columns import (
    CLAMP_READINGS,
    COLUMNS,
    CONTACT,
    PHASE_NUMBER,
    SECOND_CONTACT,
    STATUS_NUMBER,
)
from analytic.problem.contours.contour import ContourPoint
from analytic.problem.readings import Readings, solved_readings
from analytic.problem.recorder import running_values
from analytic.solver.general.states import States, Vibrissa

Numbers: TypeAlias = Floats | Integers
ReadingColumns: TypeAlias = dict[str, Numbers]
READINGS = (*CLAMP_READINGS, "foot_x", "contact_arc_length", "tip_angle")
"""What a state that is none does not have."""

Points = Mapping[str, float | None]
"""Parameters of the clamp's way of what happens, by name; foot positions [L] of a sweep."""


class Units(NamedTuple):
    """What dimensionless results are multiplied by: of a beam, or of each contact's, shape (n,)."""

    length: float | Floats
    force: float | Floats
    moment: float | Floats

    @classmethod
    def of(cls, beam: Beam) -> "Units":
        return cls(beam.length, beam.force_unit, beam.moment_unit)

    @classmethod
    def of_each(cls, beams: Sequence[Beam], whose: Integers) -> "Units":
        return cls(*np.array([cls.of(beam) for beam in beams]).T[:, whose])

    def part(self, chosen: Booleans) -> "Units":
        return Units(*(np.broadcast_to(unit, chosen.shape)[chosen] for unit in self))


def columns_at_rest(vibrissa: Vibrissa, foot_x: Floats, units: Units) -> ReadingColumns:
    """The readings of one that touches nothing, at foot positions [length]."""
    rest, (w_x, w_y) = vibrissa.at_rest, vibrissa.weight
    tip_angle = float(rest.shape.at(np.array(1.0))[2])
    columns = unloaded_columns(foot_x, tip_angle)
    columns["force_x"][:] = 0.0 - w_x * units.force
    columns["force_y"][:] = 0.0 - w_y * units.force
    columns["moment_z"][:] = rest.moment * units.moment
    return columns


def unloaded_columns(foot_x: Floats, tip_angle: float | Floats = np.pi / 2) -> ReadingColumns:
    """The readings of vibrissae without weight that touch nothing."""
    empty = np.full((len(COLUMNS), foot_x.size), np.nan)
    columns: ReadingColumns = dict(zip(COLUMNS, empty, strict=True))
    columns["foot_x"] = foot_x
    for name in CLAMP_READINGS:
        columns[name].fill(0.0)
    columns["phase"] = np.full(foot_x.size, PHASE_NUMBER["free"])
    columns["tip_angle"][:] = tip_angle
    columns["status"] = np.full(foot_x.size, STATUS_NUMBER["ok"])
    return columns


def to_columns(found: States, units: Units) -> ReadingColumns:
    """The readings of states at rest; NaN in their excess marks what no vibrissa reaches."""
    vibrissa, (w_x, w_y) = found.vibrissa, found.vibrissa.weight
    at = _at_contact(found.point, found.force, found.arc_length, vibrissa, units)
    columns: ReadingColumns = {
        "foot_x": found.foot_x * units.length,
        "force_x": at["force_x"] - w_x * units.force,
        "force_y": at["force_y"] - w_y * units.force,
        "moment_z": found.moment * units.moment,
        "phase": np.where(found.tangent, PHASE_NUMBER["tangent"], PHASE_NUMBER["tip"]),
        **{name: at[name] for name in CONTACT[:-1]},
        "tip_angle": found.last_angle,
        "status": np.where(
            np.isnan(found.excess), STATUS_NUMBER["unreachable"], STATUS_NUMBER["ok"]
        ),
    }
    inner = found.inner
    if inner is None:
        return columns
    # The contact nearer to the clamp is the first one, and the clamp holds both forces.
    columns |= {f"second_{name}": columns[name] for name in CONTACT[:-1]}
    columns["second_contact_force"] = found.force * units.force
    columns["phase"] = np.full(len(inner.force), PHASE_NUMBER["tangent"])
    first = _at_contact(inner.point, inner.force, found.arc_length - inner.apart, vibrissa, units)
    for name in ("force_x", "force_y"):
        first[name] = np.asarray(columns[name] + first[name])
    return {**columns, **first}


def _at_contact(
    point: ContourPoint, force: Floats, arc_length: Floats, vibrissa: Vibrissa, units: Units
) -> dict[str, Floats]:
    """Where a contact is, and what of it the clamp holds."""
    sine, cosine, mu = np.sin(point.alpha), np.cos(point.alpha), vibrissa.friction
    return {
        "force_x": -force * units.force * (sine + mu * cosine),
        "force_y": force * units.force * (cosine - mu * sine),
        "contact_angle": point.alpha,
        "contact_arc_length": arc_length * units.length,
        "contact_x": (point.xi - vibrissa.radius * sine) * units.length,
        "contact_y": (point.eta + vibrissa.radius * cosine) * units.length,
    }


def without(columns: ReadingColumns, which: Booleans, status: str) -> ReadingColumns:
    """The same, but some without readings and with a status that says why."""
    if not which.any():
        return columns
    found = {**columns, "status": np.where(which, STATUS_NUMBER[status], columns["status"])}
    nowhere = (*READINGS, *(name for name in SECOND_CONTACT if name in columns))
    return found | {name: np.where(which, np.nan, columns[name]) for name in nowhere}


def as_readings(case: Case, columns: ReadingColumns, events: Points, finite: bool) -> Readings:
    """The readings of a case whose sweep to the left, or its mirror image's, is solved."""
    if case.direction == "right":
        from analytic.problem.table import mirrored_columns  # slow to load, and few sweeps need it

        columns = mirrored_columns(columns)
    places = running_values(case, events)
    record = partial(_provenance, case, places)
    return solved_readings(columns, case.beam, "analytic", record, places["snap_off"], finite)


def _provenance(case: Case, events: Points) -> dict[str, object]:
    return {**case.provenance(), "engine": engine(), "events": dict(events)}


@cache
def engine() -> str:
    return f"vibrissa-testbed {version('vibrissa-testbed')}"
