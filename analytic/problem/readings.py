"""One sweep's readings: the table that every engine, rig and comparison speaks."""

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from analytic.problem.arrays import Booleans, Floats
from analytic.problem.beam import Beam
from analytic.problem.columns import CONTACT, PHASES, SENSED, STATUSES
from analytic.problem.errors import InputError
from analytic.problem.files import whole_file

_ODD = ("foot_x", "force_x", "moment_z", "contact_angle", "contact_x")  # change sign in a mirror
_METADATA_KEY = b"vibrissa"
_CSV_PREFIX = "# vibrissa "


@dataclass(frozen=True)
class Readings:
    """One sweep, in the units of its beam.

    Parameters
    ----------
    table : pandas.DataFrame
        A row a station in sweep order. ``foot_x`` [length], ``force_x``, ``force_y`` [force] and
        ``moment_z`` [force length] are the clamp's action on the vibrissa at the foot, in the world
        frame. ``phase``, the contact (``contact_angle`` [rad], ``contact_arc_length``,
        ``contact_x``, ``contact_y`` [length], on the body's surface), ``tip_angle`` [rad] and
        ``status`` may be missing from measured data; engines may add columns.
    beam : Beam
        The vibrissa that was swept.
    source : str
        Who produced the readings: ``"analytic"``, ``"mujoco chain"``, ...
    provenance : mapping
        Versions, settings, case; anything JSON can hold.

    Raises
    ------
    InputError
        If a sensed column is missing or not numeric, there are fewer than two stations, or a phase
        or status is unknown.
    """

    table: pd.DataFrame
    beam: Beam = field(default_factory=Beam)
    source: str = "measured"
    provenance: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        table = self.table
        missing = [name for name in SENSED if name not in table]
        if missing:
            raise InputError(
                f"columns of the readings ({self.source})",
                ", ".join(map(str, table.columns)) or "none",
                f"at least {', '.join(SENSED)}",
                f"add {', '.join(missing)}",
            )
        for name in (*SENSED, *CONTACT):
            if name in table and not pd.api.types.is_numeric_dtype(table[name]):
                raise InputError(
                    f"column {name}", f"of type {table[name].dtype}", "numbers", "mend the column"
                )
        if len(table) < 2 or not np.isfinite(table["foot_x"]).all():
            raise InputError(
                f"stations of the readings ({self.source})",
                f"{len(table)}, {int(np.isfinite(table['foot_x']).sum())} with a finite foot_x",
                "two or more, each with a finite foot_x",
                "is the file complete?",
            )
        for name, allowed in (("phase", PHASES), ("status", STATUSES)):
            unknown = set(table[name]) - set(allowed) if name in table else set()
            if unknown:
                raise InputError(
                    f"column {name}",
                    ", ".join(sorted(map(str, unknown))),
                    f"one of {', '.join(allowed)}",
                    "mend the column",
                )

    @property
    def snap_off(self) -> float | None:
        """Foot position of the snap-off [length], if the source located it (`provenance`)."""
        value = self.provenance.get("events", {}).get("snap_off")
        return None if value is None else float(value)

    def values(self, column: str) -> Floats:
        """A numeric column, shape (stations,); NaN throughout if it was not measured."""
        if column not in self.table:
            return np.full(len(self.table), np.nan)
        return self.table[column].to_numpy(dtype=float)

    @property
    def trusted(self) -> Booleans:
        """Stations whose four sensed values may be used, shape (stations,).

        That is: no status speaks against them, and all four are finite.
        """
        finite = np.isfinite(self.table[list(SENSED)].to_numpy(dtype=float)).all(axis=1)
        if "status" in self.table:
            finite &= (self.table["status"] == "ok").to_numpy()
        return np.asarray(finite, dtype=bool)

    @property
    def bends_left(self) -> bool:
        """Whether the vibrissa bends to the left, as when its foot moves to the right.

        The clamp's moment tells: it is negative then. The sum over the sweep decides, lest the
        noise of a hardly loaded station does.
        """
        return float(np.nansum(self.values("moment_z"))) < 0

    def mirrored(self) -> "Readings":
        """The readings in a mirror, x to -x, with what `provenance` knows of events and contour."""
        provenance = dict(self.provenance)
        if "events" in provenance:
            events = provenance["events"]
            provenance["events"] = {n: None if x is None else -x for n, x in events.items()}
        if "contour" in provenance:
            xi, eta = provenance["contour"]
            provenance["contour"] = [[-x for x in reversed(xi)], list(reversed(eta))]
        return replace(self, table=mirrored_table(self.table), provenance=provenance)

    def write(self, path: str | Path) -> Path:
        """Write to Parquet (metadata inside) or CSV (metadata in the first line), by the suffix.

        The file appears whole or not at all.
        """
        path = Path(path)
        metadata = json.dumps(
            {"beam": asdict(self.beam), "source": self.source, "provenance": dict(self.provenance)}
        )
        with whole_file(path) as unfinished:
            if _is_csv(path):
                with unfinished.open("w", encoding="utf-8") as file:
                    file.write(_CSV_PREFIX + metadata + "\n")
                    self.table.to_csv(file, index=False)
            else:
                columns = pa.Table.from_pandas(self.table, preserve_index=False)
                kept = columns.schema.metadata or {}
                columns = columns.replace_schema_metadata({**kept, _METADATA_KEY: metadata})
                pq.write_table(columns, unfinished)
        return path

    @staticmethod
    def read_table(path: str | Path) -> pd.DataFrame:
        """The bare table in a Parquet or CSV file, whatever its columns.

        Raises
        ------
        InputError
            If the file is missing or truncated.
        """
        return _read(Path(path))[1]

    @classmethod
    def read(cls, path: str | Path, otherwise: Beam = Beam()) -> "Readings":  # noqa: B008
        """Read what `write` wrote; a file without metadata is measured data.

        Parameters
        ----------
        path : str or Path
            Parquet or CSV.
        otherwise : Beam
            The vibrissa, if the file does not tell.

        Raises
        ------
        InputError
            If the file is missing, truncated or not a sweep.
        """
        path = Path(path)
        metadata, table = _read(path)
        try:
            beam = Beam(**metadata["beam"]) if "beam" in metadata else otherwise
            return cls(
                table,
                beam,
                metadata.get("source", f"measured, {path.name}"),
                metadata.get("provenance", {}),
            )
        except (InputError, TypeError, AttributeError) as error:
            raise InputError(
                f"readings file {path}", "unusable", "one sweep", str(error)
            ) from error


def mirrored_table(table: pd.DataFrame) -> pd.DataFrame:
    """A table with columns of readings, x to -x; angles are measured from the x-axis as before."""
    changed = {name: 0.0 - table[name] for name in _ODD if name in table}  # lest a 0 become -0
    if "tip_angle" in table:
        changed["tip_angle"] = np.pi - table["tip_angle"]
    return table.assign(**changed)


def _read(path: Path) -> tuple[dict[str, Any], pd.DataFrame]:
    """Metadata and table of a file."""
    try:
        return _read_csv(path) if _is_csv(path) else _read_parquet(path)
    except InputError:
        raise
    except (OSError, ValueError, TypeError, KeyError, pa.ArrowException) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise InputError(
            f"readings file {path}",
            f"unreadable ({reason})",
            "a whole Parquet or CSV file",
            "write it anew or name another file",
        ) from error


def _is_csv(path: Path) -> bool:
    if path.suffix not in (".csv", ".parquet"):
        raise InputError("readings file", path, "named *.parquet or *.csv", "rename it")
    return path.suffix == ".csv"


def _read_parquet(path: Path) -> tuple[dict[str, Any], pd.DataFrame]:
    columns = pq.read_table(path)
    metadata = (columns.schema.metadata or {}).get(_METADATA_KEY, b"{}")
    return json.loads(metadata), columns.to_pandas()


def _read_csv(path: Path) -> tuple[dict[str, Any], pd.DataFrame]:
    with path.open(encoding="utf-8") as file:
        first = file.readline()
        has_metadata = first.startswith(_CSV_PREFIX)
        metadata = json.loads(first.removeprefix(_CSV_PREFIX)) if has_metadata else {}
        if not has_metadata:
            file.seek(0)
        return metadata, pd.read_csv(file, comment="#")
