"""Studies: what scheduling and storing cost, and how well two cores are used."""

import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from rich.console import Console

from compare.study.grid.file import load_study
from compare.study.grid.plan import Plan, PlannedRun
from compare.study.grid.study import Study
from compare.study.work.execute import Task, carry_out, local_crew
from compare.study.work.perform import Result
from tests.compare.study.studies import EVENTS_ONLY, vibrissa


def spin(recipe: Study, runs: Sequence[PlannedRun]) -> list[Result]:
    """A run of a fifth of a second of work."""
    end = time.process_time() + 0.2
    while time.process_time() < end:
        pass
    return nothing(recipe, runs)


def nothing(recipe: Study, runs: Sequence[PlannedRun]) -> list[Result]:
    return [Result({"run": run.id, "outcome": "done"}) for run in runs]


def main(quick: bool) -> None:
    console = Console()
    equal_runs, many_runs, all_runs = (8, 16, 20) if quick else (64, 400, 2_000)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "grid.toml"
        equal = _plan(path, equal_runs)
        ratio = _seconds(equal, 1, spin) / _seconds(equal, 2, spin)
        console.print(
            f"{equal_runs} equal runs: two processes are {ratio:.2f} times as fast as one"
        )
        many = _plan(path, many_runs)
        _seconds(many, 2, nothing)
        overhead = _seconds(many, 2, nothing) / many_runs
        console.print(f"scheduling: {1e3 * overhead:.2f} ms a run, the workers' start included")
        _plan(path, all_runs)
        begin = time.perf_counter()
        vibrissa("study", path, "--out", folder + "/out", cwd=folder).check_returncode()
        took = time.perf_counter() - begin
        console.print(
            f"{all_runs:,} analytic runs (events): {took:.0f} s, "
            f"{1e3 * took / all_runs:.1f} ms each"
        )


def _plan(path: Path, runs: int) -> Plan:
    path.write_text(EVENTS_ONLY.replace("count = 10", f"count = {runs // 4}"))
    return Plan.of(load_study(str(path)))


def _seconds(plan: Plan, workers: int, task: Task) -> float:
    begin = time.perf_counter()
    crew = replace(local_crew(workers), task=task)
    singly = replace(plan.study.recipe, beams=("chain",))  # as simulated runs are handed out
    assert sum(1 for _ in carry_out(plan, singly, crew)) == len(plan)
    return time.perf_counter() - begin
