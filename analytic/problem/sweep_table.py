"""What readings of a sweep have in common, in the plane and in space: a table, and its file."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.beam import Beam, Varying
from analytic.problem.columns import IN_SPACE, SCHEMA
from analytic.problem.errors import InputError, require, unknown
from analytic.problem.files import as_path
from analytic.problem.shown import Shown, stacked, with_unit

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_ROWS = 8  # of the table that a notebook shows


@contextmanager
def usable(path: Path) -> Iterator[None]:
    """What a file says that holds no sweep."""
    try:
        yield
    except (InputError, TypeError) as error:
        raise InputError(f"readings file {path}", "unusable", "one sweep", str(error)) from error


class _Table:
    """Whoever asks for the table gets one of their own, whose columns are copied as they write.

    Else a fault planted in ``df = exact.table`` was in `exact`, too, which then agreed with it.
    """

    def __get__(self, readings: "SweepTable | None", kind: type) -> "pd.DataFrame":
        if readings is None or "table" not in readings.__dict__:
            raise AttributeError("table")
        table: pd.DataFrame = readings.__dict__["table"]
        return table.copy(deep=False)

    def __set__(self, readings: "SweepTable", table: "pd.DataFrame") -> None:
        readings.__dict__["table"] = table


class SweepTable(Shown):
    """A row a station, in the units of a beam."""

    if TYPE_CHECKING:
        table: pd.DataFrame
    else:
        table = _Table()
    beam: Beam
    source: str
    provenance: Mapping[str, Any]
    sensed: ClassVar[tuple[str, ...]]  # what the clamp knows
    panels: ClassVar[Mapping[str, tuple[str, ...]]]  # columns that are drawn, by label

    def _check_kinds(self) -> None:
        import pandas as pd  # slow to load, and solvers do without

        given = self.__dict__["table"]  # whatever it is
        for name, value, kind, remedy in (
            ("table", given, pd.DataFrame, "columns by name; `of` takes mappings too"),
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

        Raises
        ------
        InputError
            If readings have no such column, whatever is measured.
        """
        table = self.table
        for name in columns:
            if name not in table and (name not in SCHEMA or name in IN_SPACE):
                raise unknown("column of readings", name, [*table])
        missing = np.full(len(table), np.nan)
        found = [
            table[name].to_numpy(dtype=float) if name in table else missing for name in columns
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
        axes = self._new_axes() if axes is None else axes
        along, trusted = self.running_values, self.trusted
        label = self.source.replace("$", r"\$")
        for ax, names in zip(axes, self.panels.values(), strict=True):
            for name in names:
                values = self.values(name)
                said = label if len(names) == 1 else f"{label}: {name}"
                ax.plot(along, values, ".-", markersize=3, linewidth=0.8, label=said)
                if not trusted.all():
                    there = along[~trusted], values[~trusted]
                    ax.plot(*there, "x", color="tab:red", label="not trusted")
        for ax in axes if len(self.panels) < len(self.sensed) - 1 else axes[:1]:
            ax.legend(fontsize="small")
        return list(axes)

    def _new_axes(self, figure: "Figure | None" = None) -> "list[Axes]":
        labels = (with_unit(label, self.beam) for label in self.panels)
        return stacked(labels, with_unit(self.running, self.beam), figure)

    def _draw(self, figure: "Figure") -> None:
        self.plot(self._new_axes(figure))

    def _tiles(self) -> Mapping[str, object]:
        return {"source": self.source, "stations": len(self.table), **self._counts()}

    def _counts(self) -> dict[str, str]:
        return {
            name: ", ".join(
                f"{word} {n}" for word, n in self.table[name].value_counts(sort=False).items()
            )
            for name in ("phase", "status")
            if name in self.table
        }

    def _below(self) -> str:
        rows = self.table.to_html(max_rows=_ROWS, float_format="{:.6g}".format, border=0)
        return f"<pre>{escape(repr(self))}</pre>{rows}"

    def __repr__(self) -> str:
        beam, running = self.beam, self.running_values
        beyond = "".join(f", {name} {value:g}" for name, value in self.beyond_the_paper.items())
        loads = [name for name in self.sensed if not name.startswith("foot")]
        sizes = (f"{name} {np.abs(self.table[name]).max():.4g}" for name in loads)
        lines = [
            f"{type(self).__name__} ({self.source}): {len(running)} stations, "
            f"{self.running} from {running[0]:.6g} to {running[-1]:.6g}",
            f"  beam{' (SI)' if beam.si else ''}: length {beam.length:g}, "
            f"flexural rigidity {beam.flexural_rigidity:g}, radius {beam.radius:g}{beyond}",
            f"  largest magnitudes: {', '.join(sizes)}",
        ]
        lines += [f"  {name}: {said}" for name, said in self._counts().items()]
        if self.gaps:
            lines.append(f"  gaps: {self.gaps} stations without a force or the moment")
        return "\n".join(lines)

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
