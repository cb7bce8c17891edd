"""What readings of a sweep have in common, in the plane and in space: a table, and its file."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.beam import Beam
from analytic.problem.errors import InputError, require
from analytic.problem.files import as_path

if TYPE_CHECKING:
    import pandas as pd


@contextmanager
def usable(path: Path) -> Iterator[None]:
    """What a file says that holds no sweep."""
    try:
        yield
    except (InputError, TypeError) as error:
        raise InputError(f"readings file {path}", "unusable", "one sweep", str(error)) from error


class SweepTable:
    """A row a station, in the units of a beam."""

    table: "pd.DataFrame"
    beam: Beam
    source: str
    provenance: Mapping[str, Any]
    sensed: ClassVar[tuple[str, ...]]  # what the clamp knows

    def _check_kinds(self) -> None:
        import pandas as pd  # slow to load, and solvers do without

        for name, value, kind, remedy in (
            ("table", self.table, pd.DataFrame, "columns by name; `of` takes mappings too"),
            ("beam", self.beam, Beam, "as Beam(length=..., flexural_rigidity=...)"),
            ("source", self.source, str, "it says who produced them"),
            ("provenance", self.provenance, Mapping, "as {'engine': '...'}"),
        ):
            require(f"readings' {name}", value, kind, remedy)

    def values(self, *columns: str) -> Floats:
        """Numeric columns side by side.

        Parameters
        ----------
        *columns : str
            Their names.

        Returns
        -------
        array, shape (stations, columns)
            In the columns' units; NaN throughout where one was not measured. Of a single one its
            shape is (stations,).
        """
        missing = np.full(len(self.table), np.nan)
        found = [
            self.table[name].to_numpy(dtype=float) if name in self.table else missing
            for name in columns
        ]
        return found[0] if len(found) == 1 else np.column_stack(found)

    @property
    def trusted(self) -> Booleans:
        """Stations whose sensed values may be used, shape (stations,).

        That is: no status speaks against them, and none of the values is a gap.
        """
        from analytic.problem.table import says

        fine = np.isfinite(self.values(*self.sensed)).all(axis=1)
        if "status" in self.table:
            fine &= says(self.table["status"], "ok")
        return np.asarray(fine, dtype=bool)

    def write(self, path: str | Path) -> Path:
        """Write to Parquet (metadata inside) or CSV (metadata in the first line), by the suffix.

        The file appears whole or not at all.

        Parameters
        ----------
        path : str or Path
            Named ``*.parquet`` or ``*.csv``.

        Returns
        -------
        Path
            `path`.

        Raises
        ------
        InputError
            If the name has another suffix, or JSON cannot hold the provenance.
        OSError
            If the file cannot be written.
        """
        from analytic.problem.readings_file import write_file

        path = as_path(path, "readings file")
        write_file(path, self.table, self._metadata())
        return path

    def _metadata(self) -> dict[str, Any]:
        provenance = dict(self.provenance)
        return {"beam": asdict(self.beam), "source": self.source, "provenance": provenance}
