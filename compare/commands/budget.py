"""What a disagreement is made of: ``run --budget``, at rest, in motion and in space."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from analytic import Readings
from compare.commands import terminal
from compare.commands.keep import keep
from compare.commands.pipeline import AnyBudget, AnyReadings
from compare.explain.budget import Budget
from compare.explain.split_space import Parts
from compare.read.job import AnyJob, Job
from compare.show.report import budget_files
from compare.simulate.budgets import measure_budget, sweeps_of_budget
from compare.simulate.dispatch import simulate
from compare.simulate.fastest import Fastest, find_fastest
from compare.simulate.target import follow_advice
from mujoco_models.motion import Motion


@dataclass(frozen=True)
class Measured:
    """A budget that was measured, printed, and is to be kept."""

    base: AnyReadings  # MuJoCo's sweep that it is of
    on_page: Budget | Parts | None = None  # what the report shows; nothing in motion
    reached: bool = True  # the target at rest, if there is one
    contents: Mapping[str, Any] = field(default_factory=dict)  # of files, by name
    runs: Mapping[str, AnyReadings] = field(default_factory=dict)  # that are kept

    def write(self, folder: Path) -> None:
        """Write what the report does not."""
        for name, readings in self.runs.items():
            readings.write(folder / f"{name}.parquet")
        for name, content in self.contents.items():
            keep(folder / name, content)


def sweeps_and_budget(job: AnyJob) -> tuple[AnyBudget, Mapping[str, Any]]:
    """The budget of a job, and its sweeps."""
    count = sweeps_of_budget(job.settings, job.motion, job.model)
    with terminal.progress("sweeps of the budget", count) as advance:
        return measure_budget(job.case, job.settings, advance, motion=job.motion, model=job.model)


def measured(job: AnyJob, target: float | None) -> Measured:
    """Measure and print the budget of a job, and what to do for a wanted error."""
    found, runs = sweeps_and_budget(job)
    base = runs["base"]
    if not isinstance(job, Job):  # printed with the verdict
        return Measured(base, found)
    if job.motion is not None:
        terminal.print_budget(found, job.case.name)
        content = found.to_dict()
        if target is not None:
            fastest = _fastest(job, runs, target)
            content["fastest"] = fastest.to_dict()
            terminal.print_fastest(fastest)
        return Measured(base, contents={"motion-budget.json": content}, runs=runs)
    terminal.print_budget(found, job.case.name)
    if target is None:
        return Measured(base, found)
    advice = follow_advice(job.case, found, runs, target)
    terminal.print_advice(advice)
    contents = {"budget.json": budget_files(found, advice.to_dict())["budget.json"]}
    return Measured(base, found, advice.reached, contents)


def _fastest(job: Job, runs: Mapping[str, Readings], target: float) -> Fastest:
    """The fastest motion of a job with a wanted error."""
    motion = job.motion or Motion()
    if job.model is None and motion.solref is None:
        motion = replace(motion, contact_stiffness=motion.stiffness)

    def move(speed: float) -> Readings:
        other = replace(motion, speed=speed)
        with terminal.progress(f"{speed:.3g} L/T1", job.stations) as advance:
            return simulate(job.case, job.settings, other, job.model, advance=advance)

    return find_fastest(job.solve(), runs, move, target)
