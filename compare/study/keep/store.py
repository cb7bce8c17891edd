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

import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc

from analytic import InputError
from analytic.problem.files import write_whole
from compare.study.grid.plan import Plan
from compare.study.keep.journal import Journal, adopt_journals, lock, read_journals
from compare.study.keep.merge import compact, merge
from compare.study.keep.parts import Damaged, sound_parts
from compare.study.work.run import Result, columns

PLAN_FILE = "study.json"
_ROWS_A_PART = 5000

Tell: TypeAlias = Callable[[str], None]


class Store:
    """Where a study's results go, and which are there already.

    Use it as a context: what is left to be tidied up then is, also after an error.

    Parameters
    ----------
    folder : Path
        Of the study; made if it is not there.
    plan : Plan
        What is to be done; it is kept beside the results.
    tell : callable
        Takes a line about anything that is wrong with what is stored.

    Raises
    ------
    InputError
        If the folder cannot be written to; by the other methods too.
    """

    def __init__(self, folder: Path, plan: Plan, tell: Tell) -> None:
        self._folder = folder
        self._runs = folder / "runs"
        self._columns = columns(plan.study)
        self._tell = tell
        with _told(folder):
            self._runs.mkdir(parents=True, exist_ok=True)
            write_whole(folder / PLAN_FILE, plan.to_json().encode())
            with lock(self._runs):
                adopt_journals(self._runs)
                self._journal = Journal(self._runs, self._columns)

    def __enter__(self) -> "Store":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        with _told(self._folder), lock(self._runs):
            self._journal.close()
            compact(self._runs, self._set_aside)

    def done(self) -> set[str]:
        """Ids of the runs that need not be done again.

        Damaged parts are set aside, under a hidden name, so that their runs are.
        """
        found: set[str] = set()
        with _told(self._folder), lock(self._runs):
            for table in _tables(self._runs, self._set_aside):
                done = table.filter(pc.equal(table["outcome"], "done"))
                found.update(done["run"].to_pylist())
        return found

    def add(self, result: Result) -> None:
        """Store a result: its readings first, so that a row that is there is complete."""
        with _told(self._folder):
            if result.readings:
                (self._folder / "readings").mkdir(exist_ok=True)
            for name, readings in result.readings.items():
                readings.write(self._folder / "readings" / f"{result.row['run']}-{name}.parquet")
            self._journal.add(result.row)
            if self._journal.rows == _ROWS_A_PART:
                with lock(self._runs):
                    self._journal.close()
                    self._journal = Journal(self._runs, self._columns)

    def _set_aside(self, path: Path, reason: str) -> None:
        path.rename(path.with_name(f".damaged-{path.name}"))
        self._tell(f"{path} is damaged ({reason}) and set aside: its runs are done again")


def read_rows(folder: Path, tell: Tell) -> pd.DataFrame:
    """All that is stored of a study, a row a run, also while it is under way.

    Raises
    ------
    InputError
        If there is no study in `folder`.
    """
    runs = folder / "runs"
    if not runs.is_dir():
        raise InputError("DIR", folder, "the folder of a study", "`vibrissa study` makes one")
    with lock(runs):
        tables = list(_tables(runs, lambda path, reason: tell(f"{path} is damaged ({reason})")))
    frame = merge(tables).to_pandas() if tables else pd.DataFrame({"run": [], "outcome": []})
    return frame.sort_values("run", ignore_index=True)


def _tables(runs: Path, damaged: Damaged) -> Iterator[pa.Table]:
    for _, table in sound_parts(runs, damaged):
        yield table
    yield from read_journals(runs)


@contextmanager
def _told(folder: Path) -> Iterator[None]:
    """A full or read-only disk in one line."""
    try:
        yield
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise InputError(
            "--out",
            f"{folder} ({reason})",
            "a folder that can be written to, with space left",
            "mend that and start again: complete runs are kept",
        ) from error
