"""Readings from a rig: other column names, units, and the vibrissa told apart."""

import tomllib
from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from analytic import SENSED, Beam, InputError, Readings
from compare.read.case import read_beam
from compare.read.units import DIMENSIONS, in_si


def read_measured(
    path: Path,
    beam_file: Path | None = None,
    columns: Sequence[str] = (),
    otherwise: Beam = Beam(),  # noqa: B008  # frozen
) -> Readings:
    """A file of readings, its columns renamed and converted, for a vibrissa from a TOML file.

    Parameters
    ----------
    path : Path
        Parquet or CSV.
    beam_file : Path, optional
        TOML file with a ``[beam]`` table; by default the file's own metadata, or `otherwise`.
    columns : sequence of str
        ``NAME=COLUMN`` or ``NAME=COLUMN:UNIT``: which of the file's columns is the sensed quantity
        NAME, and in which unit. With units everything becomes SI, so the beam must be in units too.
    otherwise : Beam
        The vibrissa, if nothing tells of another one.

    Raises
    ------
    InputError
        If the file, the beam, a column or a unit cannot be used.
    """
    if not columns and beam_file is None:
        return Readings.read(path, otherwise)
    table = Readings.read_table(path)
    for text in columns:
        name, _, rest = text.partition("=")
        column, _, unit = rest.partition(":")
        if name not in SENSED or not column:
            raise InputError(
                "--column",
                repr(text),
                "NAME=COLUMN or NAME=COLUMN:UNIT",
                f"NAME is one of {', '.join(SENSED)}",
            )
        if column not in table:
            raise InputError(
                f"column {column!r} of {path}",
                "missing",
                f"one of {', '.join(map(str, table.columns))}",
                "check --column",
            )
        values = pd.to_numeric(table[column], errors="coerce")
        if unit:
            values = values * in_si(f"1 {unit}", DIMENSIONS[name])
        table[name] = values
    beam = otherwise if beam_file is None else _beam(beam_file)
    return Readings(table, beam, f"measured, {path.name}")


def _beam(file: Path) -> Beam:
    try:
        raw = tomllib.loads(file.read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise InputError("--beam", file, "a readable TOML file", f"mend it: {error}") from error
    return read_beam(raw, file)
