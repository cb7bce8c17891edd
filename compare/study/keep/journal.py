"""Rows on their way to a part: safe from the moment they are written, whatever kills the process.

A Parquet file is complete only when it is closed, so a row would wait in memory for its part to
fill up. In the meantime it stands in a text file, a line a row with a checksum, which a dead
process leaves behind for the next one.
"""

import json
import os
import time
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pyarrow as pa

from compare.study.keep.locks import claim
from compare.study.keep.parts import Damaged, new_name, write_part

_SYNC = 1.0  # s; a loss of power costs the rows of so long, a dead process none


class Journal:
    """A journal of this process; made, and turned into a part, under `locks.lock`.

    It is locked as long as its process lives.
    """

    def __init__(self, folder: Path, columns: Mapping[str, str]) -> None:
        self.path = folder / f".journal-{new_name()}.jsonl"
        self.rows = 0
        self._columns = columns
        self._file = self.path.open("ab", buffering=0)
        self._synced = time.monotonic()
        claim(self._file)

    def add(self, row: Mapping[str, Any]) -> None:
        """Append a row; when this returns, killing the process cannot lose it."""
        line = json.dumps(row).encode()
        line = b"%08x %b\n" % (zlib.crc32(line), line)
        if self._file.write(line) != len(line):
            raise OSError(28, os.strerror(28), str(self.path))
        self.rows += 1
        if time.monotonic() > self._synced + _SYNC:
            os.fsync(self._file.fileno())
            self._synced = time.monotonic()

    def close(self, damaged: Damaged) -> None:
        """Turn it into a part."""
        _make_part(self.path, self._columns, damaged)
        self._file.close()


def list_journals(folder: Path) -> list[Path]:
    """Find the journals in a folder, those of living processes too."""
    return sorted(folder.glob(".journal-*.jsonl"))


def read_journal(path: Path, columns: Mapping[str, str]) -> tuple[pa.Table, int]:
    """Read the complete lines of a journal.

    What follows the last of them was being written, or cut off by a full disk, and is no damage.
    """
    lines = path.read_bytes().split(b"\n")[:-1]
    rows = [row for line in lines if (row := _row(line)) is not None]
    names = list(dict.fromkeys(name for row in rows for name in row))
    names = [*(name for name in columns if name in names), *(n for n in names if n not in columns)]
    arrays = [pa.array([row.get(name) for row in rows], columns.get(name)) for name in names]
    if not arrays:
        arrays, names = [pa.array([], "string")] * 2, ["run", "outcome"]
    return pa.Table.from_arrays(arrays, names), len(lines) - len(rows)


def adopt_journals(folder: Path, columns: Mapping[str, str], damaged: Damaged) -> None:
    """Turn what dead processes left into parts."""
    for path in list_journals(folder):
        with path.open("rb") as file:
            if claim(file):  # else its process lives
                _make_part(path, columns, damaged)


def _make_part(path: Path, columns: Mapping[str, str], damaged: Damaged) -> None:
    """Turn the journal at `path` into a part; it goes when the part is there."""
    table, lost = read_journal(path, columns)
    if table.num_rows:
        write_part(path.parent, table.schema, [table])
    if lost:
        damaged(path, f"{lost} of {table.num_rows + lost} lines")
    else:
        path.unlink()


def _row(line: bytes) -> dict[str, Any] | None:
    """The row on a line, None if not every bit of it is as it was written."""
    checksum, _, text = line.partition(b" ")
    if checksum != b"%08x" % zlib.crc32(text):
        return None
    row: dict[str, Any] = json.loads(text)
    return row
