"""From station to station of a sweep at rest, and its readings, also if it ends early."""

from collections.abc import Callable, Iterable
from importlib.metadata import version
from typing import Any

import mujoco

from analytic.problem.recorder import DIVERGED, AnyRecorder, Kept
from mujoco_models.errors import DivergedError


def engine() -> str:
    """What provenance says of who computes."""
    return f"MuJoCo {mujoco.__version__}, vibrissa-testbed {version('vibrissa-testbed')}"


def visit(
    stations: Iterable[float],
    row_at: Callable[[float], dict[str, Any]],
    recorder: AnyRecorder[Kept],
    advance: Callable[[], None],
    keep: Callable[[Kept], None],
) -> Kept:
    """Record the rows of all stations, one after the other."""
    places = recorder.places
    count = len(next(iter(places.values())))
    with recorder.rescued(keep):
        for number, station in enumerate(stations, start=1):
            try:
                recorder.rows.append(row_at(float(station)))
            except DivergedError as error:
                recorder.rows.append(DIVERGED)
                at = ", ".join(f"{name} = {x[number - 1]:.6g}" for name, x in places.items())
                where = f"station {number} of {count}, {at}"
                raise DivergedError(f"diverged at {where}: {error}") from error
            advance()
    return recorder.readings()
