"""Small studies and ways to run them."""

import subprocess
import sys
from pathlib import Path

import pandas as pd
import pytest

from compare.study.grid.file import load_study
from compare.study.grid.plan import Plan
from compare.study.keep.store import Store, read_rows
from tests.compare.case_files import BALL

EVENTS_ONLY = """
[study]
case = "catenary"
beams = []
[axes]
profile.a = { from = 0.3, to = 0.8, count = 10 }
beam.radius = [0.001, 0.002, 0.005, 0.01]
"""
ONE_SIMULATION = """
study = { case = "catenary", keep_readings = true, timeout = 30 }
sweep.stations = 40
mujoco = { segments = 10, contour_points = 800 }
"""
SIMULATED_IN_SPACE = f"""
[study]
[axes]
mujoco.segments = [8, 16]
path.tangent.x = [0.0, 0.1]
{BALL}[path]
points = [[1.1, 0.3], [-0.3, 0.3]]
stations = 12
"""
COMMAND = [sys.executable, "-c", "from compare.commands.main import main; main()"]


def planned(folder: Path, text: str) -> Plan:
    """The plan of a study file with that text."""
    path = folder / "grid.toml"
    path.write_text(text)
    return Plan.of(load_study(str(path)))


def only(plan):
    """The recipe and the only run of a plan."""
    (run,) = plan
    return plan.study.recipe, run


def fill(folder: Path, plan: Plan, results, warned: list[str]) -> None:
    with Store(folder, plan, warned.append) as store:
        for result in results:
            store.add(result)


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
