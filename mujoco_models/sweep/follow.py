"""A walk through all stations, and its readings in the units of the case."""

import platform
import time
from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from threadpoolctl import threadpool_limits

from analytic.problem.arrays import Floats, Integers
from analytic.problem.case import Case
from analytic.problem.columns import COLUMNS, WORDS, units
from analytic.problem.readings import Readings
from mujoco_models.errors import DivergedError

_DIVERGED = {"phase": "free", "status": "diverged"}  # the row of a station without numbers


class Steps(Protocol):
    """A walk from station to station."""

    model: Any
    """Its ``obstacle`` has a label."""
    doubt: str | None
    """What is wrong with the state at the last station."""

    @property
    def events(self) -> dict[str, float | None]:
        """Foot positions of what happened on the way [L]."""

    def go_to(self, target: float) -> None:
        """Go on to a station.

        Parameters
        ----------
        target : float
            Foot position [L].
        """

    def row(self) -> dict[str, Any]:
        """The readings there.

        Returns
        -------
        dict
            By column; dimensionless.
        """


@dataclass(frozen=True)
class Account:
    """What the readings of a sweep say of their origin."""

    source: str  # who produces them
    provenance: Mapping[str, Any]  # ``engine``, with its version, and ``settings``
    begun: float  # processor time when the work began [s]


def follow(
    case: Case,
    walk: Steps,
    account: Account,
    advance: Callable[[], None] = lambda: None,
    keep: Callable[[Readings], None] = lambda _: None,
) -> Readings:
    """Go to all stations, one after the other."""
    rows: list[dict[str, Any]] = []
    doubts: Counter[str] = Counter()
    try:
        # The matrices are small: more threads only wait for each other, on a busy machine for long.
        with threadpool_limits(1):
            for target in case.foot_x / case.beam.length:
                walk.go_to(float(target))
                doubts.update([walk.doubt] if walk.doubt else [])
                rows.append(walk.row())
                advance()
    except BaseException as error:  # whatever it is, what there is must not be lost
        if isinstance(error, DivergedError):
            rows.append(_DIVERGED)
        if len(rows) > 1:
            keep(_readings(case, walk, rows, doubts, account))
        if isinstance(error, DivergedError):
            place = f"station {len(rows)} of {len(case.foot_x)}, foot_x = {target:.6g} L"
            raise DivergedError(f"diverged at {place}: {error}") from error
        raise
    return _readings(case, walk, rows, doubts, account)


def _readings(
    case: Case,
    walk: Steps,
    rows: list[dict[str, Any]],
    doubts: Counter[str],
    account: Account,
) -> Readings:
    """In the units of the case's beam."""
    columns, beam = _columns(rows, case), case.beam
    events = {name: None if x is None else x * beam.length for name, x in walk.events.items()}
    provenance = {
        **case.provenance(),
        **account.provenance,
        "python": platform.python_version(),
        "obstacle": walk.model.obstacle.label,
        "seconds": round(time.process_time() - account.begun, 3),
        "unsettled": dict(doubts),
        "events": events,
    }
    if any(np.isinf(values).any() for values in columns.values()):
        from analytic.problem.table import as_table  # slow to load

        # Beyond the largest number in the case's units: an error says so.
        return Readings(as_table(columns), beam, account.source, provenance)
    return Readings.solved(columns, beam, account.source, lambda: provenance, events["snap_off"])


def _columns(rows: list[dict[str, Any]], case: Case) -> dict[str, Floats | Integers]:
    """As `analytic.problem.table.as_table` takes them; a station without numbers has NaN."""
    names = dict.fromkeys([*COLUMNS, *rows[0]])
    columns: dict[str, Floats | Integers] = {}
    for name, unit in zip(names, units(case.beam, names), strict=True):
        if name == "foot_x":
            columns[name] = case.foot_x[: len(rows)]
        elif name in WORDS:
            columns[name] = np.array([WORDS[name].index(row[name]) for row in rows])
        else:
            values = np.array([row.get(name, np.nan) for row in rows], dtype=float)
            columns[name] = values * unit
    return columns
