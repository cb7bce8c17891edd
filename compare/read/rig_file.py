"""A rig described once, for all its files: columns, units, calibration, vibrissa."""

from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, Field

from analytic import SENSED, InputError
from compare.read.quantities import Length, Table, validated
from compare.read.tables import BeamTable
from compare.read.toml import TomlFile
from compare.read.units import DIMENSIONS, unit_in_si


class RigColumn(Table):
    """Which column of a file is a sensed quantity: value = gain (cell - zero), in the unit."""

    column: str
    unit: str = ""
    gain: float = 1.0
    zero: float = 0.0

    def scale(self, name: str) -> float:
        """What a cell's unit is in those of the readings."""
        called, dimension = f"columns.{name}.unit", DIMENSIONS.get(name, "s")
        return self.gain * (unit_in_si(self.unit, dimension, called) if self.unit else 1.0)


class RigColumns(Table):
    foot_x: RigColumn
    force_x: RigColumn
    force_y: RigColumn
    moment_z: RigColumn
    time: RigColumn | None = None

    def __getitem__(self, name: str) -> RigColumn:
        column: RigColumn = getattr(self, name)
        return column


def _not_negative(value: float) -> float:
    """After the unit: a plain validator hides a field's own limits."""
    if value < 0:
        raise ValueError("must be 0 or more")
    return value


_Stretch = Annotated[Length, AfterValidator(_not_negative)]


class RigPasses(Table):
    """How the rows of a file are passes of the foot, and where these are certainly free."""

    # A column whose value changes from pass to pass; without it the stage's turns divide them.
    column: str | None = None
    # The first and the last stretch of a pass, in which the vibrissa touches nothing: what the
    # sensor reads there is its zero, taken off along a straight line from one to the other.
    free_before: _Stretch = 0.0
    free_after: _Stretch = 0.0
    # How far the foot goes until a reading of its place is there: taken off in either direction.
    lag: Length = 0.0


class Rig(Table):
    beam: BeamTable  # the vibrissa, in units if the columns are
    columns: RigColumns  # by sensed quantity
    passes: RigPasses = RigPasses()  # how rows are passes
    # What the rig writes into a cell for which it has no number, as ``"OVL"``.
    missing: Annotated[list[str], Field(max_length=100, default_factory=list)]


def read_rig(path: Path) -> Rig:
    file = TomlFile.read(path, "description of the rig")
    rig = validated(Rig, file.tables, file.place)
    in_units = any(rig.columns[name].unit for name in SENSED)
    for name in SENSED:
        unit = rig.columns[name].unit
        if bool(unit) != in_units or in_units != rig.beam.build().si:
            what = f"unit {unit!r}" if unit else "without a unit"
            allowed = "with units all four and [beam], or none of them"
            remedy = 'as { column = "Fx", unit = "mN" } beside length = "50 mm"'
            raise InputError(file.place(["columns", name]), what, allowed, remedy)
        if unit:
            unit_in_si(unit, DIMENSIONS[name], file.place(["columns", name, "unit"]))
        if rig.columns[name].gain == 0:
            raise InputError(file.place(["columns", name, "gain"]), 0, "not 0", "correct it")
    return rig
