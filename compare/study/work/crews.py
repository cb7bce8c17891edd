"""The crews that there are: the cores of this machine, or a Dask cluster."""

import logging
import os
from typing import Any

from analytic import InputError
from compare.simulate.workers import Workers
from compare.study.work.execute import Crew
from compare.study.work.perform import perform, perform_alone, perform_together

_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")

# What they log when the scheduler goes, this module says in a line. Dask gives the client's logger
# a level of its own; the others take that of their parent.
_CHATTY = ("distributed", "distributed.client", "tornado.application", "asyncio")


def local_crew(workers: int) -> Crew:
    """Hire processes on this machine, each with one thread."""
    os.environ |= dict.fromkeys(_THREADS, "1")  # read by the libraries when they are imported
    preload = ("compare.study.work.perform",)
    return Crew(
        lambda: Workers(workers, preload),
        perform_alone,
        2 * workers + 1,
        _unexpected,
        perform_together,
    )


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
        perform_together if single else None,
    )


def _unexpected(error: BaseException) -> str:
    raise error


def _gone(address: str) -> InputError:
    return InputError(
        "--scheduler",
        address,
        "that of a Dask scheduler that can be reached",
        "start it and the study again: complete runs are kept",
    )
