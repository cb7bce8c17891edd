"""The rows of a study in one SQLite file: safe from the moment they are written.

SQLite makes each row appear whole or not at all, whatever kills the process, for several processes
at once. What it does not see is a flipped bit within a row: each carries a checksum of its own.
"""

import json
import os
import sqlite3
import zlib
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias

Row: TypeAlias = Mapping[str, Any]
Warn: TypeAlias = Callable[[str], None]
"""Takes a line for the user."""

NAME = "runs.sqlite"
_PATIENCE = 300.0  # s to wait for another process; taking over a damaged file takes a tenth
_COMPANIONS = ("-shm", "-wal", "")  # SQLite's files; the first two only while it is in use
_DAMAGE = {sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB, sqlite3.SQLITE_ERROR}
_LAYOUT = "CREATE TABLE IF NOT EXISTS runs (run PRIMARY KEY, done, content, checksum)"


class Database:
    def __init__(self, folder: Path, warn: Warn, is_first: bool = False) -> None:
        """`is_first`: no study was here yet, so that a file may be one that is just being made."""
        self.path = folder / NAME
        damaged = self.path.exists() and not _is_sound(self.path, is_first)
        aside = _set_aside(self.path, warn) if damaged else None
        self._connection = _connect(self.path)
        self._connection.execute("PRAGMA journal_mode = WAL")
        # Killing the process loses nothing; a loss of power, the rows of the last seconds.
        self._connection.execute("PRAGMA synchronous = NORMAL")
        self._connection.execute(_LAYOUT)
        if aside is not None:
            self._take_over(aside)
        self._forget_damaged_rows(warn)

    def close(self) -> None:
        """Leave one file behind, unless another process still uses it."""
        with suppress(sqlite3.OperationalError):
            self._connection.execute("PRAGMA journal_mode = DELETE")
        self._connection.close()

    def add(self, row: Row) -> None:
        """Store a row; when this returns, killing the process cannot lose it.

        Of several rows of a run the latest done stays, else the latest of all.
        """
        content = json.dumps(row)
        run, done = row["run"], int(row["outcome"] == "done")
        self._connection.execute(
            "INSERT OR REPLACE INTO runs SELECT ?, ?, ?, ? "
            "WHERE ? OR NOT EXISTS (SELECT 1 FROM runs WHERE run = ? AND done)",
            (run, done, content, _checksum(run, done, content), done, run),
        )

    def rows(self) -> Iterator[Row]:
        return (row for _, row in _rows(self._connection) if row is not None)

    @contextmanager
    def as_it_is(self) -> Iterator[Callable[[], Iterator[Row]]]:
        """Read the rows several times, always those that are there now."""
        with _transaction(self._connection, "BEGIN"):
            yield self.rows

    def done(self) -> set[str]:
        return {run for (run,) in self._connection.execute("SELECT run FROM runs WHERE done")}

    def _take_over(self, aside: Path) -> None:
        """Keep what can be read of a damaged file, from either end."""
        for order in ("ASC", "DESC"):
            with (
                closing(_connect(aside)) as old,
                suppress(sqlite3.DatabaseError),
                _transaction(self._connection),
            ):
                for _, row in _rows(old, order):
                    if row is not None:
                        self.add(row)

    def _forget_damaged_rows(self, warn: Warn) -> None:
        lost = [number for number, row in _rows(self._connection) if row is None]
        if lost:
            warn(f"{self.path} is damaged in {len(lost)} rows: their runs are done again")
            with _transaction(self._connection):
                for number in lost:
                    self._connection.execute("DELETE FROM runs WHERE rowid = ?", (number,))


def read(folder: Path, warn: Warn) -> Iterator[Row]:
    """Read the rows in a folder, also while a study writes them."""
    path = folder / NAME
    lost = 0
    # What a killed process left half done SQLite takes back as it opens the file, if it may.
    mode = "mode=rw" if os.access(path, os.W_OK) and os.access(folder, os.W_OK) else "immutable=1"
    try:
        with closing(_connect(path, mode)) as connection:
            for _, row in _rows(connection):
                if row is None:
                    lost += 1
                else:
                    yield row
    except sqlite3.DatabaseError as error:
        warn(f"{path} is damaged ({error}): `vibrissa study` does runs again that are lost")
    if lost:
        warn(f"{path} is damaged in {lost} rows: `vibrissa study` does their runs again")


def _connect(path: Path, mode: str = "mode=rwc") -> sqlite3.Connection:
    uri = f"{path.absolute().as_uri()}?{mode}"
    connection = sqlite3.connect(uri, timeout=_PATIENCE, isolation_level=None, uri=True)
    connection.text_factory = partial(str, encoding="utf-8", errors="replace")
    return connection


@contextmanager
def _transaction(connection: sqlite3.Connection, begin: str = "BEGIN IMMEDIATE") -> Iterator[None]:
    connection.execute(begin)
    try:
        yield
    finally:
        connection.execute("COMMIT")


def _is_sound(path: Path, may_be_empty: bool) -> bool:
    try:
        with closing(_connect(path)) as connection:
            (found,) = connection.execute("PRAGMA integrity_check(1)").fetchone()
            layout = connection.execute("SELECT sql FROM sqlite_master WHERE name = 'runs'")
            made = [sql for (sql,) in layout]
    except sqlite3.DatabaseError as error:
        if error.sqlite_errorcode not in _DAMAGE:  # it cannot be opened or is in use
            raise
        return False
    expected = [_LAYOUT.replace("IF NOT EXISTS ", "")]
    return found == "ok" and (made == expected or (may_be_empty and not made))


def _set_aside(path: Path, warn: Warn) -> Path:
    aside = path.with_name(f".damaged-{path.name}")
    for companion in _COMPANIONS:
        with suppress(FileNotFoundError):
            Path(f"{path}{companion}").replace(f"{aside}{companion}")
    warn(f"{path} is damaged and set aside: runs that are lost are done again")
    return aside


def _rows(connection: sqlite3.Connection, order: str = "ASC") -> Iterator[tuple[int, Row | None]]:
    """Number and content of each row; None if not every bit is as it was written."""
    found = connection.execute(
        f"SELECT rowid, run, done, content, checksum FROM runs ORDER BY rowid {order}"
    )
    for number, run, done, content, checksum in found:
        sound = checksum == _checksum(run, done, content)
        yield number, json.loads(content) if sound else None


def _checksum(*values: object) -> int:
    return zlib.crc32("\n".join(map(str, values)).encode())
