"""Several engines on one case: ``run --engine A,B``."""

from collections.abc import Sequence
from pathlib import Path

from analytic import InputError, Readings
from compare.commands import terminal
from compare.commands.measured_budgets import measured_budget
from compare.commands.options import AGREES, DISAGREES
from compare.read.job import Job
from compare.read.runs import EngineOutcome
from compare.show.engines import ManyEngines, write_engines
from compare.simulate.many import sweep_many
from engines import Outcome, list_engines


def run_many(job: Job, exact: Readings, folder: Path, with_budget: bool) -> int:
    """Sweep a case with the engines of its job, and write one report of all."""
    outcomes = swept(job, folder)
    sweeps = {one.engine: one.readings for one in outcomes if one.readings is not None}
    budget = None
    if with_budget and "mujoco" in sweeps:
        budget, _ = measured_budget(job)
    many = ManyEngines.of(job.case, exact, _rows(outcomes), sweeps, budget)
    terminal.print_engines(many)
    for path in write_engines(many, folder):
        terminal.print_written(path)
    return AGREES if many.agree else DISAGREES


def swept(job: Job, folder: Path) -> Sequence[Outcome]:
    """The sweeps of a job's engines, each written to ``ENGINE.parquet``."""
    with terminal.progress("engines", len(job.engines)) as advance:

        def keep(one: Outcome) -> None:
            if one.readings is not None:
                one.readings.write(folder / f"{one.engine}.parquet")
            advance()

        found = sweep_many(job.case, job.settings, job.engines, job.timeout, keep)
    for one in found:
        if one.readings is None:
            terminal.print_line(f"{one.engine}: {one.trouble}")
    if all(one.readings is None for one in found):
        raise InputError(
            "engine", ", ".join(job.engines), "one that sweeps the case",
            f"{found[0].engine}: {found[0].trouble}",
        )  # fmt: skip
    return found


def _rows(outcomes: Sequence[Outcome]) -> list[EngineOutcome]:
    known = {found.name: found for found in list_engines()}
    rows = []
    for one in outcomes:
        found = known[one.engine]
        role, tuned = ("", "") if found.engine is None else (found.engine.role, found.engine.tuned)
        version = found.version or "none"
        rows.append(EngineOutcome(one.engine, role, version, tuned, one.trouble))
    return rows
