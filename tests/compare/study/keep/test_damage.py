"""Whatever bytes change in a study's folder: no wrong row, nothing blocked, one line about it."""

import random
import shutil
from contextlib import suppress

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from analytic import InputError
from compare.study.keep.journal import list_journals
from compare.study.keep.parts import list_parts
from compare.study.keep.reading import read_plan, read_rows
from compare.study.keep.store import PLAN_FILE, Store
from compare.study.work.perform import perform
from compare.study.work.recipe import Recipe
from tests.compare.study.studies import EVENTS_ONLY, planned


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


def junk_line(content, chance):
    lines = content.split(b"\n")
    place = chance.randrange(len(lines))
    line = chance.choice([b"{}", b"null", b"\xff\xfe", b"\0" * 50, b'{"run": 1}', b""])
    return b"\n".join([*lines[:place], line, *lines[place:]])


DAMAGES = (flipped, cut, zeroed, junk, junk_line)


@pytest.fixture(scope="module")
def plan(tmp_path_factory):
    return planned(tmp_path_factory.mktemp("plan"), EVENTS_ONLY.replace("10 }", "2 }"))


@pytest.fixture(scope="module")
def stored(plan):
    recipe = Recipe.of(plan.study)
    return {run.id: perform(recipe, run) for run in plan}


def fill(folder, plan, results, warned):
    with Store(folder, plan, warned.append) as store:
        for result in results:
            store.add(result)


@pytest.fixture(scope="module")
def as_part(plan, stored, tmp_path_factory):
    folder = tmp_path_factory.mktemp("as-part")
    fill(folder, plan, stored.values(), [])
    return folder


@pytest.fixture(scope="module")
def as_journal(plan, stored, tmp_path_factory):
    """A folder as a killed process leaves it."""
    folder = tmp_path_factory.mktemp("as-journal")
    living = tmp_path_factory.mktemp("living")
    with Store(living, plan, print) as store:
        for result in stored.values():
            store.add(result)
        (journal,) = list_journals(living / "runs")
        (folder / "runs").mkdir()
        shutil.copy(journal, folder / "runs")
    (folder / PLAN_FILE).write_text(plan.to_json())
    return folder


def target(folder, what):
    if what == "plan":
        return folder / PLAN_FILE
    (path,) = (list_parts if what == "part" else list_journals)(folder / "runs")
    return path


def check_recovery(folder, plan, stored):
    """Reading and going on work; rows that are there are as they were, others are done again."""
    warned = []
    read_rows(folder, warned.append)
    with suppress(InputError):
        read_plan(folder)
    with Store(folder, plan, warned.append) as store:
        missing = stored.keys() - store.done()
        for run in missing:
            store.add(stored[run])
    assert not any("\n" in line for line in warned)
    rows = pd.read_parquet(folder / "runs").set_index("run")
    assert set(rows.index) == set(stored)
    assert not rows.index.duplicated().any()
    for run, result in stored.items():
        for name, value in result.row.items():
            if name != "run":
                assert rows.loc[run, name] == value
    return missing, warned


@pytest.mark.parametrize("trials", [8, pytest.param(300, marks=pytest.mark.trial)])
@pytest.mark.parametrize("what", ["part", "journal", "plan"])
def test_random_damage(what, trials, plan, stored, as_part, as_journal, tmp_path):
    chance = random.Random(f"damage to {what}")
    noticed = 0
    for trial in range(trials):
        whole = as_journal if what == "journal" else as_part
        folder = shutil.copytree(whole, tmp_path / str(trial))
        path = target(folder, what)
        content = path.read_bytes()
        damaged = chance.choice(DAMAGES)(content, chance)
        path.write_bytes(damaged)
        missing, warned = check_recovery(folder, plan, stored)
        if what == "part":
            assert bool(missing) == bool(warned) == (damaged != content)
        noticed += bool(warned)
    assert noticed or what == "plan"


def test_one_damaged_line_costs_one_run(plan, stored, as_journal, tmp_path):
    folder = shutil.copytree(as_journal, tmp_path / "copy")
    path = target(folder, "journal")
    lines = path.read_bytes().split(b"\n")
    lines[2] = lines[2].replace(b"done", b"dome")
    path.write_bytes(b"\n".join(lines))
    missing, warned = check_recovery(folder, plan, stored)
    assert len(missing) == 1
    assert "1 of 8 lines" in warned[-1]
    assert list((folder / "runs").glob(".damaged-journal*"))


def other_types(table):
    place = table.schema.get_field_index("event_snap_off")
    return table.set_column(place, "event_snap_off", pa.array(["x"] * table.num_rows))


@pytest.mark.parametrize(
    "change",
    [
        lambda table: table.rename_columns([f"{name}_" for name in table.column_names]),
        lambda table: table.drop_columns(["outcome"]),
        lambda table: table.set_column(0, "run", pa.array(range(table.num_rows))),
        lambda table: table.set_column(0, "run", pa.nulls(table.num_rows, "string")),
        other_types,
    ],
)
def test_a_foreign_part_is_set_aside(plan, stored, as_part, tmp_path, change):
    folder = shutil.copytree(as_part, tmp_path / "copy")
    table = pq.read_table(target(folder, "part"))
    pq.write_table(change(table), folder / "runs" / "part-0-foreign.parquet")
    missing, warned = check_recovery(folder, plan, stored)
    assert not missing
    assert "part-0-foreign" in warned[-1]


def test_a_folder_in_the_place_of_a_part(plan, stored, as_part, tmp_path):
    folder = shutil.copytree(as_part, tmp_path / "copy")
    (folder / "runs" / "part-0-folder.parquet").mkdir()
    missing, warned = check_recovery(folder, plan, stored)
    assert not missing
    assert "part-0-folder" in warned[-1]


@pytest.mark.parametrize(
    "content", [b"", b"{}", b"[1, 2]", b"null", b"\xff", b"[" * 100_000, b'{"study": {"name": 1}}']
)
def test_a_damaged_plan_is_one_line(as_part, tmp_path, content):
    folder = shutil.copytree(as_part, tmp_path / "copy")
    (folder / PLAN_FILE).write_bytes(content)
    with pytest.raises(InputError, match=r"study\.json") as caught:
        read_plan(folder)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400
