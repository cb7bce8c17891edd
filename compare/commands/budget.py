"""What a disagreement is made of: ``run --budget``, at rest, in motion and in space."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from analytic import Readings
from analytic.problem.errors import require
from compare.commands import terminal
from compare.commands.sweeping import AnyReadings
from compare.explain.budget import Budget
from compare.explain.parts import Parted
from compare.read.job import AnyJob, Job, SpaceJob
from compare.show.budgets import budget_summary
from compare.show.document import Text
from compare.simulate.budgets import measure_budget, require_rest
from compare.simulate.dispatch import simulate
from compare.simulate.target import NAIVE, Fastest, Followed, find_fastest, follow_advice
from mujoco_models.motion import Motion

_SWEEPS = "sweeps of the budget"


@dataclass(frozen=True)
class Measured:
    """MuJoCo's sweep, and its budget if that was measured and printed."""

    base: AnyReadings
    budget: Parted | None = None  # what the report shows; nothing in motion
    reached: bool = True  # the target at rest, if there is one
    contents: Mapping[str, Any] = field(default_factory=dict)  # of files, by name
    runs: Mapping[str, Readings] = field(default_factory=dict)  # that are kept

    def write(self, folder: Path) -> None:
        """Write what the report does not."""
        for name, readings in self.runs.items():
            readings.write(folder / f"{name}.parquet")
        for name, content in self.contents.items():
            terminal.keep(folder / name, content)


def measured(job: AnyJob, target: float | None) -> Measured:
    """Measure and print the budget of a job, and what to do for a wanted error."""
    if isinstance(job, SpaceJob):
        require_rest(job.motion)
        with terminal.progress(_SWEEPS) as advance:
            found, swept = measure_budget(job.case, job.settings, advance)
        _print(job, *budget_summary(found))
        return Measured(swept["base"], found)
    return _at_rest(job, target) if job.motion is None else _in_motion(job, job.motion, target)


def budget_at_rest(job: Job) -> tuple[Budget, Mapping[str, Readings]]:
    with terminal.progress(_SWEEPS) as advance:
        return measure_budget(job.case, job.settings, advance)


def _at_rest(job: Job, target: float | None) -> Measured:
    found, runs = budget_at_rest(job)
    _print(job, *budget_summary(found))
    if target is None:
        return Measured(runs["base"], found)
    advice = follow_advice(job.case, found, runs, target)
    terminal.show(*map(Text, _advised(advice)))
    contents = {"budget.json": {**found.to_dict(), "advice": advice.to_dict()}}
    return Measured(runs["base"], found, reached=advice.reached, contents=contents)


def _in_motion(job: Job, motion: Motion, target: float | None) -> Measured:
    with terminal.progress(_SWEEPS) as advance:
        found, runs = measure_budget(
            job.case, job.settings, advance, motion=motion, model=job.model
        )
    _print(job, *budget_summary(found))
    content = found.to_dict()
    if target is not None:
        fastest = _fastest(job, motion, runs, target)
        content["fastest"] = fastest
        tried = ", ".join(f"{v:.3g}: {error:.1e}" for v, error in fastest.tried.items())
        terminal.print_line(
            f"Fastest for {target:g}: {fastest.speed:.3g} L/T1, {fastest.error:.1e} rms, "
            f"{fastest.seconds:.1f} s; {fastest.at_rest:.1e} is left at rest."
        )
        terminal.print_line(f"  {tried}")
    return Measured(runs["base"], contents={"motion-budget.json": content}, runs=runs)


def _fastest(job: Job, motion: Motion, runs: Mapping[str, Readings], target: float) -> Fastest:
    if job.model is None and motion.solref is None:
        motion = replace(motion, contact_stiffness=motion.stiffness)

    def move(speed: float) -> Readings:
        other = replace(motion, speed=speed)
        with terminal.progress(f"{speed:.3g} L/T1", job.stations) as advance:
            moved = simulate(job.case, job.settings, other, job.model, advance=advance)
            return require("readings", moved, Readings, "in the plane")

    return find_fastest(job.solve(), runs, move, target)


def _print(job: AnyJob, *summary: Any) -> None:  # noqa: ANN401
    terminal.show(Text("", strong=f"Budget of {job.case.name}"), *summary)


def _advised(advice: Followed) -> list[str]:
    """The advised settings, with what was predicted and measured of them."""
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
