"""What is stored: whole or not at all, once, and found again whatever happened."""

import math
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import pandas as pd
import pytest

from analytic import InputError, named_case, solve_sweep
from compare.study.keep.database import NAME, Database
from compare.study.keep.store import TABLE_FILE, Store, read_rows, write_table
from compare.study.work.perform import Result, perform
from tests.compare.study.studies import EVENTS_ONLY, fill


@pytest.fixture
def warned():
    return []


@pytest.fixture
def plan(plan_of):
    return plan_of(EVENTS_ONLY)


@pytest.fixture
def stored(plan):
    recipe = plan.study.recipe
    return [perform(recipe, run) for run, _ in zip(plan, range(6), strict=False)]


def test_any_reader_of_the_folder_sees_each_run_once(tmp_path, plan, stored, warned):
    """And only what is done is not done again."""
    fill(tmp_path, plan, [Result(stored[0].row | {"outcome": "failed"}), *stored[1:3]], warned)
    with Store(tmp_path, plan, warned.append) as store:
        assert store.done() == {result.row["run"] for result in stored[1:3]}
    fill(tmp_path, plan, [stored[0], *stored[2:]], warned)
    frame = pd.read_parquet(tmp_path / TABLE_FILE)
    assert len(frame) == len(stored)
    assert set(frame["outcome"]) == {"done"}


def test_a_row_is_there_before_its_table_is(tmp_path, plan, stored, warned):
    with Store(tmp_path, plan, warned.append) as store:
        store.add(stored[0])
        assert len(read_rows(tmp_path, warned.append)) == 1
        assert not (tmp_path / TABLE_FILE).exists()


def test_two_processes_write_at_once(tmp_path, plan, stored, warned):
    with Store(tmp_path, plan, warned.append) as one:
        one.add(stored[0])
        with Store(tmp_path, plan, warned.append) as other:
            assert other.done() == {stored[0].row["run"]}
            other.add(stored[0])
            other.add(stored[1])
        one.add(stored[2])
    assert len(pd.read_parquet(tmp_path / TABLE_FILE)) == 3
    assert not warned


def test_a_file_that_another_leader_is_just_making_is_not_damaged(tmp_path, plan, warned):
    """It has no table yet."""
    with closing(sqlite3.connect(tmp_path / NAME)) as other:
        other.execute("PRAGMA journal_mode = WAL")
        with Store(tmp_path, plan, warned.append) as store:
            assert not store.done()
    assert not warned


def test_rows_come_back_as_they_were(tmp_path, warned):
    rows = [
        {"run": "a", "outcome": "done", "x": -1.5e-300, "n": 3, "yes": True, "no": False},
        {"run": "b", "outcome": "failed", "x": math.inf, "n": -(2**62), "text": 'a"b\n'},
        {"run": "c", "outcome": "done", "x": 0.1 + 0.2, "a.b": math.nan, "none": None, "z": -0.0},
    ]
    database = Database(tmp_path, warned.append)
    for row in rows:
        database.add(row)
    found = [*database.rows()]
    database.close()
    assert repr(found) == repr(rows)
    assert not warned


def test_the_table_has_the_columns_of_all_rows(tmp_path, plan, monkeypatch):
    """In whichever of its parts they first have values; and what the plan says of each run."""
    monkeypatch.setattr("compare.study.keep.store._AT_ONCE", 2)
    own = ({"n": 1, "unknown": None}, {"n": 2}, {"n": 2.5, "late": True})
    rows = [
        {"run": run.id, "outcome": "done", "reason": "", **some}
        for run, some in zip(plan, own, strict=False)
    ]
    write_table(tmp_path / TABLE_FILE, lambda: rows, plan)
    found = pd.read_parquet(tmp_path / TABLE_FILE)
    assert found["n"].tolist() == [1.0, 2.0, 2.5]
    assert found["late"].tolist() == [None, None, True]
    assert found["unknown"].isna().all() and found["unknown"].dtype == float
    assert found["beam.radius"].tolist() == [0.001, 0.002, 0.005]


def test_a_full_disk_loses_nothing(tmp_path, plan, stored, warned, monkeypatch):
    def full(self, row):
        raise sqlite3.OperationalError("database or disk is full")

    with (
        pytest.raises(InputError, match="disk is full"),
        Store(tmp_path, plan, warned.append) as store,
    ):
        store.add(stored[0])
        store.add(stored[1])
        monkeypatch.setattr(Database, "add", full)
        store.add(stored[2])
    monkeypatch.undo()
    with Store(tmp_path, plan, warned.append) as store:
        assert store.done() == {stored[0].row["run"], stored[1].row["run"]}


THREADS = """
import os, sys
from pathlib import Path
import pandas, pyarrow.parquet
from analytic import Readings
from compare.study.keep.store import read_rows

before = len(os.listdir("/proc/self/task"))
assert len(read_rows(Path(sys.argv[1]), print)) == 1
Readings.read(sys.argv[2])
print(len(os.listdir("/proc/self/task")) - before)
"""


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="threads are counted in /proc")
def test_tables_are_read_without_threads(tmp_path, plan, stored, warned):
    # A thread of Arrow's that ends while Python does aborts the process: 1 in 100 studies.
    fill(tmp_path, plan, stored[:1], warned)
    solve_sweep(named_case("catenary")).write(tmp_path / "a.parquet")
    done = subprocess.run(
        [sys.executable, "-c", THREADS, tmp_path, tmp_path / "a.parquet"],
        capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert done.stdout == "0\n"
