"""What is kept of a sweep in motion: a row a station, whatever the number of steps."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.problem.arrays import Floats
from analytic.problem.columns import CLAMP_READINGS

_HALF_PERIOD = 0.5  # T1
_APART = 0.05  # of a station's way; without contact there, the mean is off by about so much


@dataclass(frozen=True)
class Step:
    """One step of MuJoCo's."""

    time: float  # since the start [T1]
    p: float  # parameter of the clamp's way, that of a sweep the foot position [L]
    clamp: Floats  # force and moment, as the sensor gives them [EI/L^2, EI/L]
    touches: bool  # whether a contact is loaded


class StationMeans:
    """Means of the readings over the way round each station, and the raw ones at it.

    Between two steps the readings are taken to be linear in the clamp's way, so that the means
    are centred at the stations wherever the steps fall.
    """

    def __init__(
        self, stations: Floats, average: float, names: tuple[str, ...] = CLAMP_READINGS
    ) -> None:
        self._names = names
        self._stations: list[float] = stations.tolist()
        self._half = average * float(np.abs(np.diff(stations)).min()) / 2
        self.rows: list[dict[str, Any]] = []
        self.first_touch: float | None = None
        self._lasting: float | None = None
        self._brief: float | None = None
        self._last = Step(0.0, math.inf, np.zeros(len(names)), touches=False)
        self._begun, self._lost = 0.0, -math.inf
        self._pending: dict[str, Any] | None = None
        self._sum = np.zeros(len(names))
        self._losses = 0
        self._apart = 0.0  # L; without contact, once there was one
        self._held = False  # at the station itself
        self._touched = False  # at a station so far
        self._missed: list[dict[str, Any]] = []  # stations without contact since then

    @property
    def first(self) -> float:
        return self._stations[0] + self._half

    @property
    def complete(self) -> bool:
        return len(self.rows) == len(self._stations)

    def crosses(self, before: Step, after: Step) -> bool:
        """Whether the next station lies between two steps."""
        return (
            not self.complete
            and self._pending is None
            and after.p <= self._stations[len(self.rows)] < before.p
        )

    def note(self, before: Step, after: Step, state: dict[str, Any]) -> None:
        """Keep the raw readings and the state at the station between two steps."""
        share = (before.p - self._stations[len(self.rows)]) / (before.p - after.p)
        raw = before.clamp + share * (after.clamp - before.clamp)
        self._held = before.touches and after.touches
        self._pending = {
            "time": before.time + share * (after.time - before.time),
            **{f"{name}_raw": float(x) for name, x in zip(self._names, raw, strict=True)},
            **state,
        }

    def take(self, before: Step, after: Step) -> bool:
        """Add the way between two steps to the mean of the present station."""
        if before.touches != after.touches:
            self._losses += before.touches
        apart = self.first_touch is not None and not (before.touches and after.touches)
        self._follow(after)
        if self.complete:
            return False
        station = self._stations[len(self.rows)]
        begin, end = station + self._half, station - self._half
        right, left = min(begin, before.p), max(end, after.p)
        if right > left:
            middle = (before.p - (right + left) / 2) / (before.p - after.p)
            self._sum += (before.clamp + middle * (after.clamp - before.clamp)) * (right - left)
            self._apart += apart * (right - left)
        if self._pending is None or after.p > end:
            return False
        self._close()
        return True

    @property
    def last_touch(self) -> float | None:
        """Where contact was lost for good; None if there is one, or was none.

        What is found again within half a period is one contact with its bounces. Where that lasted
        half a period, a shorter one after it is but the vibrissa that swings back.
        """
        so_far = self._last.time - self._begun
        if self._last.touches and (self._lasting is None or so_far >= _HALF_PERIOD):
            return None
        return self._brief if self._lasting is None else self._lasting

    def _follow(self, sample: Step) -> None:
        """Note where contact is found and lost."""
        changed = sample.touches != self._last.touches
        self._last = sample
        if not changed:
            return
        if sample.touches:
            if self.first_touch is None:
                self.first_touch = sample.p
            if sample.time - self._lost > _HALF_PERIOD:
                self._begun = sample.time
            return
        self._lost = sample.time
        if sample.time - self._begun >= _HALF_PERIOD:
            self._lasting = sample.p
        else:
            self._brief = sample.p

    def _close(self) -> None:
        row = self._pending or {}
        raw = [row[f"{name}_raw"] for name in self._names]
        mean = self._sum / (2 * self._half) if self._half > 0 else np.array(raw)
        row |= dict(zip(self._names, mean.tolist(), strict=True))
        row["contact_losses"] = self._losses
        apart = self._held and self._apart > _APART * 2 * self._half
        if row["status"] == "ok" and (apart or self._losses > 1):
            row["status"] = "chattering"
        self._mark_lost(row)
        self.rows.append(row)
        self._pending, self._losses, self._apart = None, 0, 0.0
        self._sum = np.zeros(len(self._names))

    def _mark_lost(self, row: dict[str, Any]) -> None:
        """Stations without contact between stations with one: it was lost, and found again."""
        if row["phase"] != "free":
            for missed in self._missed if self._touched else []:
                missed["status"] = "lost"
            self._missed, self._touched = [], True
        elif row["status"] == "ok":
            self._missed.append(row)
