"""Runs done by a crew, a few ahead of those that are collected; and what they will take."""

from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from itertools import islice
from statistics import mean
from typing import TypeAlias

from compare.study.grid.plan import Plan, PlannedRun
from compare.study.grid.study import Study
from compare.study.work.perform import Outcome, Result, lost, perform

Task: TypeAlias = Callable[[Study, tuple[PlannedRun, ...]], list[Result]]
_BATCH = 32  # runs in closed form: a tenth of a second of work, and done singly if they fail
_PROBES = 3  # runs that are done to see how long one takes
_BYTES_A_ROW = 1500  # in both files
_BYTES_A_STATION = 100  # of kept readings, in either engine


@dataclass(frozen=True)
class Crew:
    """Who does the runs."""

    submit: Callable[[Task, Study, tuple[PlannedRun, ...]], Future[list[Result]]]
    task: Task  # what a worker does with some runs
    ahead: int  # how many tasks are handed out at once; memory is that of so many
    # Outcome and reason of an exception that is not the run's own; or it raises.
    ending: Callable[[BaseException, Study], tuple[Outcome, str]]
    end: Callable[[], None]


def carry_out(runs: Iterable[PlannedRun], study: Study, crew: Crew) -> Generator[Result]:
    """Do runs. One that costs its worker is tried once more, alone."""
    batch = 1 if study.beams else _BATCH
    fresh, again = iter(runs), deque[PlannedRun]()
    suspects: set[str] = set()
    under_way: dict[Future[list[Result]], tuple[PlannedRun, ...]] = {}

    def start() -> bool:
        some = (again.popleft(),) if again else tuple(islice(fresh, batch))
        if some:
            under_way[crew.submit(crew.task, study, some)] = some
        return bool(some)

    try:
        while True:
            while len(under_way) < crew.ahead and start():
                pass
            if not under_way:
                return
            for future in wait(under_way, return_when=FIRST_COMPLETED)[0]:
                some = under_way.pop(future)
                try:
                    results = future.result()
                except BaseException as error:
                    outcome, reason = crew.ending(error, study)
                else:
                    yield from results
                    continue
                for run in some:
                    if len(some) > 1 or (outcome == "failed" and run.id not in suspects):
                        suspects.add(run.id)
                        again.append(run)
                    else:
                        yield lost(run, outcome, reason)
    finally:
        for future in under_way:
            future.cancel()
        crew.end()


def estimate(plan: Plan, workers: int) -> str:
    """Estimate a study's time and size; a few runs, spread over the plan, are timed."""
    study = plan.study
    last = len(plan) - 1
    probes = sorted({round(i * last / (_PROBES - 1)) for i in range(_PROBES)})
    rows = [perform(study, plan[index]).row for index in probes]
    seconds = mean(row["seconds"] for row in rows) * len(plan) / workers
    stations = (
        study.base["path.stations" if study.in_space else "sweep.stations"]
        if study.keep_readings
        else 0
    )
    size = len(plan) * (_BYTES_A_ROW + 2 * stations * _BYTES_A_STATION)
    trouble = sum(row["outcome"] != "done" for row in rows)
    return (
        f"{len(plan)} runs, about {_time(seconds)} on {workers} workers and {size / 1e6:.3g} MB; "
        f"{len(rows)} runs tried, {trouble} of them not done"
        + next((f" ({row['reason']})" for row in rows if row["reason"]), "")
    )


def _time(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.2g} s"
    return f"{seconds / 60:.0f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"
