"""What a disagreement is made of: ``run --budget``, at rest, in motion and in space."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from analytic import Readings
from analytic.problem.errors import require
from compare.commands import terminal
from compare.commands.sweeping import AnyReadings
from compare.explain.parts import Parted
from compare.read.job import AnyJob, Job
from compare.show.budgets import budget_summary
from compare.show.document import Text
from compare.simulate.budgets import measure_budget
from compare.simulate.dispatch import simulate
from compare.simulate.target import NAIVE, Fastest, Followed, find_fastest, follow_advice


@dataclass(frozen=True)
class Measured:
    """MuJoCo's sweep, and its budget if that was measured and printed."""

    base: AnyReadings
    budget: Parted | None = None  # what the report shows; nothing in motion
    reached: bool = True  # the target at rest, if there is one
    contents: Mapping[str, Any] = field(default_factory=dict)  # of files, by name
    runs: Mapping[str, Readings] = field(default_factory=dict)  # that are kept

    def write(self, folder: Path) -> None:
        for name, readings in self.runs.items():
            readings.write(folder / f"{name}.parquet")
        for name, content in self.contents.items():
            terminal.keep(folder / name, content)


def budget_of(job: AnyJob) -> tuple[Any, Mapping[str, Any]]:
    measure: Callable[..., tuple[Any, Mapping[str, Any]]] = measure_budget
    with terminal.progress("sweeps of the budget") as advance:
        return measure(job.case, job.settings, advance, motion=job.motion, model=job.model)


def measured(job: AnyJob, target: float | None) -> Measured:
    """Measure and print the budget of a job, and what to do for a wanted error."""
    found, runs = budget_of(job)
    base = runs["base"]
    terminal.show(Text("", strong=f"Budget of {job.case.name}"), *budget_summary(found))
    if isinstance(job, Job) and job.motion is not None:
        content = found.to_dict()
        if target is not None:
            content["fastest"] = one = _fastest(job, runs, target)
            terminal.print_line(
                f"Fastest for {target:g}: {one.speed:.3g} L/T1, {one.error:.1e} rms, "
                f"{one.seconds:.1f} s; {one.at_rest:.1e} is left at rest."
            )
            tried = (f"{v:.3g}: {error:.1e}" for v, error in one.tried.items())
            terminal.print_line(f"  {', '.join(tried)}")
        return Measured(base, contents={"motion-budget.json": content}, runs=runs)
    if target is None or not isinstance(job, Job):
        return Measured(base, found)
    advice = follow_advice(job.case, found, runs, target)
    terminal.show(*map(Text, _advised(advice)))
    contents = {"budget.json": {**found.to_dict(), "advice": advice.to_dict()}}
    return Measured(base, found, advice.reached, contents)


def _fastest(job: Job, runs: Mapping[str, Readings], target: float) -> Fastest:
    motion: Any = job.motion
    if job.model is None and motion.solref is None:
        motion = replace(motion, contact_stiffness=motion.stiffness)

    def move(speed: float) -> Readings:
        other = replace(motion, speed=speed)
        with terminal.progress(f"{speed:.3g} L/T1", job.stations) as advance:
            moved = simulate(job.case, job.settings, other, job.model, advance=advance)
            return require("readings", moved, Readings, "in the plane")

    return find_fastest(job.solve(), runs, move, target)


def _advised(advice: Followed) -> list[str]:
    settings, took = advice.settings, 1e3 * advice.seconds_a_station
    mesh = f" of {settings.contour_points} points" if settings.obstacle == "mesh" else ""
    said = [
        f"Coarsest for {advice.target:g}: {settings.beam} of {settings.segments} segments, "
        f"{settings.obstacle}{mesh}, contact stiffness {settings.contact_stiffness:.1e}.",
        f"  predicted: {advice.predicted:.1e} rms",
        f"  measured: {advice.error:.1e} rms, {took:.1f} ms a station",
    ]
    if settings.clamp == "naive":
        said.append(f"  For far fewer segments {NAIVE}.")
    if not advice.reached:
        said.append("  The target was missed: ask for a little less.")
    return said
