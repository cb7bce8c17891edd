"""Runs done by a crew, a few ahead of those that are collected."""

from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from itertools import islice
from typing import TypeAlias

from compare.study.grid.plan import PlannedRun
from compare.study.grid.study import Study
from compare.study.work.perform import Outcome, Result, lost

Task: TypeAlias = Callable[[Study, tuple[PlannedRun, ...]], list[Result]]
_BATCH = 32  # runs in closed form: a tenth of a second of work, and done singly if they fail


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
