"""Runs done by any executor, a few ahead of those that are collected."""

from collections.abc import Callable, Generator, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Executor, Future, wait
from dataclasses import dataclass
from itertools import islice
from time import perf_counter
from typing import TypeAlias

from compare.study.grid.plan import PlannedRun
from compare.study.work.perform import Result, lost
from compare.study.work.recipe import Recipe

Perform: TypeAlias = Callable[[Recipe, PlannedRun], Result]
Together: TypeAlias = Callable[[Recipe, Sequence[PlannedRun]], list[Result]]
_BATCH = 32  # runs in closed form: a tenth of a second of work, and lost if its worker dies


@dataclass(frozen=True)
class Crew:
    """Who does the runs."""

    hire: Callable[[], Executor]  # makes an executor; called again if its workers died
    perform: Perform  # what a worker does with a run
    ahead: int  # how many runs are handed out at once. Memory is that of so many
    # What to make of an exception that is not the run's own: the row's reason, or it raises.
    failure: Callable[[BaseException], str]
    # What a worker does with some runs in closed form at once; one by one if not given.
    together: Together | None = None


def carry_out(runs: Iterable[PlannedRun], recipe: Recipe, crew: Crew) -> Generator[Result]:
    """Do runs."""
    waiting = iter(runs)
    executor = crew.hire()
    under_way: dict[Future[list[Result]], tuple[PlannedRun, ...]] = {}
    batch = 1 if recipe.simulate or crew.together is None else _BATCH
    task = _Task(crew.perform, crew.together if batch > 1 else None)
    try:
        while True:
            suspects: list[PlannedRun] = []
            try:
                while len(under_way) < crew.ahead and (runs := tuple(islice(waiting, batch))):
                    suspects = [*runs]
                    under_way[executor.submit(task, recipe, runs)] = runs
                    suspects = []
                if not under_way:
                    return
                yield from _collect(under_way, crew)
            except BrokenExecutor:
                suspects += [run for runs in under_way.values() for run in runs]
                under_way.clear()
                executor.shutdown()
                for run in suspects:
                    yield _alone(run, recipe, crew)
                executor = crew.hire()
    finally:
        for future in under_way:
            future.cancel()
        executor.shutdown(wait=False)


@dataclass(frozen=True)
class _Task:
    """What is sent to a worker: runs at once, or the only one."""

    perform: Perform
    together: Together | None

    def __call__(self, recipe: Recipe, runs: tuple[PlannedRun, ...]) -> list[Result]:
        if self.together is not None:
            return self.together(recipe, runs)
        return [self.perform(recipe, run) for run in runs]


def _collect(
    under_way: dict[Future[list[Result]], tuple[PlannedRun, ...]], crew: Crew
) -> Iterator[Result]:
    """The results that are there, at least one; they leave `under_way`."""
    finished, _ = wait(under_way, return_when=FIRST_COMPLETED)
    broken: BrokenExecutor | None = None
    for future in finished:
        try:
            results = future.result()
        except BrokenExecutor as error:
            broken = error  # but others may have finished before
            continue
        except BaseException as error:
            reason = crew.failure(error)
            results = [lost(run, "failed", reason) for run in under_way[future]]
        del under_way[future]
        yield from results
    if broken is not None:
        raise broken


def _alone(run: PlannedRun, recipe: Recipe, crew: Crew) -> Result:
    begin = perf_counter()
    with crew.hire() as executor:
        try:
            return executor.submit(crew.perform, recipe, run).result()
        except BrokenExecutor:
            if perf_counter() - begin > recipe.timeout:
                return lost(run, "timeout", f"stuck for {recipe.timeout:g} s; its worker was ended")
            return lost(run, "failed", "its worker process died, twice")
