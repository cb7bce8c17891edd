"""How long a call takes."""

import resource
import time
from collections.abc import Callable


def least_seconds(call: Callable[[], object], repeats: int = 5) -> float:
    """The least CPU time of `repeats` calls after a first one [s]."""
    call()
    return min(cpu_seconds(call) for _ in range(repeats))


def cpu_seconds(call: Callable[[], object]) -> float:
    """CPU time of a call and of the processes that it has started and awaited [s]."""
    begin = _spent()
    call()
    return _spent() - begin


def _spent() -> float:
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + usage.ru_utime + usage.ru_stime
