"""The crews that there are: the cores of this machine, or a Dask cluster."""

import logging
import os
import signal
from concurrent.futures import Executor, ProcessPoolExecutor
from multiprocessing import get_context, parent_process
from threading import Thread
from typing import Any, NoReturn

from analytic import InputError
from compare.study.work.execute import Crew
from compare.study.work.run import perform, perform_alone

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

# What they log when the scheduler goes, this module tells in a line.
_CHATTY = ("distributed.client", "distributed.core", "tornado.application", "asyncio")


def local_crew(workers: int) -> Crew:
    """Processes on this machine, each with one thread.

    They are forked from a server that has imported everything once, so a worker is there in no
    time, and its memory is shared.
    """
    os.environ |= dict.fromkeys(_THREADS, "1")  # read by the libraries when they are imported
    context = get_context("forkserver")
    context.set_forkserver_preload(["compare.study.work.run"])

    def hire() -> Executor:
        return ProcessPoolExecutor(workers, context, _begin_work)

    return Crew(hire, perform_alone, 2 * workers + 1, _unexpected)


def dask_crew(address: str) -> Crew:
    """The workers of the Dask cluster whose scheduler is at `address`.

    Raises
    ------
    InputError
        If Dask is not installed, there is no scheduler, or it has no workers.
    """
    try:
        from distributed import Client, KilledWorker
    except ImportError as error:
        raise InputError(
            "--scheduler", address, "left out without Dask", "pip install 'vibrissa-testbed[dask]'"
        ) from error
    for name in _CHATTY:
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client: Any = Client(address, timeout=10)  # type: ignore[no-untyped-call]
        threads = client.nthreads()
    except (OSError, ValueError) as error:
        raise _gone(address) from error
    if not threads:
        raise InputError(
            "--scheduler", address, "that of a cluster with workers", "start some: `dask worker`"
        )

    def failure(error: BaseException) -> str:
        if isinstance(error, KilledWorker):
            return "its workers died, one after the other"
        raise _gone(address) from error

    single = max(threads.values()) == 1
    return Crew(
        lambda: client.get_executor(pure=False),
        perform_alone if single else perform,
        4 * sum(threads.values()),
        failure,
    )


def _begin_work() -> None:
    """Before a worker's first run: Ctrl-C is the leader's affair, and no worker outlives it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_end_with_leader, daemon=True).start()


def _end_with_leader() -> NoReturn:
    leader = parent_process()
    assert leader is not None
    leader.join()
    os._exit(1)


def _unexpected(error: BaseException) -> str:
    raise error


def _gone(address: str) -> InputError:
    return InputError(
        "--scheduler",
        address,
        "that of a Dask scheduler that can be reached",
        "start it and the study again: complete runs are kept",
    )
