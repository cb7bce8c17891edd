"""The crews that there are: the cores of this machine, or a Dask cluster."""

import logging
import os
from concurrent.futures import Future
from typing import Any

from pebble import ProcessExpired

from analytic import InputError
from compare.simulate.workers import Workers
from compare.study.grid.plan import PlannedRun
from compare.study.grid.study import Study
from compare.study.work.execute import Crew, Task
from compare.study.work.perform import Outcome, Result, perform_all, perform_alone

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

# What they log when the scheduler goes, this module says in a line. Dask gives the client's logger
# a level of its own; the others take that of their parent.
_CHATTY = ("distributed", "distributed.client", "tornado.application", "asyncio")


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
    """Hire the workers of a Dask cluster."""
    try:
        from distributed import Client, KilledWorker
    except ImportError as error:
        raise InputError(
            "--scheduler", address, "left out without Dask", "pip install 'vibrissa-testbed[dask]'"
        ) from error
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
        raise InputError(
            "--scheduler", address, "that of a cluster with workers", "start some: `dask worker`"
        )

    executor = client.get_executor(pure=False)

    def ending(error: BaseException, study: Study) -> tuple[Outcome, str]:
        if isinstance(error, KilledWorker):
            return "failed", "its workers died, one after the other"
        raise _gone(address) from error

    def end() -> None:
        executor.shutdown(wait=False)

    task = perform_alone if max(threads.values()) == 1 else perform_all
    return Crew(executor.submit, task, 4 * sum(threads.values()), ending, end)


def _gone(address: str) -> InputError:
    return InputError(
        "--scheduler",
        address,
        "that of a Dask scheduler that can be reached",
        "start it and the study again: complete runs are kept",
    )
