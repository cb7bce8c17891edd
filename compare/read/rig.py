"""Readings from a rig: its own files, columns and units, a vibrissa described elsewhere."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import TypeAlias, get_args

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analytic import CLAMP_READINGS, SENSED, Beam, Direction, InputError, Readings
from analytic.numerics.arrays import Floats
from analytic.problem.files import as_path
from analytic.problem.readings_file import is_ours
from analytic.problem.table import as_numbers
from compare.read.assumed import BEAM_WANTED, assumed_of
from compare.read.dialect import RawTable, read_text_table
from compare.read.kinds import TEXTS
from compare.read.tables import read_beam
from compare.read.units import DIMENSIONS, OWN_UNITS, check_unit, unit_in_si
from compare.sense.record import retreats

Source: TypeAlias = "str | Path | pd.DataFrame | Mapping[str, ArrayLike]"

_TURN = 0.02  # of the stage's travel; a shorter way back is the stage's noise
_WHOLE_SWEEP = 0.5  # of the stage's travel; what goes less far is no sweep of its own


def read_measured(
    source: Source,
    beam: Path | Beam | None = None,
    columns: Sequence[str] = (),
    otherwise: Beam | None = None,
    direction: Direction | None = None,
) -> Readings:
    """One sweep of a rig: its columns renamed and converted, its rows in the order of the sweep.

    Parameters
    ----------
    source : path, pandas.DataFrame or mapping
        A Parquet or text file with any separator and decimal mark, or a table by columns.
    beam : Path or Beam, optional
        The vibrissa, or a TOML file with a ``[beam]`` table; by default what the file says, or
        `otherwise`.
    columns : sequence of str
        ``NAME=COLUMN`` or ``NAME=COLUMN:UNIT``: which column is the sensed quantity NAME, and in
        which unit; without UNIT it is that of the file's line of units, if it has one. With units
        everything becomes SI, so the beam must be in units too. Columns of a file without names
        are called ``1``, ``2``, ...
    otherwise : Beam, optional
        The vibrissa, if nothing else says. By default that is ``Beam()``, if no column has a unit
        and the readings can be of a vibrissa with L = EI = 1; ``provenance`` says so.
    direction : {"left", "right"}, optional
        Which sweep, if there is one in each direction.

    Returns
    -------
    Readings
        Rows at one and the same foot position, one after the other, are averaged, and rows out of
        order are sorted; ``provenance["rows"]`` counts them.

    Raises
    ------
    InputError
        If the file, the beam, a column or a unit cannot be used, a cell is no number, the vibrissa
        is missing, or there are several sweeps.
    """
    if direction not in (None, *get_args(Direction)):
        raise InputError("direction", repr(direction), "'left' or 'right'", "or leave it out")
    sweeps = read_sweeps(source, beam, columns, otherwise)
    chosen = [one for way, one in sweeps if len(sweeps) == 1 or direction in (None, way)]
    if len(chosen) != 1:
        ways = ", ".join(f"one to the {way}" for way, _ in sweeps)
        allowed = "one" if direction is None else f"one to the {direction}"
        remedy = "choose its direction (--direction left, direction='left'), or split it"
        raise InputError(f"sweeps in {_called(source)}", f"{len(sweeps)} ({ways})", allowed, remedy)
    check_recorded(chosen[0], _called(source))
    return chosen[0]


def check_recorded(readings: Readings, called: str) -> None:
    for name in CLAMP_READINGS:
        if not np.isfinite(readings.values(name)).any():
            remedy = "the channel was not recorded: leave this one out"
            raise InputError(
                f"{name} of {called}", "without any number", "read in some rows", remedy
            )


def read_sweeps(
    source: Source,
    beam: Path | Beam | None = None,
    columns: Sequence[str] = (),
    otherwise: Beam | None = None,
) -> list[tuple[Direction, Readings]]:
    """All sweeps that a file of a rig holds, as there and back.

    Parameters
    ----------
    source, beam, columns, otherwise
        As of `read_measured`.

    Returns
    -------
    list of (direction, Readings)
        In the order of the rows; a file that an engine wrote holds one. `compare.separate_lag`
        takes the offsets of one sweep in each direction.

    Raises
    ------
    InputError
        As `read_measured` does.
    """
    if not isinstance(source, pd.DataFrame | Mapping):
        source = as_path(source, "readings file")
    given, held = read_beam(beam) if isinstance(beam, Path) else (beam, {})
    assumed = Beam()
    if isinstance(source, Path) and is_ours(source) and not columns:
        readings = Readings.read(source, otherwise or assumed)
        if given is not None:
            provenance = {**readings.provenance, **held}
            readings = replace(readings, beam=given, provenance=provenance)
        sweeps = [(_way(readings), readings)]
    else:
        raw, called, known = raw_table(source), _called(source), given or otherwise
        table, used, own = renamed(raw, columns, called)
        allowed = "given in units, as the columns are"
        if used and known is None:
            raise InputError("vibrissa", "none given", allowed, BEAM_WANTED)
        if used and isinstance(beam, Path) and given is not None and not given.si:
            plain = f"without units (length = {given.length:g})"
            remedy = 'write length = "50 mm" and the like'
            raise InputError(f"[beam] of {beam}", plain, allowed, remedy)
        units_used = {name: x for name, x in (("units", used), (OWN_UNITS, own)) if x}
        provenance = {**units_used, **held}
        sweeps = _sweeps(Readings.of(table, known or assumed, called, provenance, raw.place))
    return [(way, assumed_of(one) if one.beam is assumed else one) for way, one in sweeps]


def _called(source: Source) -> str:
    return Path(source).name if isinstance(source, str | Path) else "table"


def raw_table(source: Source) -> RawTable:
    if isinstance(source, pd.DataFrame):
        return RawTable(source)
    if isinstance(source, Mapping):
        try:
            return RawTable(pd.DataFrame(dict(source)))
        except (ValueError, TypeError) as error:
            allowed = "columns of one length by name"
            raise InputError("readings", "no table", allowed, str(error)) from error
    path = Path(source)
    if path.suffix == ".parquet" or is_ours(path):
        return RawTable(Readings.read_table(path))
    if path.suffix.lower() not in TEXTS:
        allowed = f"named *.parquet, *{', *'.join(TEXTS)}"
        raise InputError("readings file", path, allowed, "rename it")
    return read_text_table(path)


def renamed(
    raw: RawTable, columns: Sequence[str], called: str, sensed: Sequence[str] = SENSED
) -> tuple[pd.DataFrame, dict[str, str], dict[str, str]]:
    """The table with the sensed quantities under their own names and, with units, in SI."""
    table, place, units = raw
    named: dict[str, Floats] = {}
    used: dict[str, str] = {}
    own: dict[str, str] = {}
    for text in [columns] if isinstance(columns, str) else columns:
        name, _, rest = text.partition("=")
        # Names of columns may have colons, units never do.
        column, unit = (rest, "") if rest in table else rest.rpartition(":")[::2]
        column, unit = (column, unit) if column else (unit, "")
        if name not in sensed or not column:
            remedy = f"NAME is one of {', '.join(sensed)}"
            allowed = "NAME=COLUMN or NAME=COLUMN:UNIT"
            raise InputError("--column", repr(text), allowed, remedy)
        if name in named:
            raise InputError("--column", repr(text), f"the only one for {name}", "leave one out")
        named[name] = as_numbers(cells(table, column, called, "check --column"), column, place)
        if unit:
            check_unit(unit, column, units.get(column, ""), DIMENSIONS[name])
            used[name] = unit
        elif units.get(column):
            own[name] = units[column]
    for name in sensed:
        if units.get(name) and name not in named:
            named[name], own[name] = as_numbers(table[name], name, place), units[name]
    used |= own
    for name, unit in used.items():
        named[name] = named[name] * unit_in_si(unit, DIMENSIONS[name])
    found = table.assign(**named)
    missing = [name for name in sensed if name not in found]
    if missing and not table.columns.empty:
        what = ", ".join(map(str, table.columns[:20]))
        remedy = f"name them with --column {missing[0]}=COLUMN:{DIMENSIONS[missing[0]]}"
        raise InputError(f"columns of {called}", what, f"at least {', '.join(sensed)}", remedy)
    return found, used, own


def cells(table: pd.DataFrame, column: str, called: object, remedy: str) -> pd.Series:
    if column in table:
        return table[column]
    there = ", ".join(map(str, table.columns[:20]))
    raise InputError(f"column {column!r} of {called}", "missing", f"one of {there}", remedy)


def _sweeps(readings: Readings) -> list[tuple[Direction, Readings]]:
    """The sweeps that rows in the order of time make up."""
    foot_x = readings.values("foot_x")
    turns = _turns(foot_x)
    travel = np.abs(np.diff(foot_x[[0, *turns, -1]]))
    if (travel < _WHOLE_SWEEP * np.ptp(foot_x)).any():
        # In no order: only the side to which the vibrissa bends shows which way it was swept.
        way: Direction = "right" if readings.bends_left else "left"
        return [(way, _in_order(readings, way))]
    # The row at a turn belongs to the sweep that ends there.
    # Written one below the other, two sweeps have the stage's way back between two rows.
    edges = [0, *(turn + 1 for turn in turns if turn - 1 not in turns), len(foot_x)]
    tables = [readings.table.iloc[begin:end] for begin, end in pairwise(edges)]
    parts = [replace(readings, table=one.reset_index(drop=True)) for one in tables]
    return [(_way(one), _in_order(one, _way(one))) for one in parts]


def _way(readings: Readings) -> Direction:
    first, last = readings.values("foot_x")[[0, -1]]
    return "left" if first > last else "right"


def _turns(foot_x: Floats) -> list[int]:
    """Rows where the stage turns for good."""
    steps = np.diff(foot_x)
    if (steps >= 0).all() or (steps <= 0).all():
        return []
    from scipy.signal import find_peaks  # slow to load, and few sweeps turn

    least = _TURN * float(np.ptp(foot_x))
    found = (find_peaks(x, prominence=least, plateau_size=1)[1] for x in (foot_x, -foot_x))
    return sorted(int(row) for one in found for row in one["right_edges"])


def _in_order(readings: Readings, way: Direction) -> Readings:
    """A sweep with its rows sorted, and those at one foot position averaged."""
    table, rising = readings.table, way == "right"
    steps = table["foot_x"].diff()
    back = int((steps < 0 if rising else steps > 0).sum())
    if back:
        table = table.sort_values("foot_x", kind="stable", ascending=rising)
    station = table["foot_x"].diff().ne(0).cumsum().to_numpy()
    repeated = len(table) - station[-1]
    if repeated:
        how = {
            name: "mean" if pd.api.types.is_float_dtype(column) else "first"
            for name, column in table.items()
        }
        table = table.groupby(station).agg(how)
    if not (back or repeated):
        return readings
    rows = {"out_of_order": back, "retreats": retreats(readings), "averaged": int(repeated)}
    provenance = {**readings.provenance, "rows": rows}
    return replace(readings, table=table.reset_index(drop=True), provenance=provenance)
