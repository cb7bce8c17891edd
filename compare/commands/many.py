"""Several engines on one case: ``run --engine A,B``."""

from collections.abc import Sequence
from pathlib import Path

from analytic import InputError, Readings
from compare.commands import terminal
from compare.commands.budget import budget_at_rest
from compare.commands.sweeping import AnyReadings, printed
from compare.read.job import Job
from compare.read.runs import EngineOutcome
from compare.show.engines import ManyEngines, outcomes_table, parts_table, write_engines
from engines import Outcome, list_engines
from engines.apart import sweep_apart


def swept_by_engines(job: Job, exact: AnyReadings | None, folder: Path, with_budget: bool) -> bool:
    """Sweep a case with the engines of its job, and write one report of all; whether all agree."""
    outcomes = _swept(job, folder)
    sweeps = {one.engine: one.readings for one in outcomes if one.readings is not None}
    if not isinstance(exact, Readings):
        return all(printed(job, x, folder, f"{name}.parquet") for name, x in sweeps.items())
    budget = budget_at_rest(job)[0] if with_budget and "mujoco" in sweeps else None
    many = ManyEngines.of(job.case, exact, _rows(outcomes), sweeps, budget)
    terminal.show(outcomes_table({many.case.name: many.outcomes}))
    if many.parts():
        terminal.show(parts_table({many.case.name: many.parts()}))
    if many.split is not None:
        terminal.print_line(many.split.sentence)
    for path in write_engines(many, folder):
        terminal.print_written(path)
    return many.agree


def _swept(job: Job, folder: Path) -> Sequence[Outcome]:
    """The sweeps of a job's engines, each written to ``ENGINE.parquet``.

    One after the other: times are compared, and a machine with few cores would lend them unequally.
    """
    found = []
    with terminal.progress("engines", len(job.engines)) as advance:
        for name in job.engines:
            found.append(sweep_apart(name, job.case, job.settings, job.timeout))
            if found[-1].readings is not None:
                found[-1].readings.write(folder / f"{name}.parquet")
            advance()
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
