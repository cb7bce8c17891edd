"""Readings in space from other simulators and rigs: their columns, units and frame."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from analytic import Beam, InputError
from analytic.problem.files import as_path
from analytic.problem.readings_file import is_ours, read_file
from analytic.space import SpatialReadings
from analytic.space.problem.readings import CONTACT_POINT, SENSED_IN_SPACE
from compare.align.frames import Frame, from_frame
from compare.read.kinds import TABLES
from compare.read.rig import raw_table, renamed

_ALSO = (*CONTACT_POINT, "phase", "status")  # what a simulator may know beside them


def is_spatial(path: Path) -> bool:
    """Whether a file holds a sweep in space that this project wrote."""
    if path.suffix.lower() not in TABLES or not path.is_file():
        return False
    try:
        return is_ours(path) and "tangent" in read_file(path).metadata
    except InputError:
        return False


def read_space(
    path: str | Path,
    beam: Beam | None = None,
    tangent: ArrayLike | None = None,
    columns: Sequence[str] = (),
    frame: Frame = "world",
) -> SpatialReadings:
    """One sweep in space, of any source.

    Parameters
    ----------
    path : str or Path
        A Parquet or text file with any separator and decimal mark.
    beam : Beam, optional
        The vibrissa, if the file names none; ``Beam()`` if not given.
    tangent : array_like, shape (3,), optional
        Of the clamp, if the file names none; upright if not given.
    columns : sequence of str
        ``NAME=COLUMN`` or ``NAME=COLUMN:UNIT``, NAME of `SENSED_IN_SPACE`.
    frame : {"world", "clamp"}
        Of the components in the file; what this project wrote is in the world's.

    Returns
    -------
    SpatialReadings
        In the world's frame.

    Raises
    ------
    InputError
        If the file, a column or a unit cannot be used, a cell is no number, columns have units and
        the vibrissa none, or there is no such frame.
    """
    path = as_path(path, "readings file")
    if is_ours(path) and not columns:
        return SpatialReadings.read(path, beam, tangent)
    table, used, _ = renamed(raw_table(path), columns, path.name, SENSED_IN_SPACE)
    held = Beam() if beam is None else beam
    if used and not held.si:
        what = ", ".join(sorted(set(used.values())))
        remedy = 'give the case with units: length = "50 mm" and the like'
        raise InputError(f"units of {path.name}", what, "beside a vibrissa with units", remedy)
    upright = (0.0, 1.0, 0.0) if tangent is None else np.asarray(tangent)
    known = table[[*SENSED_IN_SPACE, *(name for name in _ALSO if name in table)]]
    provenance = {"units": used} if used else {}
    return from_frame(SpatialReadings(known, held, upright, path.name, provenance), frame)
