"""What readings of a sweep have in common, in the plane and in space: a table, and its file."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.beam import Beam, Varying
from analytic.problem.columns import SCHEMA
from analytic.problem.errors import InputError, require
from analytic.problem.files import as_path
from analytic.problem.readings_shown import as_html, as_text, counts, draw, new_axes
from analytic.problem.shown import Shown

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@contextmanager
def usable(path: Path) -> Iterator[None]:
    """What a file says that holds no sweep."""
    try:
        yield
    except (InputError, TypeError) as error:
        raise InputError(f"readings file {path}", "unusable", "one sweep", str(error)) from error


class SweepTable(Shown):
    """A row a station, in the units of a beam."""

    table: "pd.DataFrame"
    beam: Beam
    source: str
    provenance: Mapping[str, Any]
    sensed: ClassVar[tuple[str, ...]]  # what the clamp knows
    panels: ClassVar[Mapping[str, tuple[str, ...]]]  # columns that are drawn, by label

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
        """Stations of status ok whose sensed values are no gaps, shape (stations,)."""
        from analytic.problem.table import says

        fine = np.isfinite(self.values(*self.sensed)).all(axis=1)
        if "status" in self.table:
            fine &= says(self.table["status"], "ok")
        return np.asarray(fine, dtype=bool)

    @property
    def gaps(self) -> int:
        """Number of stations at which a force or the moment is missing (NaN)."""
        return int(self.table[list(self.sensed)].isna().any(axis=1).sum())

    @property
    def running(self) -> str:
        """The column over which the sweep runs."""
        raise NotImplementedError

    @property
    def running_values(self) -> Floats:
        """Where along the sweep its stations are, shape (stations,)."""
        return self.values(self.running)

    @property
    def running_unit(self) -> tuple[float, str]:
        """How much of it a place along the sweep is said in, and what that is called: L or rad."""
        if SCHEMA[self.running].dimension == "angle":
            return 1.0, "rad"
        return self.beam.length, "L"

    @property
    def beyond_the_paper(self) -> Mapping[str, Varying]:
        """What of vibrissa, clamp and contact is not the paper's, by what it is."""
        return {}

    def plot(self, axes: "Sequence[Axes] | None" = None) -> "list[Axes]":
        """Draw force and moment at the clamp along the sweep.

        Parameters
        ----------
        axes : sequence of matplotlib.axes.Axes, optional
            What ``plot`` of other readings returned, to draw these into.

        Returns
        -------
        list of matplotlib.axes.Axes
            One a reading, ``force_x``, ``force_y``, ``moment_z``; in space ``force`` and
            ``moment``, each with three components.
        """
        axes = new_axes(self) if axes is None else axes
        draw(self, axes)
        return list(axes)

    def _draw(self, figure: "Figure") -> None:
        self.plot(new_axes(self, figure))

    def _tiles(self) -> Mapping[str, object]:
        return {"source": self.source, "stations": len(self.table), **counts(self)}

    def _below(self) -> str:
        return as_html(self)

    def __repr__(self) -> str:
        return as_text(self)

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
