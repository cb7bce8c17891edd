"""What a disagreement is made of: ``run --budget``, at rest and in motion."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from analytic import Readings
from compare.commands import terminal
from compare.commands.keep import keep
from compare.commands.measured_budgets import (
    fastest_motion,
    measured_budget,
    measured_motion_budget,
)
from compare.explain.budget import Budget
from compare.read.job import Job
from compare.show.report import budget_files
from compare.simulate.target import follow_advice


@dataclass(frozen=True)
class Measured:
    """A budget that was measured, printed, and is to be kept."""

    base: Readings  # MuJoCo's sweep that it is of
    at_rest: Budget | None  # None in motion
    reached: bool = True  # the target at rest, if there is one
    contents: Mapping[str, Any] = field(default_factory=dict)  # of files, by name
    runs: Mapping[str, Readings] = field(default_factory=dict)  # all of its sweeps

    def write(self, folder: Path) -> None:
        """Write what the report does not."""
        for name, readings in self.runs.items():
            readings.write(folder / f"{name}.parquet")
        for name, content in self.contents.items():
            keep(folder / name, content)


def measured(job: Job, target: float | None) -> Measured:
    """Measure and print the budget of a job, and what to do for a wanted error."""
    return _at_rest(job, target) if job.motion is None else _in_motion(job, target)


def _at_rest(job: Job, target: float | None) -> Measured:
    found, runs = measured_budget(job)
    terminal.print_budget(found, job.case.name)
    if target is None:
        return Measured(runs["base"], found)
    advice = follow_advice(job.case, found, runs, target)
    terminal.print_advice(advice)
    contents = {"budget.json": budget_files(found, advice.to_dict())["budget.json"]}
    return Measured(runs["base"], found, advice.reached, contents)


def _in_motion(job: Job, target: float | None) -> Measured:
    found, runs = measured_motion_budget(job)
    terminal.print_budget(found, job.case.name)
    content = found.to_dict()
    if target is not None:
        fastest = fastest_motion(job, runs, target)
        content["fastest"] = fastest.to_dict()
        terminal.print_fastest(fastest)
    contents = {"motion-budget.json": content}
    return Measured(runs["base"], None, True, contents, runs)
