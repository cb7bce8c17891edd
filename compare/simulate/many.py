"""A case in several engines, one after the other, each in a process of its own."""

from collections.abc import Callable, Sequence

from analytic import Case
from engines.apart import TIMEOUT, Outcome, sweep_apart
from mujoco_models.settings import Settings


def sweep_many(
    case: Case,
    settings: Settings,
    names: Sequence[str],
    timeout: float = TIMEOUT,
    done: Callable[[Outcome], None] = lambda _: None,
) -> list[Outcome]:
    """Sweep a case with each of several engines.

    One after the other: times are compared, and a machine with few cores would lend them unequally.
    """
    found = []
    for name in names:
        found.append(sweep_apart(name, case, settings, timeout))
        done(found[-1])
    return found
