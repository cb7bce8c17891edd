"""One sweep in a file: Parquet with its metadata inside, or CSV with it in the first line."""

import json
import warnings
from collections.abc import Mapping
from itertools import islice
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from analytic.problem.columns import COLUMNS
from analytic.problem.errors import InputError, Place
from analytic.problem.files import regular_file, whole_file

_LARGEST = 512_000_000  # bytes; a CSV of 10^6 stations with all columns has 220 MB
_MOST_CELLS = 100_000_000  # a small Parquet file may hold the same value that often
_METADATA_KEY = b"vibrissa"
_CSV_PREFIX = "# vibrissa "
_NO_TABLE = (ValueError, TypeError, LookupError, NotImplementedError, pd.errors.ParserWarning)
_DAMAGED = (*_NO_TABLE, OSError, RecursionError, MemoryError, pa.ArrowException)


class FileContent(NamedTuple):
    # beam, source and provenance as `write_file` wrote them; empty if there are none.
    metadata: dict[str, Any]
    table: pd.DataFrame
    place: Place  # where a row of the table stands in the file


def write_file(path: Path, table: pd.DataFrame, metadata: Mapping[str, Any]) -> None:
    """Write to Parquet or CSV, by the suffix; the file appears whole or not at all."""
    try:
        text = json.dumps(metadata)
    except (TypeError, ValueError, RecursionError) as error:
        remedy = f"numbers, texts, lists, tables ({error})"
        raise InputError("provenance", "given", "what JSON can hold", remedy) from error
    is_csv = _is_csv(path)
    with whole_file(path) as unfinished:
        if is_csv:
            with unfinished.open("w", encoding="utf-8") as file:
                file.write(_CSV_PREFIX + text + "\n")
                table.to_csv(file, index=False)
        else:
            columns = pa.Table.from_pandas(table, preserve_index=False)
            kept = columns.schema.metadata or {}
            columns = columns.replace_schema_metadata({**kept, _METADATA_KEY: text})
            pq.write_table(columns, unfinished)


def read_file(path: Path) -> FileContent:
    """Metadata and bare table of a file, whatever its columns."""
    is_csv = _is_csv(path)
    regular_file(path, "readings file", _LARGEST)
    try:
        metadata, table = _read_csv(path) if is_csv else _read_parquet(path)
    except InputError:
        raise
    except _DAMAGED as error:
        reason = " ".join(str(error).split())[:200] or type(error).__name__
        what, allowed = f"unreadable ({reason})", "a whole Parquet or CSV file"
        raise InputError(f"readings file {path}", what, allowed, "write it again") from error
    if not isinstance(metadata, dict):
        raise InputError(f"metadata of {path}", "no table", "what `write` wrote", "write it again")

    def place(row: int) -> str:
        return f"line {_line_of(path, row)} of {path}" if is_csv else f"row {row} of {path}"

    return FileContent(metadata, table, place)


def is_ours(path: Path) -> bool:
    """Whether `write_file` wrote a file, by the metadata in it."""
    try:
        regular_file(path, "readings file", _LARGEST)
        if path.suffix == ".parquet":
            return _METADATA_KEY in (pq.read_schema(path).metadata or {})
        with path.open("rb") as file:
            return file.read(len(_CSV_PREFIX)) == _CSV_PREFIX.encode()
    except (OSError, ValueError, pa.ArrowException):
        return True


def _is_csv(path: Path) -> bool:
    if path.suffix not in (".csv", ".parquet"):
        raise InputError("readings file", path, "named *.parquet or *.csv", "rename it")
    return path.suffix == ".csv"


def _read_parquet(path: Path) -> tuple[Any, pd.DataFrame]:
    with pq.ParquetFile(path, pre_buffer=False) as file:
        cells = file.metadata.num_rows * file.metadata.num_columns
        if cells > _MOST_CELLS:
            allowed = f"at most {_MOST_CELLS:.0e}"
            raise InputError(f"readings file {path}", f"{cells} cells", allowed, "split it")
        # Not in Arrow's threads: one that still ends while Python does aborts the whole process.
        columns = file.read(use_threads=False)
    metadata = (columns.schema.metadata or {}).get(_METADATA_KEY, b"{}")
    return json.loads(metadata), columns.to_pandas(ignore_metadata=True, use_threads=False)


def _read_csv(path: Path) -> tuple[Any, pd.DataFrame]:
    with path.open(encoding="utf-8-sig") as file:
        first = file.readline()
        ours = first.startswith(_CSV_PREFIX)
        metadata = json.loads(first.removeprefix(_CSV_PREFIX)) if ours else {}
        if not ours:
            file.seek(0)
        with warnings.catch_warnings():
            # A row with more cells than the header would shift or lose values.
            warnings.simplefilter("error", pd.errors.ParserWarning)
            table = pd.read_csv(
                file, comment="#", index_col=False, skipinitialspace=True, low_memory=False
            )
    twice = [name for name in COLUMNS if f"{name}.1" in table]
    if twice:  # pandas numbers columns of one name
        raise InputError(f"column {twice[0]} of {path}", "there twice", "one column", "drop one")
    return metadata, table


def _line_of(path: Path, row: int) -> int:
    """Line, from 1, of a row, from 0; blank lines and comments do not count as rows."""
    with path.open(encoding="utf-8-sig") as file:
        filled = (number for number, line in enumerate(file, 1) if line.partition("#")[0].strip())
        return next(islice(filled, row + 1, None), 0)
