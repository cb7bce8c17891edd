"""One sweep's readings: the table that every engine, rig and comparison speaks."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.beam import Beam
from analytic.problem.columns import CLAMP_READINGS, SCHEMA, SENSED
from analytic.problem.errors import InputError, Place, kind_of, near, require, row_number
from analytic.problem.files import as_path
from analytic.problem.support import (
    OfVibrissa,
    Support,
    check_provenance,
    recorded_contours,
    support_of,
    support_record,
)
from analytic.problem.sweep_table import SweepTable, usable

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True, eq=False, repr=False)
class Readings(OfVibrissa, SweepTable):
    """One sweep, in the units of its beam.

    Parameters
    ----------
    table : pandas.DataFrame
        A row a station in sweep order. ``foot_x`` [length], ``force_x``, ``force_y`` [force] and
        ``moment_z`` [force length] are the clamp's action on the vibrissa at the foot, in the world
        frame. ``phase``, the contact (``contact_angle`` [rad], ``contact_arc_length``,
        ``contact_x``, ``contact_y`` [length], on the body's surface), ``tip_angle`` [rad] and
        ``status`` may be missing from measured data; engines may add columns. NaN in a force or
        moment is a gap: the station is kept, and not trusted.
    beam : Beam
        The vibrissa that was swept.
    source : str
        Who produced the readings: ``"analytic"``, ``"mujoco chain"``, ...
    provenance : mapping
        Versions, settings, case; anything JSON can hold.

    Raises
    ------
    InputError
        If a sensed column is missing, a cell is no number, a ``foot_x`` is NaN, there are fewer
        than two stations, a phase or status is unknown, or the provenance has another form.

    See Also
    --------
    Readings.of : from a DataFrame or a mapping as a rig gives it.
    Readings.read : from a file.
    """

    table: "pd.DataFrame"
    beam: Beam = field(default_factory=Beam)
    source: str = "measured"
    provenance: Mapping[str, Any] = field(default_factory=dict)
    sensed: ClassVar[tuple[str, ...]] = SENSED
    panels: ClassVar[Mapping[str, tuple[str, ...]]] = {name: (name,) for name in CLAMP_READINGS}

    def __post_init__(self) -> None:
        from analytic.problem.table import checked_table  # slow to load, and solvers do without

        self._check_kinds()
        table = checked_table(self.table, self.source)
        if len(table) < 2 or table["foot_x"].isna().any():
            what = f"{len(table)}, {int(table['foot_x'].notna().sum())} with a finite foot_x"
            allowed = "two or more, each with a finite foot_x"
            remedy = "is it complete? `Readings.of` drops rows without a foot_x"
            raise InputError(f"stations of the readings ({self.source})", what, allowed, remedy)
        check_provenance(self.provenance)
        object.__setattr__(self, "table", table)

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> "pd.DataFrame | Mapping[str, Any]":
            made = self.__dict__
            make = made.get("_to_make", {}).get(name)
            if make is not None:
                made.setdefault(name, make())  # several threads that ask at once get the same one
                self._to_make.pop(name, None)
            if name not in made:
                known = (one for one in dir(self) if not one.startswith("_"))
                remedy = near(name, known, "its columns are in table")
                remedy = f"take table[{name!r}]" if name in SCHEMA else remedy
                raise AttributeError(f"{type(self).__name__} has no {name!r}; {remedy}")
            return object.__getattribute__(self, name)

    def __getstate__(self) -> dict[str, Any]:
        """What copies and pickles have: of readings with a table still to be made, that table."""
        make = self.__dict__.get("_to_make", {}).get("table")
        kept = [part.name for part in fields(self) if make is None or part.name != "table"]
        unmade = {} if make is None else {"_to_make": {"table": make}}
        return {**{name: getattr(self, name) for name in kept}, **unmade}

    @classmethod
    def of(
        cls,
        data: "pd.DataFrame | Mapping[str, ArrayLike]",
        beam: Beam | None = None,
        source: str = "measured",
        provenance: Mapping[str, Any] | None = None,
        place: Place = row_number,
    ) -> "Readings":
        """Readings from a table as a rig gives it; rows without a foot position are dropped.

        Parameters
        ----------
        data : pandas.DataFrame or mapping
            Columns by name, each of shape (stations,); see `Readings` for names and units.
        beam : Beam, optional
            The vibrissa; ``Beam()`` if not given.
        source : str
            Who produced the readings; how many rows were dropped is added to it.
        provenance : mapping, optional
            Anything JSON can hold; ``rows_without_foot_x`` counts the rows dropped.
        place : callable
            What an error calls a row, given its number from 0.

        Returns
        -------
        Readings
            Of the remaining rows, in their order.

        Raises
        ------
        InputError
            As `Readings`, but for a NaN in ``foot_x``.

        Examples
        --------
        >>> Readings.of({"foot_x": [1, 0.9], "force_x": [0, -0.1], "force_y": [0, 0.2],
        ...              "moment_z": [0, 0.3]}).gaps
        0
        """
        from analytic.problem.table import checked_table

        table = checked_table(_frame(data), source, place)
        lost = int(table["foot_x"].isna().sum())
        provenance = {} if provenance is None else provenance
        if lost and isinstance(provenance, Mapping):
            table = table[table["foot_x"].notna()].reset_index(drop=True)
            source = f"{source} ({lost} row{'s' if lost > 1 else ''} without foot_x dropped)"
            provenance = {**provenance, "rows_without_foot_x": lost}
        return cls(table, Beam() if beam is None else beam, source, provenance)

    @cached_property
    def snap_off(self) -> float | None:
        """Foot position of the snap-off [length], if the source located it (`provenance`)."""
        value = self.provenance.get("events", {}).get("snap_off")
        return None if value is None else float(value)

    @property
    def bends_left(self) -> bool:
        """Whether the vibrissa bends to the left, by the sum of the clamp's moments."""
        return float(np.nansum(self.values("moment_z"))) < 0

    @property
    def support(self) -> Support:
        return support_of(self.provenance)

    @property
    def clamp_angle(self) -> Floats:
        """By which the clamp leans at each station, shape (stations,) [rad]."""
        if "clamp_angle" in self.table:
            return self.values("clamp_angle")
        return np.full(len(self.table), self.support.clamp_angle)

    @property
    def foot_y(self) -> Floats:
        """Height of the foot at each station, shape (stations,) [length]."""
        return self.values("foot_y") if "foot_y" in self.table else np.zeros(len(self.table))

    @property
    def running(self) -> str:
        if "travel" in self.table:
            return "travel"
        return "clamp_angle" if "clamp_angle" in self.table else "foot_x"

    @property
    def runs_right(self) -> bool:
        """Whether the foot moves, or if it comes back the clamp turns, to the right."""
        x, angle = self.values("foot_x"), self.clamp_angle
        return bool((x[-1] - x[0] or angle[0] - angle[-1]) > 0)

    def require_sweep(self, who: str) -> None:
        """Refuse readings of a clamp that turns or leaves its line on its way."""
        if self.running != "foot_x":
            allowed = f"a foot along its line in a clamp that keeps its angle, for {who}"
            found = f"those of {self.source}, over {self.running}"
            raise InputError("readings", found, allowed, "use it with a sweep along x")

    def with_friction(self, coefficient: float) -> "Readings":
        """The same readings, taken to be of a vibrissa that rubs so much.

        Parameters
        ----------
        coefficient : float
            Of Coulomb's friction, for the sweep's sense of sliding.

        Returns
        -------
        Readings
            The provenance says it.
        """
        held = self.support._replace(friction=coefficient)
        known = {name: value for name, value in self.provenance.items() if name != "support"}
        return replace(self, provenance={**known, **support_record(held)})

    def mirrored(self) -> "Readings":
        """The readings in a mirror, x to -x.

        Returns
        -------
        Readings
            With what `provenance` says of events and contour mirrored too.
        """
        from analytic.problem.table import mirrored_table

        provenance = dict(self.provenance)
        if "events" in provenance:
            events = provenance["events"]
            way = 1 if self.running == "travel" else -1
            provenance["events"] = {n: None if x is None else way * x for n, x in events.items()}
        if "support" in provenance:
            provenance |= support_record(self.support.mirrored())
        turned = [[(-xi[::-1]).tolist(), eta[::-1].tolist()] for xi, eta in self.contours]
        provenance |= recorded_contours(turned)
        table, beam = mirrored_table(self.table), self.beam.mirrored()
        return replace(self, table=table, beam=beam, provenance=provenance)

    @property
    def contours(self) -> "list[Floats]":
        """The contours of the objects that the source recorded, each of shape (2, n) [length]."""
        first = [self.provenance["contour"]] if "contour" in self.provenance else []
        return [
            np.asarray(one, dtype=float) for one in (*first, *self.provenance.get("others", []))
        ]

    @staticmethod
    def read_table(path: str | Path) -> "pd.DataFrame":
        """The bare table in a Parquet or CSV file, whatever its columns.

        Parameters
        ----------
        path : str or Path
            Named ``*.parquet`` or ``*.csv``.

        Returns
        -------
        pandas.DataFrame
            Columns whose cells are not all numbers are texts.

        Raises
        ------
        InputError
            If the file is missing, damaged, too large or no regular file.
        """
        from analytic.problem.readings_file import read_file

        return read_file(as_path(path, "readings file")).table

    @classmethod
    def read(cls, path: str | Path, otherwise: Beam | None = None) -> "Readings":
        """Read what `write` wrote; a file without metadata is measured data.

        Parameters
        ----------
        path : str or Path
            Named ``*.parquet`` or ``*.csv``.
        otherwise : Beam, optional
            The vibrissa if the file names none; ``Beam()`` if not given.

        Returns
        -------
        Readings
            Rows without a ``foot_x`` are dropped and counted, as by `of`.

        Raises
        ------
        InputError
            If the file is missing, damaged, too large or not a sweep; the message has line and
            column of a cell that cannot be read.
        """
        from analytic.problem.readings_file import read_file

        path = as_path(path, "readings file")
        content = read_file(path)
        metadata = content.metadata
        if "tangent" in metadata:
            what, allowed = "of a sweep in space", "one sweep in the plane"
            remedy = "read it with `analytic.space.SpatialReadings` or `vibrissa reconstruct`"
            raise InputError(f"readings file {path}", what, allowed, remedy)
        with usable(path):
            beam = Beam(**metadata["beam"]) if "beam" in metadata else otherwise
            source = metadata.get("source", path.name)
            return cls.of(content.table, beam, source, metadata.get("provenance"), content.place)


def require_readings(readings: object) -> Readings:
    remedy = "as Readings(table, beam); sweeps in space have functions of their own, analytic.space"
    return require("readings", readings, Readings, remedy)


def solved_readings(
    columns: Mapping[str, Floats | Integers],
    beam: Beam,
    source: str,
    provenance: Callable[[], Mapping[str, Any]],
    snap_off: float | None,
    finite: bool,
) -> Readings:
    """Readings of a solver's own columns, not checked; the table is made when first asked for."""
    if not finite:  # beyond the largest number in the case's units: an error says so
        return Readings(_table(columns), beam, source, provenance())
    found = object.__new__(Readings)
    to_make = {"table": partial(_table, columns), "provenance": provenance}
    parts = {"beam": beam, "source": source, "snap_off": snap_off, "_to_make": to_make}
    found.__dict__.update(parts)
    return found


def are_finite(columns: Mapping[str, Floats | Integers]) -> bool:
    return not any(np.isinf(values).any() for values in columns.values())


def _table(columns: Mapping[str, Floats | Integers]) -> "pd.DataFrame":
    from analytic.problem.table import as_table

    return as_table(columns)


def _frame(data: "pd.DataFrame | Mapping[str, ArrayLike]") -> "pd.DataFrame":
    import pandas as pd

    if isinstance(data, pd.DataFrame):
        return data
    allowed, remedy = "a DataFrame, or columns of one length by name", "as {'foot_x': [...], ...}"
    if not isinstance(data, Mapping):
        raise InputError("readings", kind_of(data), allowed, remedy)
    try:
        return pd.DataFrame(dict(data))
    except (ValueError, TypeError) as error:
        raise InputError("readings", "no table", allowed, f"{remedy} ({error})") from error
