"""A sweep's rows as they come, and the readings that they are, also if it ends early.

Sweeps to the right are recorded as mirror images of sweeps to the left.
"""

import platform
import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
from threadpoolctl import threadpool_limits

from analytic.numerics.arrays import Floats, Integers
from analytic.problem.beam import Beam
from analytic.problem.case import Case
from analytic.problem.clamp_path import Sweep
from analytic.problem.columns import COLUMNS, WORDS, units
from analytic.problem.errors import require, unknown
from analytic.problem.readings import Readings, are_finite, solved_readings

DIVERGED = {"phase": "free", "status": "diverged"}  # the row of a station without numbers
Kept = TypeVar("Kept")


def leftward(case: Case) -> Case:
    """A case whose clamp goes to the left: itself, or its mirror image."""
    require("case", case, Case, "named_case('catenary') makes one")
    return case if case.direction == "left" else case.mirrored()


def keep_facing(case: Case, keep: Callable[[Readings], None]) -> Callable[[Readings], None]:
    """What takes readings of the sweep to the left, and keeps them as those of a case."""
    return lambda found: keep(facing(case, found))


def facing(case: Case, found: Readings) -> Readings:
    """The readings of the sweep to the left that was solved for `case`, as readings of `case`."""
    if case.direction == "left":
        return found
    mirrored = found.mirrored()
    return replace(mirrored, provenance={**mirrored.provenance, **case.provenance()})


class Swept(Protocol):
    """A case, of whichever kind."""

    @property
    def beam(self) -> Beam:
        """The vibrissa."""

    def provenance(self) -> dict[str, Any]:
        """What the readings of the case say of it."""


@dataclass
class AnyRecorder(ABC, Generic[Kept]):
    """Dimensionless rows, L = EI = 1, of a sweep past the stations of a case."""

    case: Swept
    source: str  # who produces the readings
    # Of the provenance: ``engine``, with its version, ``settings`` and the like. It is read when
    # the readings are made, so it may hold what is counted on the way.
    about: Mapping[str, Any]
    events: Callable[[], Any]  # what has happened so far
    rows: list[dict[str, Any]] = field(default_factory=list)
    begun: float = field(default_factory=time.process_time)  # processor time [s]

    @property
    @abstractmethod
    def places(self) -> dict[str, Floats]:
        """Columns that say where the stations are, in the order in which they are passed."""

    @contextmanager
    def rescued(self, keep: Callable[[Kept], None]) -> Iterator[None]:
        """Hand over what there is when the work ends early, whatever ends it."""
        try:
            # The matrices are small: more threads only wait for each other, on a busy machine long.
            with threadpool_limits(1):
                yield
        except BaseException:
            if len(self.rows) > 1:
                keep(self.readings())
            raise

    @abstractmethod
    def readings(self) -> Kept:
        """All rows, in the units of the case's beam."""

    def _provenance(self, events: object) -> dict[str, Any]:
        return {
            **self.case.provenance(),
            **self.about,
            "python": platform.python_version(),
            "seconds": round(time.process_time() - self.begun, 3),
            "events": events,
        }

    def _columns(self, first: tuple[str, ...]) -> dict[str, Any]:
        """By name, in the units of the beam; a station without numbers has NaN."""
        columns: dict[str, Any] = {n: x[: len(self.rows)] for n, x in self.places.items()}
        given = dict.fromkeys([*first, *(name for row in self.rows for name in row)])
        names = [name for name in given if name not in columns]
        for name, unit in zip(names, units(self.case.beam, names), strict=True):
            if name in WORDS:
                columns[name] = [row[name] for row in self.rows]
            else:
                values = np.array([row.get(name, np.nan) for row in self.rows], dtype=float)
                columns[name] = values * unit
        return columns


def running_values(case: Case, events: Mapping[str, float | None]) -> dict[str, float | None]:
    """What a case's sweep runs over, by parameters of the way to the left that solves it."""
    size = case.beam.length if isinstance(case.sweep, Sweep) else -1.0
    unit = size if case.direction == "left" else -size
    unit = -case.beam.length if case.sweep.running == "travel" else unit
    return {name: None if p is None else unit * p for name, p in events.items()}


@dataclass
class Recorder(AnyRecorder[Readings]):
    """Of a sweep in the plane to the left; its events are parameters of the way by name."""

    case: Case
    back: bool = False  # whether the stations are passed from the last to the first

    @cached_property
    def places(self) -> dict[str, Floats]:
        places = {"foot_x": self.case.foot_x, **self.case.way_columns}
        return {name: x[:: -1 if self.back else 1] for name, x in places.items()}

    def readings(self) -> Readings:
        columns: dict[str, Floats | Integers] = self._columns(COLUMNS)
        for name in WORDS:
            columns[name] = np.array([_number(name, word) for word in columns[name]])
        events = running_values(self.case, self.events())
        beam, provenance, finite = self.case.beam, self._provenance(events), are_finite(columns)
        return solved_readings(
            columns, beam, self.source, lambda: provenance, events["snap_off"], finite
        )


def _number(column: str, word: str) -> int:
    allowed = WORDS[column]
    if word not in allowed:
        raise unknown(f"column {column}", word, allowed)
    return allowed.index(word)
