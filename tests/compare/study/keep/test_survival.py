"""A study survives what is done to it, in flat memory. Slow."""

import json
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from compare.study.keep.database import NAME
from compare.study.keep.store import PLAN_FILE, TABLE_FILE
from tests.compare.processes import wait
from tests.compare.study.studies import COMMAND, EVENTS_ONLY, results, vibrissa

pytestmark = pytest.mark.slow

FEW_HUNDRED = EVENTS_ONLY.replace("count = 10", "count = 100")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "grid.toml").write_text(FEW_HUNDRED)
    return tmp_path


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory) -> pd.DataFrame:
    """The table of that study where nothing happens to it."""
    place = tmp_path_factory.mktemp("undisturbed")
    (place / "grid.toml").write_text(FEW_HUNDRED)
    assert vibrissa("study", "grid.toml", "--out", "out", cwd=place).returncode == 0
    return results(place / "out")


def start(folder, *more, out="out"):
    command = [*COMMAND, "study", "grid.toml", "--out", out, *more]
    return subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.parametrize("times", [3, pytest.param(20, marks=pytest.mark.trial)])
def test_killed_many_times(folder, undisturbed, command, times):
    chance = random.Random(6)
    seen: set[str] = set()
    for _ in range(times):
        process = start(folder)
        time.sleep(chance.uniform(1.0, 4.0))
        process.send_signal(signal.SIGKILL)
        process.communicate()
        if (folder / "out" / NAME).is_file():
            now = set(results(folder / "out")["run"])
            assert seen <= now  # nothing that was complete is lost
            seen = now
    assert command("study", "grid.toml", "--out", "out").returncode == 0
    pd.testing.assert_frame_equal(results(folder / "out"), undisturbed)
    assert not pd.read_parquet(folder / "out" / TABLE_FILE)["run"].duplicated().any()


def test_two_processes_on_one_study(folder, undisturbed):
    processes = [start(folder) for _ in range(2)]
    for process in processes:
        _, error = process.communicate(timeout=300)
        assert (process.returncode, error) == (0, "")
    pd.testing.assert_frame_equal(results(folder / "out"), undisturbed)
    assert len(pd.read_parquet(folder / "out" / TABLE_FILE)) == 400


def peak_memory(folder: Path, runs: int) -> int:
    text = EVENTS_ONLY.replace("count = 10", f"count = {runs // 4}")
    (folder / "grid.toml").write_text(text)
    code = (
        "import sys, resource; from compare.commands.main import app; app(standalone_mode=False); "
        "print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code, "study", "grid.toml", "--out", f"out-{runs}"],
        cwd=folder, capture_output=True, text=True, check=True,
    )  # fmt: skip
    return int(done.stdout.split()[-1])


def test_memory_is_flat_in_the_number_of_runs(tmp_path):
    few, many = peak_memory(tmp_path, 100), peak_memory(tmp_path, 2_000)
    assert many < 1.2 * few


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """A scheduler and two workers, each a process of its own; the last test here ends the first."""
    place = tmp_path_factory.mktemp("cluster")
    file = place / "scheduler.json"
    dask = [sys.executable, "-m", "dask"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    scheduler = subprocess.Popen(
        [*dask, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
         "--scheduler-file", str(file)], **quiet,
    )  # fmt: skip
    wait(file.exists)
    workers = [
        subprocess.Popen(
            [*dask, "worker", "--scheduler-file", str(file), "--nthreads", "1", "--no-dashboard",
             "--no-nanny", "--local-directory", str(place)], **quiet,
        )
        for _ in range(2)
    ]  # fmt: skip
    time.sleep(5)
    address = None
    while address is None:
        try:
            address = json.loads(file.read_text())["address"]
        except ValueError:
            time.sleep(0.1)
    yield address, scheduler
    for process in (*workers, scheduler):
        process.terminate()
        process.wait()


def test_a_cluster_gives_the_same_table(folder, cluster, undisturbed):
    address, _ = cluster
    done = vibrissa("study", "grid.toml", "--out", "out", "--scheduler", address, cwd=folder)
    assert (done.returncode, done.stderr) == (0, "")
    pd.testing.assert_frame_equal(results(folder / "out"), undisturbed)


def rows_there(folder: Path) -> int:
    begun = all((folder / name).is_file() for name in (NAME, PLAN_FILE))
    return len(results(folder)) if begun else 0


def test_a_scheduler_that_goes_loses_nothing(folder, cluster, command):
    address, scheduler = cluster
    (folder / "grid.toml").write_text(FEW_HUNDRED.replace("100", "500"))
    process = start(folder, "--scheduler", address)
    wait(lambda: process.poll() is not None or rows_there(folder / "out") >= 20)
    scheduler.kill()
    _, error = process.communicate(timeout=120)
    assert process.returncode == 2, error
    assert [line for line in error.splitlines() if "--scheduler" not in line] == []
    before = len(results(folder / "out"))
    assert before > 0
    again = command("study", "grid.toml", "--out", "out")
    assert f"{before} of them done already" in again.stdout
