"""Small studies and ways to run them."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pandas as pd
import pytest

from compare.commands.main import main
from compare.study.grid.file import load_study
from compare.study.grid.plan import Plan
from compare.study.keep.store import read_rows

EVENTS_ONLY = """
[study]
case = "catenary"
beams = []
[axes]
profile.a = { from = 0.3, to = 0.8, count = 10 }
beam.radius = [0.001, 0.002, 0.005, 0.01]
"""

COMMAND = [sys.executable, "-c", "from compare.commands.main import main; main()"]


def vibrissa(*arguments, cwd, **options) -> subprocess.CompletedProcess:
    return subprocess.run(
        [*COMMAND, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, check=False,
        timeout=300, **options,
    )  # fmt: skip


def results(folder: Path) -> pd.DataFrame:
    """The table of a study without what differs from time to time and machine to machine."""
    rows = read_rows(folder, lambda line: pytest.fail(line))
    changing = [c for c in rows if c.startswith("seconds") or c in ("host", "system")]
    return rows.drop(columns=changing)


@pytest.fixture
def plan_of(tmp_path) -> Callable[[str], Plan]:
    def make(text: str) -> Plan:
        path = tmp_path / "grid.toml"
        path.write_text(text)
        return Plan.of(load_study(str(path)))

    return make


@pytest.fixture
def command(tmp_path, monkeypatch, capsys) -> Callable[..., subprocess.CompletedProcess]:
    """The command line without a new process; what it starts itself is real."""

    def run(*arguments):
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", ["vibrissa", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        told = capsys.readouterr()
        return subprocess.CompletedProcess(arguments, ended.value.code, told.out, told.err)

    return run
