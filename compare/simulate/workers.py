"""Worker processes: they start, or an error says why not, and end with their leader."""

import os
import signal
from collections.abc import Iterator
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing import current_process, get_all_start_methods, get_context
from multiprocessing.connection import Connection
from threading import Thread
from types import TracebackType
from typing import NoReturn

from analytic import InputError

SWEEPERS = ("mujoco_models.sweep.sweep", "mujoco_models.simulate")
"""What workers that sweep in MuJoCo share."""
_START = 120.0  # s; a worker is there within one or two, on a crowded machine within ten


def available_cores() -> int:
    """The number of cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):  # not on macOS, nor on Windows
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


class Workers(ProcessPoolExecutor):
    """A pool whose processes end as soon as their leader does, however that ends.

    Each holds one end of a pipe whose other end only the leader has: it closes when the leader lets
    go of it, is killed, or crashes. Ctrl-C is the leader's affair alone.
    """

    def __init__(self, count: int, preload: tuple[str, ...] = ()) -> None:
        if getattr(current_process(), "_inheriting", False):
            # A worker reads its leader's script first, and that would start workers without end.
            raise SystemExit(1)
        server = preload and _has_server()
        context = get_context("forkserver" if server else "spawn")
        if server:
            start_server(preload)
        self._watched, self._held = context.Pipe(duplex=False)
        super().__init__(count, context, _begin_work, (self._watched,))
        try:
            with _nothing_from_here():
                self.submit(os.getpid).result(timeout=_START)
        except (BrokenExecutor, OSError, TimeoutError) as error:
            self.shutdown(wait=False, cancel_futures=True)
            reason = " ".join(str(error).split()) or type(error).__name__
            raise InputError(
                "workers", count, "processes that can be started here",
                f"the first one did not start ({reason}): put what a script calls below"
                ' `if __name__ == "__main__":`, or free memory or processes',
            ) from error  # fmt: skip
        except BaseException:
            self.shutdown(wait=False, cancel_futures=True)
            raise

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """End the processes."""
        if not wait:
            self._held.close()
        super().shutdown(wait=wait, cancel_futures=cancel_futures)
        self._held.close()

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.shutdown(wait=error is None, cancel_futures=error is not None)


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


def _begin_work(watched: Connection) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    Thread(target=_end_with_leader, args=(watched,), daemon=True).start()


def _end_with_leader(watched: Connection) -> NoReturn:
    with suppress(EOFError, OSError):
        watched.recv_bytes()  # nothing is ever sent
    os._exit(1)
