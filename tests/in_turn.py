"""A pool without processes, for tests of what sweeps come to and not of where they run.

To start a worker takes as long as hundreds of stations. That the real pool hands on what its
workers return and raise is tested by `tests/compare/simulate/test_workers.py`; the commands of the
pages and of the wheel use it as users do.
"""

from concurrent.futures import Executor, Future


class InTurn(Executor):
    """Does in this process, one after the other, what it is given."""

    def __init__(self, count: int, preload: tuple[str, ...] = ()) -> None:
        assert count >= 1

    def submit(self, act, /, *args, **kwargs) -> Future:
        done = Future()
        try:
            done.set_result(act(*args, **kwargs))
        except Exception as error:
            done.set_exception(error)
        return done
