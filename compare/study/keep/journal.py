"""Rows on their way to a part: safe from the moment they are written, whatever kills the process.

A Parquet file is complete only when it is closed, so a row would wait in memory for its part to
fill up. In the meantime it stands in a text file, a line a row, which a dead process leaves behind
for the next one.
"""

import fcntl
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pyarrow as pa

from compare.study.keep.parts import new_name, write_part


@contextmanager
def lock(folder: Path) -> Iterator[None]:
    """Keep other processes from changing the set of files in `folder`."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


class Journal:
    """A journal of this process; made, and turned into a part, under `lock`.

    Its first line says what the columns are, since the next process may have others. It is locked
    as long as its process lives.
    """

    def __init__(self, folder: Path, columns: dict[str, str]) -> None:
        self.path = folder / f".journal-{new_name()}.jsonl"
        self.rows = 0
        self._file = self.path.open("ab", buffering=0)
        fcntl.flock(self._file, fcntl.LOCK_EX)
        self._append(columns)

    def add(self, row: dict[str, Any]) -> None:
        """Append a row; when this returns, killing the process cannot lose it."""
        self._append(row)
        self.rows += 1

    def close(self) -> None:
        """Turn it into a part."""
        make_part(self.path)
        self._file.close()

    def _append(self, content: dict[str, Any]) -> None:
        line = json.dumps(content).encode() + b"\n"
        if self._file.write(line) != len(line):
            raise OSError(28, os.strerror(28), str(self.path))


def read_journals(folder: Path) -> Iterator[pa.Table]:
    """The rows of all journals, those of living processes too."""
    for path in sorted(folder.glob(".journal-*.jsonl")):
        yield _table(path)


def adopt_journals(folder: Path) -> None:
    """Turn what dead processes left into parts."""
    for path in sorted(folder.glob(".journal-*.jsonl")):
        with path.open("rb") as file:
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                continue  # its process lives
            make_part(path)


def make_part(path: Path) -> None:
    """Turn the journal at `path` into a part; it goes when the part is there."""
    table = _table(path)
    if table.num_rows:
        write_part(path.parent, table.schema, [table])
    path.unlink()


def _table(path: Path) -> pa.Table:
    """The complete lines of a journal: the last one may have been cut off by a full disk."""
    lines = path.read_bytes().split(b"\n")[:-1]
    columns = json.loads(lines[0]) if lines else {"run": "string", "outcome": "string"}
    schema = pa.schema([(name, pa.type_for_alias(kind)) for name, kind in columns.items()])
    return pa.Table.from_pylist([json.loads(line) for line in lines[1:]], schema)
