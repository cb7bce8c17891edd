"""The results of a study on disk: ``DIR/runs.sqlite``, and ``DIR/runs.parquet`` made of it.

Only the process that leads a study writes; those that do the runs may be anywhere and touch no
disk.
"""

import os
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from itertools import islice
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from analytic import InputError
from analytic.problem.files import whole_file, write_whole
from compare.study.grid.plan import PLAN, Plan
from compare.study.keep.database import NAME, Database, Row, Warn, read
from compare.study.work.perform import Result

PLAN_FILE = "study.json"
TABLE_FILE = "runs.parquet"


class Store:
    """Where a study's results go, and which are there already.

    Use it as a context: its table is written at its end, also after an error.
    """

    def __init__(self, folder: Path, plan: Plan, warn: Warn) -> None:
        self._folder, self._plan = folder, plan
        described = PLAN.dump_json(plan, indent=1)
        with _in_one_line(folder):
            folder.mkdir(parents=True, exist_ok=True)
            file = folder / PLAN_FILE
            is_first = not file.is_file()
            self._is_new = is_first or file.read_bytes() != described
            self._database = Database(folder, warn, is_first)
            write_whole(file, described)
            done = self._database.done()
        self._done = {run.id for run in plan if run.id in done}
        others = len(done) - len(self._done)
        if self._is_new and others:
            warn(f"{others} runs of another plan are kept in {self._database.path}")

    def __enter__(self) -> "Store":
        return self

    def __exit__(self, *_: object) -> None:
        with _in_one_line(self._folder):
            table = self._folder / TABLE_FILE
            if self._is_new or not table.is_file():
                with self._database.as_it_is() as rows:
                    write_table(table, rows, self._plan)
            self._database.close()

    def done(self) -> set[str]:
        return self._done

    def add(self, result: Result) -> None:
        """Store a result: its readings first, so that a row that is there is complete."""
        self._is_new = True
        with _in_one_line(self._folder):
            if result.readings:
                (self._folder / "readings").mkdir(exist_ok=True)
            for name, readings in result.readings.items():
                readings.write(self._folder / "readings" / f"{result.row['run']}-{name}.parquet")
            self._database.add(result.row)


@contextmanager
def _in_one_line(folder: Path) -> Iterator[None]:
    try:
        yield
    except (OSError, sqlite3.DatabaseError) as error:
        number = error.errno if isinstance(error, OSError) else None
        reason = os.strerror(number) if number else str(error)
        allowed = "a folder that can be written to, with space left"
        remedy = "correct that and start again: complete runs are kept"
        raise InputError("--out", f"{folder} ({reason})", allowed, remedy) from error


_AT_ONCE = 5000  # rows in memory


def numbers(plan: Plan) -> dict[str, int]:
    return {run.id: number for number, run in enumerate(plan)}


def tables(rows: Iterable[Row], plan: Plan, number_of: Mapping[str, int]) -> Iterator[pa.Table]:
    """The plan's rows, some thousand at a time; the first table is empty."""
    yield pa.schema([(name, pa.string()) for name in ("run", "outcome", "reason")]).empty_table()
    wanted = (row for row in rows if row["run"] in number_of)
    while some := list(islice(wanted, _AT_ONCE)):
        # A row that was done for another plan may lack some of this one's axes.
        whole = [{**plan.parameters(number_of[row["run"]]), **row} for row in some]
        names = dict.fromkeys(name for row in whole for name in row)
        yield pa.table({name: pa.array([row.get(name) for row in whole]) for name in names})


def joined(parts: Iterable[pa.Table]) -> pa.Table:
    """Tables below each other, with the columns of all; what is nowhere known would be numbers."""
    found = pa.concat_tables(parts, promote_options="permissive")
    known = (x.with_type(pa.float64()) if pa.types.is_null(x.type) else x for x in found.schema)
    return found.cast(pa.schema(known))


def write_table(path: Path, rows: Callable[[], Iterable[Row]], plan: Plan) -> None:
    """Write the plan's rows as a Parquet file, whole or not at all."""
    number_of = numbers(plan)
    # The columns of all are known before the first is written.
    some = tables(rows(), plan, number_of)
    empty = joined(table.schema.empty_table() for table in some)
    with (
        whole_file(path) as unfinished,
        pq.ParquetWriter(unfinished, empty.schema, compression="zstd") as writer,
    ):
        for table in tables(rows(), plan, number_of):
            writer.write_table(joined([empty, table]))


def read_rows(folder: Path, warn: Warn) -> pd.DataFrame:
    """Read all that is stored of a study, also while it is under way.

    Parameters
    ----------
    folder : Path
        Of the study.
    warn : callable
        Takes a line about anything that is wrong with what is stored.

    Returns
    -------
    pandas.DataFrame
        A row a run.

    Raises
    ------
    InputError
        If there is no study in `folder`.
    """
    if not (folder / NAME).is_file():
        raise InputError("DIR", folder, "the folder of a study", "`vibrissa study` makes one")
    plan = read_plan(folder)
    found = joined(tables(read(folder, warn), plan, numbers(plan)))
    # Not in Arrow's threads: one that still ends while Python does aborts the whole process.
    frame: pd.DataFrame = found.to_pandas(use_threads=False)
    return frame.sort_values("run", ignore_index=True)


def read_plan(folder: Path) -> Plan:
    path = folder / PLAN_FILE
    remedy = "start `vibrissa study FILE --out DIR` again: complete runs are kept"
    try:
        return PLAN.validate_json(path.read_bytes())
    except OSError as error:
        raise InputError("DIR", folder, f"a folder with a readable {PLAN_FILE}", remedy) from error
    except InputError:
        raise
    except ValueError as error:
        raise InputError(str(path), "damaged", "as the study wrote it", remedy) from error
