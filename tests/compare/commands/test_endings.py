"""Commands that are ended from outside, or started in a strange environment."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pandas as pd
import pytest

from analytic import Readings
from compare.commands.output import Ended, ended_by_signals
from compare.study.keep.store import PLAN_FILE, TABLE_FILE, read_rows
from tests.compare.processes import children, wait, wait_for_end
from tests.compare.study.studies import COMMAND

# Says of every station that it is done, so that a test knows when to end the sweep.
ANNOUNCED = """
import sys
import compare.simulate.dispatch as dispatch

sweep = dispatch.simulate_sweep

def announced(case, settings, advance, keep):
    return sweep(case, settings, lambda: (advance(), print("station", flush=True)), keep)

dispatch.simulate_sweep = announced
from compare.commands.main import main
main()
"""
# One command after the other, each of which ends with the code given before it.
IN_TURN = """
import sys
from compare.commands.main import main

for command in " ".join(sys.argv[1:]).split(" then "):
    code, *sys.argv[1:] = command.split()
    try:
        main()
    except SystemExit as ended:
        assert ended.code == int(code), (command, ended.code)
    else:
        raise AssertionError(command)
"""
PIPES = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}


def stored(folder):
    return len(read_rows(folder, lambda _: None)) if (folder / PLAN_FILE).is_file() else 0


@pytest.mark.slow
@pytest.mark.parametrize(
    ("way", "said"),
    [
        (signal.SIGINT, "interrupted"),
        (signal.SIGTERM, "ended by SIGTERM"),
        (signal.SIGHUP, "ended by SIGHUP"),
    ],
)
def test_a_sweep_that_is_ended_keeps_its_stations(tmp_path, way, said):
    short = ("--stations", "4000", "--segments", "10")
    words = ["run", "catenary", "--sweep-only", *short, "--out", "out"]
    command = [sys.executable, "-c", ANNOUNCED, *words]
    with subprocess.Popen(command, cwd=tmp_path, **PIPES) as process:
        for _ in range(5):
            assert process.stdout.readline() == "station\n"
        process.send_signal(way)
        _, error = process.communicate(timeout=60)
    assert process.returncode == 2
    kept = Readings.read(tmp_path / "out" / "mujoco-chain.partial.parquet")
    first, second = error.splitlines()
    assert first.startswith(f"vibrissa: kept {len(kept.table)} of 4000 stations in ")
    assert second == f"vibrissa: {said}"
    assert 5 <= len(kept.table) < 4000
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["mujoco-chain.partial.parquet"]


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="children are found in /proc")
def test_a_budget_that_is_ended_leaves_no_process_and_nothing_unfinished(tmp_path):
    words = ["run", "catenary", "--budget", "--stations", "20000", "--out", "out"]
    with subprocess.Popen([*COMMAND, *words], cwd=tmp_path, **PIPES) as process:
        wait(lambda: children(process.pid))
        workers = children(process.pid)
        time.sleep(2)  # at work, or just about to start
        workers += children(process.pid)
        process.send_signal(signal.SIGINT)
        _, error = process.communicate(timeout=60)
    wait_for_end(workers)
    assert process.returncode == 2
    assert len(error.splitlines()) == 1, error
    # At most the sweep in closed form, which is made while the workers start.
    assert {path.name for path in tmp_path.rglob("*")} <= {"out", "analytic.parquet"}


@pytest.mark.slow
def test_a_study_that_is_ended_goes_on_where_it_was(tmp_path):
    (tmp_path / "grid.toml").write_text(
        'study = { case = "catenary", beams = [] }\n'
        "axes.beam.radius = { from = 0.001, to = 0.01, count = 5000 }\n"
    )
    words = ["study", "grid.toml", "--out", "out", "--workers", "1"]
    with subprocess.Popen([*COMMAND, *words], cwd=tmp_path, **PIPES) as process:
        wait(lambda: stored(tmp_path / "out") >= 5)
        workers = children(process.pid)
        process.send_signal(signal.SIGTERM)
        _, error = process.communicate(timeout=60)
    assert process.returncode == 2
    assert len(error.splitlines()) == 1, error
    assert "of 5000 runs in out: the same command does the others" in error
    assert list(tmp_path.rglob(".*")) == []
    assert len(pd.read_parquet(tmp_path / "out" / TABLE_FILE)) >= 5
    wait_for_end(workers)


def test_nohup_is_respected(tmp_path):
    """A signal that whoever started the command ignores is ignored."""
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        with ended_by_signals():
            os.kill(os.getpid(), signal.SIGHUP)
            with pytest.raises(Ended, match="SIGTERM"):
                os.kill(os.getpid(), signal.SIGTERM)
    finally:
        signal.signal(signal.SIGHUP, before)


EXACT = "run parabola --engine exact --stations 30 --out"
COMPARED = "compare ä/analytic.parquet ä/analytic.parquet --out ü"
ALL = f"0 {EXACT} ä then 0 {COMPARED} then 2 reconstruct größe.csv"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("strange", "commands", "said"),
    [
        (
            {"MPLBACKEND": "nonsense", "COLUMNS": "10", "TERM": "dumb"}
            | dict.fromkeys(("HOME", "MPLCONFIGDIR"), "/nowhere"),
            ALL,
            "",
        ),
        ({"PYTHONIOENCODING": "ascii"}, ALL, ""),
        # Python cannot even say what file is meant; one line says what to do.
        (
            {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
            f"0 list cases then 0 {EXACT} out then 2 {EXACT} ä",
            "LC_ALL",
        ),
    ],
)
def test_strange_environments(tmp_path, strange, commands, said):
    """Same files, same exit code; what the encoding lacks is written as an escape."""
    environment = {k: v for k, v in os.environ.items() if not k.startswith(("LC_", "LANG"))}
    (tmp_path / "größe.csv").write_text("ü,é\n1,2\n", encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-c", IN_TURN, *commands.split()],
        cwd=tmp_path, env={**environment, **strange}, capture_output=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert done.stderr.count(b"\n") == 1, done.stderr  # of the last one
    assert said.encode() in done.stderr
    assert (tmp_path / "ü" / "report.html").exists() == (commands == ALL)


@pytest.mark.slow
@pytest.mark.parametrize(("model", "code"), [("sound-chain", 0), ("mistakes", 1)])
def test_who_reads_no_further_changes_no_verdict(model, code):
    """As `| head` does: the code of what agrees was 1."""
    with subprocess.Popen([*COMMAND, "inspect", model], **PIPES) as run:
        run.stdout.close()
        assert run.wait(60) == code
