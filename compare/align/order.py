"""Rows in the order of the motion, and which way that goes."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from analytic import CLAMP_READINGS, Readings
from analytic.numerics.arrays import Floats
from compare.sense.record import Record, direction, inspect_record

_ROWS = 400  # that two sweeps are laid over each other by
_TRIALS, _ROUNDS = 201, 3  # positions tried, and how often the best one is closed in on
_ALIKE = 0.05  # of the readings' square: what one way to count may leave of them
_CLEARLY = 0.25  # of what the other explanation leaves


@dataclass(frozen=True)
class RowOrder:
    """How the candidate's rows follow the motion, seen from the reference."""

    # The rows run against the reference's, while force and moment have its signs: the last station
    # comes first.
    reversed: bool = False
    # Its foot positions count the other way, from this origin: the reference's are this number
    # minus the candidate's [length]; None if they count alike.
    backwards_from: float | None = None
    sorted: bool = False  # the rows are in no order of a motion
    # The foot moves the other way: rows and ``moment_z`` both have the other sign.
    opposite: bool = False
    column: str = "foot_x"  # over which the sweeps run

    @property
    def note(self) -> str | None:
        """What is wrong with the rows, and what was compared instead; None if nothing is."""
        if self.reversed:
            return (
                f"rows reversed: {self.column} runs the other way than in the reference while "
                "force and moment have its signs; compared from the last row to the first"
            )
        if self.backwards_from is not None:
            turned = f"{self.backwards_from:.4g} - " if self.backwards_from else "-"
            return (
                f"{self.column} counts the other way: it grows where the reference's falls, while "
                "force and moment follow the reference row by row; compared with "
                f"{turned}{self.column} instead (or force_x and moment_z have the opposite sign, "
                "if the object is symmetric)"
            )
        if self.sorted:
            return (
                f"rows out of order: {self.column} leads back and forth; compared after sorting by "
                f"{self.column}, in the direction that the signs of force and moment show"
            )
        return None


def in_order(reference: Readings, candidate: Readings) -> tuple[Readings, Record, RowOrder]:
    """The candidate with its rows in the order of the motion, and what was wrong with them.

    The vibrissa bends against the foot's motion, so that a sweep in the opposite direction has a
    ``moment_z`` of the opposite sign as well. That distinguishes it from a file whose rows are
    reversed, and both from a sensor that is wired the wrong way, where the rows run as in the
    reference. Where only `foot_x` runs the other way, either the rows are reversed or a stage
    counts its way backwards: which of them lays the readings over the reference's decides.
    """
    record, order = inspect_record(candidate), partial(RowOrder, column=candidate.running)
    if sorted_before := candidate.provenance.get("rows", {}).get("retreats", 0):
        return candidate, replace(record, retreats=sorted_before), order(sorted=True)
    opposite = _sign(candidate, "moment_z") * _sign(reference, "moment_z") < 0
    if record.retreats:
        # A sweep the other way has the sign of force_y; a sensor that is turned has not.
        opposite &= _sign(candidate, "force_y") * _sign(reference, "force_y") > 0
        sign = -direction(reference) if opposite else direction(reference)
        sorted_ = _taken(candidate, np.argsort(sign * candidate.running_values, kind="stable"))
        again = replace(inspect_record(sorted_), retreats=record.retreats)
        return sorted_, again, order(sorted=True, opposite=opposite)
    if direction(candidate) * direction(reference) > 0:
        return candidate, record, order()
    if opposite:
        return candidate, record, order(opposite=True)
    origin = _backwards_from(reference, candidate)
    if origin is not None:
        back = {candidate.running: origin - candidate.running_values}
        counted_back = replace(candidate, table=candidate.table.assign(**back))
        return counted_back, inspect_record(counted_back), order(backwards_from=origin)
    reversed_rows = _taken(candidate, np.arange(len(candidate.table))[::-1])
    return reversed_rows, inspect_record(reversed_rows), order(reversed=True)


def _backwards_from(reference: Readings, candidate: Readings) -> float | None:
    """Origin that foot positions count backwards from; None if reversed rows explain as much."""
    x_ref, true = _shape(reference)
    x, seen = _shape(candidate)
    if len(x_ref) < 2 or not seen.any():
        return None
    order = np.argsort(x_ref, kind="stable")
    x_ref, true = x_ref[order], true[:, order]

    def left(at: Floats) -> float:
        """Share of the readings' square that is left if they were felt at these positions."""
        there = np.stack([np.interp(at, x_ref, row, left=0.0, right=0.0) for row in true])
        return float(np.sum((seen - there) ** 2) / np.sum(seen**2))

    def nearest(sign: float) -> tuple[float, float]:
        """What the best origin of that way to count leaves, and the origin."""
        width = max(float(np.ptp(x_ref)), float(np.ptp(x)))
        best, reach = float(np.mean(x_ref) - sign * np.mean(x)), width
        for _ in range(_ROUNDS):
            origins = best + np.linspace(-reach, reach, _TRIALS)
            best = float(min(origins, key=lambda origin: left(origin + sign * x)))
            reach = 2 * reach / _TRIALS
        return left(best + sign * x), best

    reversed_rows = min(left(x), nearest(1.0)[0])
    for rest, origin in ((left(-x), 0.0), nearest(-1.0)):
        if rest <= _ALIKE and rest < _CLEARLY * reversed_rows:
            return origin
    return None


def _shape(readings: Readings) -> tuple[Floats, Floats]:
    """Foot positions and readings by their largest magnitudes, which no unit changes."""
    rows = np.flatnonzero(readings.trusted)
    rows = rows[:: -(-len(rows) // _ROWS) or 1]
    values = np.stack([readings.values(name)[rows] for name in CLAMP_READINGS])
    scale = np.max(np.abs(values), axis=1, initial=0.0, keepdims=True)
    return readings.running_values[rows], values / np.where(scale > 0, scale, 1.0)


def _taken(readings: Readings, rows: np.ndarray) -> Readings:
    return replace(readings, table=readings.table.iloc[rows].reset_index(drop=True))


def _sign(readings: Readings, name: str) -> float:
    values = readings.values(name)[readings.trusted]
    return float(np.sign(np.sum(values)))
