"""Whatever bytes change in a study's folder: no wrong row, nothing blocked, one line about it."""

import random
import shutil
import sqlite3
from contextlib import closing, suppress

import pandas as pd
import pytest

from analytic import InputError
from compare.study.keep.database import NAME
from compare.study.keep.store import PLAN_FILE, TABLE_FILE, Store, read_plan, read_rows
from compare.study.work.perform import perform
from tests.compare.study.studies import EVENTS_ONLY, fill, planned


def flipped(content, chance):
    changed = bytearray(content)
    for _ in range(chance.choice([1, 1, 3, 20])):
        changed[chance.randrange(len(changed))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def cut(content, chance):
    return content[: chance.randrange(len(content))]


def zeroed(content, chance):
    start, end = sorted(chance.randrange(len(content)) for _ in range(2))
    return content[:start] + bytes(end - start) + content[end:]


def junk(content, chance):
    place = chance.randrange(len(content))
    return content[:place] + chance.randbytes(chance.randrange(1, 200)) + content[place:]


DAMAGES = (flipped, cut, zeroed, junk)


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    return planned(tmp_path_factory.mktemp("plan"), EVENTS_ONLY.replace("10 }", "2 }"))


@pytest.fixture(scope="module")
def stored(plan):
    recipe = plan.study.recipe
    return {run.id: perform(recipe, run) for run in plan}


@pytest.fixture(scope="module")
def complete(plan, stored, tmp_path_factory):
    folder = tmp_path_factory.mktemp("complete")
    fill(folder, plan, stored.values(), [])
    return folder


@pytest.fixture(scope="module")
def killed(plan, stored, tmp_path_factory):
    """A folder as a killed process leaves it."""
    folder = tmp_path_factory.mktemp("killed")
    with Store(tmp_path_factory.mktemp("living"), plan, print) as store:
        for result in stored.values():
            store.add(result)
        shutil.copytree(store._folder, folder, dirs_exist_ok=True)
    return folder


def check_recovery(folder, plan, stored):
    """Reading and going on work; rows that are there are as they were, others are done again."""
    warned = []
    with suppress(InputError):
        for row in read_rows(folder, warned.append).to_dict("records"):
            assert row["event_snap_off"] == stored[row["run"]].row["event_snap_off"]
    with Store(folder, plan, warned.append) as store:
        missing = stored.keys() - store.done()
        for run in missing:
            store.add(stored[run])
    assert not any("\n" in line for line in warned)
    rows = pd.read_parquet(folder / TABLE_FILE).set_index("run")
    assert set(rows.index) == set(stored)
    assert not rows.index.duplicated().any()
    for run, result in stored.items():
        for name, value in result.row.items():
            if name != "run":
                kept = rows.loc[run, name]
                assert pd.isna(kept) if value is None else kept == value
    again = []
    read_rows(folder, again.append)
    assert not again
    return missing, warned


@pytest.mark.parametrize("trials", [8, pytest.param(300, marks=pytest.mark.trial)])
@pytest.mark.parametrize(
    "what", [("complete", NAME), ("killed", f"{NAME}-wal"), ("killed", PLAN_FILE)]
)
def test_random_damage(what, trials, plan, stored, complete, killed, tmp_path):
    whole, name = {"complete": complete, "killed": killed}[what[0]], what[1]
    chance = random.Random(f"damage to {what}")
    done_again = 0
    for trial in range(trials):
        folder = shutil.copytree(whole, tmp_path / str(trial))
        content = (folder / name).read_bytes()
        (folder / name).write_bytes(chance.choice(DAMAGES)(content, chance))
        missing, warned = check_recovery(folder, plan, stored)
        if what[0] == "complete" and missing:
            assert warned
        done_again += bool(missing)
    assert done_again or name == PLAN_FILE


def test_one_damaged_row_costs_one_run(plan, stored, complete, tmp_path):
    folder = shutil.copytree(complete, tmp_path / "copy")
    content = (folder / NAME).read_bytes()
    assert content.count(b'"done"') == len(stored)
    (folder / NAME).write_bytes(content.replace(b'"done"', b'"dome"', 1))
    missing, warned = check_recovery(folder, plan, stored)
    assert len(missing) == 1
    assert "1 rows" in warned[-1]


@pytest.mark.parametrize(
    "change",
    [
        "ALTER TABLE runs RENAME COLUMN done TO finished",
        "ALTER TABLE runs ADD COLUMN more",
        "UPDATE runs SET content = x'ff'",
        "DROP TABLE runs",
    ],
)
def test_what_others_wrote_is_no_result(plan, stored, complete, tmp_path, change):
    folder = shutil.copytree(complete, tmp_path / "copy")
    with closing(sqlite3.connect(folder / NAME)) as connection:
        connection.execute(change)
        connection.commit()
    missing, warned = check_recovery(folder, plan, stored)
    assert warned
    assert bool(missing) == ("ADD COLUMN" not in change)


@pytest.mark.parametrize(
    "content", [b"", b"[1, 2]", b"\xff", b"[" * 100_000, b'{"study": {"name": 1}}']
)
def test_a_damaged_plan_is_one_line(complete, tmp_path, content):
    folder = shutil.copytree(complete, tmp_path / "copy")
    (folder / PLAN_FILE).write_bytes(content)
    with pytest.raises(InputError, match=r"study\.json") as caught:
        read_plan(folder)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400
