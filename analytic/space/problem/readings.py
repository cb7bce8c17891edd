"""One sweep's readings in space: six components at the clamp, and the contact."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.beam import Beam
from analytic.problem.errors import InputError, Place, row_number
from analytic.problem.files import as_path
from analytic.problem.numbers import direction
from analytic.problem.readings_file import read_file
from analytic.problem.sweep_table import SweepTable, usable
from analytic.problem.table import as_numbers, check_columns, check_words

FOOT = ("foot_x", "foot_y", "foot_z")
FORCE = ("force_x", "force_y", "force_z")
MOMENT = ("moment_x", "moment_y", "moment_z")
SENSED_IN_SPACE = (*FOOT, *FORCE, *MOMENT)
"""What the clamp of a sweep in space knows: where it is, force and moment."""
CONTACT_POINT = ("contact_x", "contact_y", "contact_z")
NORMAL = ("normal_x", "normal_y", "normal_z")
FRICTION = ("friction_x", "friction_y", "friction_z")  # over the normal force, on the vibrissa
PHASES_IN_SPACE = ("free", "tip", "tangent")
STATUSES_IN_SPACE = (
    "ok",
    "diverged",
    "slipped off",
    "sticks",
    "unsettled",
    "chattering",
    "creeping",
    "lost",
)
_WORDS = {"phase": PHASES_IN_SPACE, "status": STATUSES_IN_SPACE}


@dataclass(frozen=True, eq=False, repr=False)
class SpatialReadings(SweepTable):
    """One sweep in space, in the units of its beam.

    Parameters
    ----------
    table : pandas.DataFrame
        A row a station in the order of the sweep. ``foot_*`` [length], ``force_*`` [force] and
        ``moment_*`` [force length] are the clamp's action on the vibrissa at the foot, in the world
        frame: y up, x, y, z right-handed. ``travel`` [length] is the way of the foot.
        ``contact_*`` [length] is the contact on the body's surface, ``normal_*`` the body's outward
        normal there, ``contact_angle`` [rad] the surface's slope against the plane across the
        clamp's tangent, ``contact_arc_length`` [length] its place on the vibrissa, ``friction_*``
        friction on it over the normal force, ``slip_speed`` that of the vibrissa's point along the
        body over the foot's; ``phase`` and
        ``status`` are words. All but the nine sensed columns may be missing.
    beam : Beam
        The vibrissa that was swept.
    tangent : array_like, shape (3,)
        Of the vibrissa at its clamp.
    source : str
        Who produced the readings.
    provenance : mapping
        Versions, case, events; anything JSON can hold.

    Raises
    ------
    InputError
        If a sensed column is missing, a cell is no number, a foot position is missing, or a phase
        or status is unknown.
    """

    table: pd.DataFrame
    beam: Beam = field(default_factory=Beam)
    tangent: ArrayLike = (0.0, 1.0, 0.0)
    source: str = "measured"
    provenance: Mapping[str, Any] = field(default_factory=dict)
    sensed: ClassVar[tuple[str, ...]] = SENSED_IN_SPACE
    panels: ClassVar[Mapping[str, tuple[str, ...]]] = {"force": FORCE, "moment": MOMENT}

    def __post_init__(self) -> None:
        self._check_kinds()
        object.__setattr__(self, "tangent", direction("readings' tangent", self.tangent))
        object.__setattr__(self, "table", _checked(self.table, self.source, row_number))

    @property
    def clamp_tangent(self) -> Floats:
        """Direction of the vibrissa at its clamp, of length 1, shape (3,)."""
        return np.asarray(self.tangent)

    @property
    def running(self) -> str:
        """The column over which the sweep runs; where it is missing, its steps are added up."""
        return "travel"

    @property
    def running_values(self) -> Floats:
        """How far along its path the foot is at the stations [length]."""
        recorded = self.values("travel")
        if np.isfinite(recorded).all():
            return recorded
        steps = np.linalg.norm(np.diff(self.values(*FOOT), axis=0), axis=1)
        return np.concatenate([[0.0], np.cumsum(steps)])

    @property
    def touching(self) -> Booleans:
        """Trusted stations with a force, shape (stations,)."""
        force = np.linalg.norm(self.values(*FORCE), axis=1)
        return np.asarray(self.trusted & (force > 1e-9 * self.beam.force_unit))

    def _metadata(self) -> dict[str, Any]:
        return {**super()._metadata(), "tangent": self.clamp_tangent.tolist()}

    @classmethod
    def read(
        cls, path: str | Path, beam: Beam | None = None, tangent: ArrayLike | None = None
    ) -> "SpatialReadings":
        """Read what `write` wrote, or measured data with the nine sensed columns.

        Parameters
        ----------
        path : str or Path
            Named ``*.parquet`` or ``*.csv``.
        beam : Beam, optional
            The vibrissa if the file names none; ``Beam()`` if not given.
        tangent : array_like, shape (3,), optional
            Of the clamp if the file names none; upright if not given.

        Returns
        -------
        SpatialReadings
            One sweep.

        Raises
        ------
        InputError
            If the file is missing, damaged or not a sweep in space; with line and column of a cell
            that cannot be read.
        """
        path = as_path(path, "readings file")
        content = read_file(path)
        metadata = content.metadata
        with usable(path):
            known = metadata.get("beam")
            otherwise = Beam() if beam is None else beam
            upright = (0.0, 1.0, 0.0) if tangent is None else tangent
            return cls(
                _checked(content.table, path.name, content.place),
                otherwise if known is None else Beam(**known),
                metadata.get("tangent", upright),
                metadata.get("source", path.name),
                metadata.get("provenance", {}),
            )


def _checked(table: pd.DataFrame, source: str, place: Place) -> pd.DataFrame:
    check_columns(table, SENSED_IN_SPACE, source)
    columns = {}
    for name in table.columns:
        if name in _WORDS:
            check_words(table[name], name, _WORDS[name], place)
            columns[name] = table[name].to_numpy(dtype=object)
        else:
            columns[name] = as_numbers(table[name], str(name), place)
    found = pd.DataFrame(columns)
    lost = found[list(FOOT)].isna().any(axis=1).to_numpy()
    if lost.any() or len(found) < 1:
        where = f"foot position, {place(int(np.argmax(lost)) if lost.any() else 0)},"
        raise InputError(where, "missing", "three numbers", "drop the row, or fill it")
    return found
