"""``vibrissa study`` and ``vibrissa study-report``."""

import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text

from compare.study.grid.file import load_study
from compare.study.grid.plan import Plan
from compare.study.keep.store import Store
from compare.study.show.study_report import write_report
from compare.study.work.crews import dask_crew, local_crew
from compare.study.work.estimate import estimate
from compare.study.work.execute import carry_out
from compare.study.work.run import Recipe

_told = Console(highlight=False)
_noted = Console(stderr=True, highlight=False)


def study(
    file: Annotated[
        str, typer.Argument(metavar="FILE", help="A TOML file, or the name of a shipped study.")
    ],
    dry_run: Annotated[
        bool, typer.Option("--dry-run", help="Check, count and estimate; store nothing.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option("--out", metavar="DIR", help="Folder of the study.")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(min=1, metavar="N", help="Processes; all cores by default.")
    ] = None,
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDR", help="Of a Dask cluster, as tcp://host:8786.")
    ] = None,
) -> int:
    """Do the runs of a study that are not done yet."""
    plan = Plan.of(load_study(file))
    cores = workers or len(os.sched_getaffinity(0))
    if dry_run:
        _told.print(estimate(plan, cores), soft_wrap=True, markup=False)
        return 0
    folder = out or Path("results") / plan.study.name
    counts: dict[str, int] = {}
    with Store(folder, plan, _warn) as store:
        done = store.done()
        todo = (run for run in plan if run.id not in done)
        count = sum(run.id not in done for run in plan)
        _told.print(f"{len(plan)} runs, {len(plan) - count} of them done already", markup=False)
        if count:
            crew = dask_crew(scheduler) if scheduler else local_crew(cores)
            with _progress(plan.study.name, count) as advance:
                for result in carry_out(todo, Recipe.of(plan.study), crew):
                    store.add(result)
                    counts[result.row["outcome"]] = counts.get(result.row["outcome"], 0) + 1
                    advance()
    said = ", ".join(f"{number} {outcome}" for outcome, number in sorted(counts.items()))
    _told.print(f"{said or 'nothing to do'}; in {folder}", soft_wrap=True, markup=False)
    return 0


def study_report(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Folder of a study.")],
) -> int:
    """Tables and figures of a study, also of one that is under way."""
    _told.print(f"wrote {write_report(folder, _warn)}", soft_wrap=True, markup=False)
    return 0


class _Rate(ProgressColumn):
    """Runs a second."""

    def render(self, task: Task) -> Text:
        return Text("" if task.speed is None else f"{task.speed:.3g} runs/s")


@contextmanager
def _progress(what: str, total: int) -> Iterator[Callable[[], None]]:
    """A bar with rate and remaining time on a terminal, nothing elsewhere."""
    shown = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), _Rate(),
             TimeRemainingColumn())  # fmt: skip
    with Progress(*shown, console=_noted, disable=not _noted.is_terminal, transient=True) as bar:
        task = bar.add_task(what, total=total)
        yield lambda: bar.advance(task)


def _warn(line: str) -> None:
    _noted.print(f"vibrissa: {line}", soft_wrap=True, markup=False)
