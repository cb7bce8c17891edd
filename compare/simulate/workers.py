"""Worker processes: they start, or an error says why not, and end with their leader."""

import os
from collections.abc import Callable, Hashable, Iterator, Mapping
from concurrent.futures import BrokenExecutor, ThreadPoolExecutor
from contextlib import contextmanager
from multiprocessing import current_process, get_all_start_methods, get_context, parent_process
from threading import Thread
from typing import Any, TypeVar

from pebble import ProcessExpired, ProcessFuture, ProcessPool

from analytic import InputError

SWEEPERS = ("mujoco_models.sweep.sweep", "mujoco_models.simulate")
"""What workers that sweep in MuJoCo share."""
_START = 120.0  # s; a worker is there within one or two, on a crowded machine within ten

T = TypeVar("T")
K = TypeVar("K", bound=Hashable)


def available_cores() -> int:
    if hasattr(os, "sched_getaffinity"):  # not on macOS, nor on Windows
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class Workers:
    """A pool whose processes end as soon as their leader does, however that ends.

    A worker that dies, or is ended since its time is up, costs its own task and no other.
    """

    def __init__(self, count: int, preload: tuple[str, ...] = ()) -> None:
        if getattr(current_process(), "_inheriting", False):
            # A worker reads its leader's script first, and that would start workers without end.
            raise SystemExit(1)
        server = preload and _has_server()
        if server:
            start_server(preload)
        context = get_context("forkserver" if server else "spawn")
        self._pool = ProcessPool(count, initializer=_end_with_leader, context=context)
        try:
            # In a thread, which no interrupt meets: of a pool half made nobody would end the rest.
            with _nothing_from_here(), ThreadPoolExecutor(1) as starter:
                starter.submit(self.submit, os.getpid).result().result(_START)
        except (BrokenExecutor, ProcessExpired, OSError, TimeoutError) as error:
            self.end()
            reason = " ".join(str(error).split()) or type(error).__name__
            raise InputError(
                "workers", count, "processes that can be started here",
                f"the first one did not start ({reason}): put what a script calls below"
                ' `if __name__ == "__main__":`, or free memory or processes',
            ) from error  # fmt: skip
        except BaseException:
            self.end()
            raise

    def submit(
        self, function: Callable[..., T], *args: object, timeout: float | None = None
    ) -> ProcessFuture[T]:
        """Let a worker do something; after the time limit it is ended."""
        return self._pool.schedule(function, args, timeout=timeout)

    def end(self) -> None:
        """End the processes, whatever they are doing."""
        self._pool.stop()  # type: ignore[no-untyped-call]
        self._pool.join()

    def __enter__(self) -> "Workers":
        return self

    def __exit__(self, kind: type[BaseException] | None, *_: object) -> None:
        if kind is None:
            self._pool.close()  # type: ignore[no-untyped-call]
            self._pool.join()
        else:
            self.end()


def start_server(preload: tuple[str, ...]) -> None:
    """Let a server import what its workers share, while their leader goes on.

    Does nothing where there is no such server, or if it runs already.
    """
    if _has_server():
        from multiprocessing import forkserver

        forkserver.set_forkserver_preload(list(preload))
        with _nothing_from_here():
            forkserver.ensure_running()


def _has_server() -> bool:
    return "forkserver" in get_all_start_methods()


@contextmanager
def running(
    tasks: Mapping[K, tuple[Any, ...]], advance: Callable[[], None], preload: tuple[str, ...] = ()
) -> Iterator[Mapping[K, ProcessFuture[Any]]]:
    """Tasks that workers do while their leader goes on, each a function and what it takes.

    `advance` is called after each.
    """
    with Workers(min(len(tasks), available_cores()), preload) as pool:
        found = {name: pool.submit(*task) for name, task in tasks.items()}
        for one in found.values():
            one.add_done_callback(lambda _: advance())
        try:
            yield found
        except BrokenExecutor as error:
            raise MemoryError("the system ended a worker process") from error


@contextmanager
def _nothing_from_here() -> Iterator[None]:
    """Let a server that starts meanwhile import no module of the folder that it starts in.

    It would take a user's ``compare.py`` there for ours; the workers' own path is their leader's.
    """
    before = os.environ.get("PYTHONSAFEPATH")
    os.environ["PYTHONSAFEPATH"] = "1"
    try:
        yield
    finally:
        if before is None:
            del os.environ["PYTHONSAFEPATH"]
        else:
            os.environ["PYTHONSAFEPATH"] = before


def _end_with_leader() -> None:
    """Watch the leader; what the worker is doing when that ends is not wanted any more."""
    leader = parent_process()

    def watch() -> None:
        if leader is not None:
            leader.join()
            os._exit(1)

    Thread(target=watch, daemon=True).start()
