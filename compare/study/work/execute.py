"""Runs done by a crew, the cores of this machine or a Dask cluster; and what they will take."""

import logging
import os
from collections import deque
from collections.abc import Callable, Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from functools import partial
from itertools import islice
from statistics import mean
from typing import Any, TypeAlias

from pebble import ProcessExpired

from analytic import InputError
from compare.simulate.workers import Workers
from compare.study.grid.plan import Plan, PlannedRun
from compare.study.grid.study import Study
from compare.study.work.perform import Outcome, Result, lost, perform, perform_all, perform_alone

Task: TypeAlias = Callable[[Study, tuple[PlannedRun, ...]], list[Result]]
_BATCH = 32  # runs in closed form: a tenth of a second of work, and done singly if they fail
_PROBES = 3  # runs that are done to see how long one takes
_BYTES_A_ROW = 1500  # in both files
_BYTES_A_STATION = 100  # of kept readings, in either engine
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

# What they log when the scheduler goes, this module says in a line. Dask gives the client's logger
# a level of its own; the others take that of their parent.
_CHATTY = ("distributed", "distributed.client", "tornado.application", "asyncio")


@dataclass(frozen=True)
class Crew:
    submit: Callable[[Task, Study, tuple[PlannedRun, ...]], Future[list[Result]]]
    task: Task  # what a worker does with some runs
    ahead: int  # how many tasks are handed out at once; memory is that of so many
    # Outcome and reason of an exception that is not the run's own; or it raises.
    ending: Callable[[BaseException, Study], tuple[Outcome, str]]
    end: Callable[[], None]


def local_crew(workers: int) -> Crew:
    """Hire processes on this machine, each with one thread."""
    os.environ |= dict.fromkeys(_THREADS, "1")  # read by the libraries when they are imported
    pool = Workers(workers, ("compare.study.work.perform",))

    def submit(task: Task, study: Study, runs: tuple[PlannedRun, ...]) -> Future[list[Result]]:
        # The run itself asks the time between stations; a stuck one is ended with its worker.
        return pool.submit(task, study, runs, timeout=1.1 * study.timeout + 1)

    return Crew(submit, perform_all, 2 * workers + 1, _local_ending, pool.end)


def _local_ending(error: BaseException, study: Study) -> tuple[Outcome, str]:
    if isinstance(error, TimeoutError):
        return "timeout", f"stuck for {study.timeout:g} s; its worker was ended"
    if isinstance(error, ProcessExpired):
        return "failed", "its worker process died, twice"
    raise error


def dask_crew(address: str) -> Crew:
    try:
        from distributed import Client, KilledWorker
    except ImportError as error:
        remedy = "pip install 'vibrissa-testbed[dask]'"
        raise InputError("--scheduler", address, "left out without Dask", remedy) from error
    for name in _CHATTY:
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        if not address:  # Dask would start a cluster of its own
            raise ValueError("no address")
        client: Any = Client(address, timeout=10)  # type: ignore[no-untyped-call]
        threads = client.nthreads()
    except (OSError, ValueError) as error:
        raise _gone(address) from error
    if not threads:
        allowed = "that of a cluster with workers"
        raise InputError("--scheduler", address, allowed, "start some: `dask worker`")
    executor = client.get_executor(pure=False)

    def ending(error: BaseException, study: Study) -> tuple[Outcome, str]:
        if isinstance(error, KilledWorker):
            return "failed", "its workers died, one after the other"
        raise _gone(address) from error

    task = perform_alone if max(threads.values()) == 1 else perform_all
    ahead, end = 4 * sum(threads.values()), partial(executor.shutdown, wait=False)
    return Crew(executor.submit, task, ahead, ending, end)


def _gone(address: str) -> InputError:
    allowed = "that of a Dask scheduler that can be reached"
    remedy = "start it and the study again: complete runs are kept"
    return InputError("--scheduler", address, allowed, remedy)


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
    study, last = plan.study, len(plan) - 1
    probes = sorted({round(i * last / (_PROBES - 1)) for i in range(_PROBES)})
    rows = [perform(study, plan[index]).row for index in probes]
    seconds = mean(row["seconds"] for row in rows) * len(plan) / workers
    of = "path.stations" if study.in_space else "sweep.stations"
    stations = study.base[of] if study.keep_readings else 0
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
