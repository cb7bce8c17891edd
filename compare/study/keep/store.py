"""The results of a study on disk: one Parquet dataset in ``DIR/runs``, a row a run.

Only the process that leads a study writes, to files of its own; those that do the runs may be
anywhere and touch no disk.
"""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import TypeAlias

import pyarrow.compute as pc

from analytic import InputError
from analytic.problem.files import write_whole
from compare.study.grid.plan import Plan
from compare.study.keep.journal import Journal, adopt_journals, list_journals, read_journal
from compare.study.keep.locks import check_platform, lock
from compare.study.keep.parts import Columns, list_parts, sound_parts
from compare.study.keep.tidy import Shelves, tidy
from compare.study.work.perform import Result, columns

PLAN_FILE = "study.json"
ROWS_A_PART = 5000

Warn: TypeAlias = Callable[[str], None]
"""Takes a line for the user."""


class Store:
    """Where a study's results go, and which are there already.

    Use it as a context: it is tidied up at its end, also after an error.
    """

    def __init__(self, folder: Path, plan: Plan, warn: Warn) -> None:
        check_platform()
        self._folder = folder
        self._plan = plan
        self._shelves = Shelves(folder / "runs", folder / "earlier")
        self._columns = columns(plan.study)
        self._wanted = {run.id: number for number, run in enumerate(plan)}
        self._warn = warn
        with _in_one_line(folder):
            self._shelves.runs.mkdir(parents=True, exist_ok=True)
            with lock(self._shelves.runs):
                adopt_journals(self._shelves.runs, self._columns, self._set_aside)
                self._tidy()
                self._journal = Journal(self._shelves.runs, self._columns)

    def __enter__(self) -> "Store":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with _in_one_line(self._folder), lock(self._shelves.runs):
            self._journal.close(self._set_aside)
            self._tidy()

    def done(self) -> set[str]:
        """Find out what need not be done again."""
        runs, found = self._shelves.runs, set[str]()
        with _in_one_line(self._folder), lock(runs):
            parts = sound_parts(list_parts(runs), Columns(self._columns), self._set_aside)
            journals = (read_journal(path, self._columns)[0] for path in list_journals(runs))
            for table in (*(table for _, table in parts), *journals):
                done = table.filter(pc.equal(table["outcome"], "done"))
                found.update(done["run"].to_pylist())
        return found & self._wanted.keys()

    def add(self, result: Result) -> None:
        """Store a result: its readings first, so that a row that is there is complete."""
        with _in_one_line(self._folder):
            if result.readings:
                (self._folder / "readings").mkdir(exist_ok=True)
            for name, readings in result.readings.items():
                readings.write(self._folder / "readings" / f"{result.row['run']}-{name}.parquet")
            self._journal.add(result.row)
            if self._journal.rows == ROWS_A_PART:
                with lock(self._shelves.runs):
                    self._journal.close(self._set_aside)
                    self._journal = Journal(self._shelves.runs, self._columns)

    def _tidy(self) -> None:
        """Whoever does this last says what the folder holds."""
        write_whole(self._folder / PLAN_FILE, self._plan.to_json().encode())
        moved = tidy(self._shelves, self._plan, self._wanted, self._columns, self._set_aside)
        if moved:
            self._warn(f"{moved} runs of another plan are kept in {self._shelves.earlier}")

    def _set_aside(self, path: Path, reason: str) -> None:
        path.rename(path.with_name(f".damaged-{path.name.lstrip('.')}"))
        self._warn(f"{path} is damaged ({reason}) and set aside: its runs are done again")


@contextmanager
def _in_one_line(folder: Path) -> Iterator[None]:
    """A full or read-only disk in one line."""
    try:
        yield
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise InputError(
            "--out",
            f"{folder} ({reason})",
            "a folder that can be written to, with space left",
            "correct that and start again: complete runs are kept",
        ) from error
