"""What is kept of a sweep in motion: a row a station, whatever the number of steps."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from analytic.numerics.arrays import Floats
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
    twice: bool | None = None  # or of two objects; None if that is not known


class Touches:
    """Where contact is found and where it is lost for good, whatever bounces between.

    What is found again within half a period is one contact with its bounces. Where that lasted half
    a period, a shorter one after it is but the vibrissa that swings back.
    """

    def __init__(self) -> None:
        self.first: float | None = None
        self.lost = -math.inf  # when it was, at last
        self._lasting: float | None = None
        self._brief: float | None = None
        self._begun, self._now, self._touches = 0.0, 0.0, False

    def follow(self, time: float, p: float, touches: bool) -> None:
        changed, self._now, self._touches = touches != self._touches, time, touches
        if not changed:
            return
        if touches:
            if self.first is None:
                self.first = p
            if time - self.lost > _HALF_PERIOD:
                self._begun = time
            return
        self.lost = time
        if time - self._begun >= _HALF_PERIOD:
            self._lasting = p
        else:
            self._brief = p

    @property
    def last(self) -> float | None:
        """Where contact was lost for good; None if there is one, or was none."""
        if self._touches and (self._lasting is None or self._now - self._begun >= _HALF_PERIOD):
            return None
        return self._brief if self._lasting is None else self._lasting


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
        self.contact, self._second, self._looks_twice = Touches(), Touches(), False
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

    def second_contact(self) -> dict[str, float | None]:
        """Where a second contact begins and ends, if that is known; a snap-off ends both."""
        if not self._looks_twice:
            return {}
        lag = self.contact.lost - self._second.lost
        both = self.contact.last is not None and lag < _HALF_PERIOD
        end = None if both else self._second.last
        return {"second_contact_start": self._second.first, "second_contact_end": end}

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
        apart = self.contact.first is not None and not (before.touches and after.touches)
        self.contact.follow(after.time, after.p, after.touches)
        self._looks_twice = after.twice is not None
        self._second.follow(after.time, after.p, bool(after.twice))
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
