"""What is wrong with a record as such: numbers that are missing, repeated, stuck or cut off."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from analytic import CLAMP_READINGS, SENSED, InputError, Readings
from analytic.from_clamp.noise import rounding
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.columns import units
from analytic.problem.table import says
from compare.sense.noise import NOTHING, scales

_LARGEST = 1e40  # of the beam's units; a sixth power still is a number
_FEWEST = 3  # equal extremes that are no accident
_PILED = 3  # times more stations at the extreme than at any other one value: not quantisation
_STEPS = 3  # of a converter; a reading that should be larger is not rounded to zero
_LOADED = 0.02  # of the largest magnitude; a reading that should be larger is not zero by chance
_WIDE = 5  # times the median step: a gap
_BESIDE = 4  # steps to either side that say how long one is
_JITTER = 10  # median steps that the foot may retreat by the jitter of its reading, ...
_BACK = (0.01, 0.1)  # ... and at least and at most this fraction of its travel


@dataclass(frozen=True, repr=False)
class Record:
    """Defects of one sweep's record, by station."""

    # Shape (stations,); A sensed value is no finite number, and no status explains why.
    missing: Booleans
    repeated: Booleans  # shape (stations,); All four sensed values are those of a station before
    # Shape (stations,); A clamp reading is exactly zero, though it is not on either side.
    dropped: Booleans
    # Shape (stations,); A clamp reading is at its extreme, as many others are: it was cut off
    # there.
    clipped: Booleans
    where_clipped: tuple[str, ...]  # the readings that are cut off
    gaps: int  # steps of the foot that are more than five times as long as the median one
    widest: float  # the longest step [length]
    # After which rows others are not there, as one step is more than five times as long as four on
    # either side, and how many.
    holes: dict[int, int]
    column: str  # over which the sweep runs
    # Steps of the foot against its direction of travel, if they lead so far back that the rows are
    # not in the order of the motion; else 0.
    retreats: int

    @property
    def sound(self) -> Booleans:
        """Stations without a defect, shape (stations,)."""
        return ~(self.missing | self.repeated | self.dropped | self.clipped)

    def defects(self) -> Iterator[str]:
        """What is wrong, most serious first."""
        rows = len(self.missing)
        if self.retreats:
            yield f"rows out of order: {self.retreats} of {rows - 1} steps lead back"
        for name, what in (
            ("missing", "lack a number"),
            ("dropped", "are filled with zeros amid contact"),
            ("clipped", f"are cut off at the extreme of {' and '.join(self.where_clipped)}"),
            ("repeated", "repeat a row before"),
        ):
            count = int(getattr(self, name).sum())
            if count:
                yield f"{count} of {rows} rows {what}"
        if self.holes:
            yield f"some {sum(self.holes.values())} rows are not there: {self.column} leaps"

    def to_dict(self) -> dict[str, int | float]:
        return {
            **{
                name: int(getattr(self, name).sum())
                for name in ("missing", "dropped", "clipped", "repeated")
            },
            "retreats": self.retreats,
            "gaps": self.gaps,
            "widest_step": self.widest,
        }

    def __repr__(self) -> str:
        return f"Record({'; '.join(self.defects()) or 'sound'})"


def inspect_record(readings: Readings) -> Record:
    """Look for defects that no contact can cause."""
    names = readings.running, *CLAMP_READINGS
    values = np.stack([readings.values(name) for name in names], axis=1)
    finite = np.isfinite(values).all(axis=1)
    failed = np.zeros(len(values), dtype=bool)
    if "status" in readings.table:
        failed = ~says(readings.table["status"], "ok")
    repeated = np.array(finite)
    repeated[np.unique(values, axis=0, return_index=True)[1]] = False
    same = np.append(False, (values[1:] == values[:-1]).all(axis=1))
    # The jitter of a foot's reading repeats no row under load.
    led_back = repeated & ~same & (values[:, 1:] != 0).any(axis=1)
    dropped = np.zeros(len(values), dtype=bool)
    clipped = np.zeros(len(values), dtype=bool)
    cut = []
    if (np.abs(values[finite & ~failed][:, 1:]) > NOTHING).any():
        kept = finite & ~failed & ~repeated
        still = np.append(False, (values[1:, 1:] == values[:-1, 1:]).all(axis=1))
        moving = kept & ~(still | np.append(still[1:], False))  # not a clamp at rest
        for name, scale in scales(readings).items():
            column = readings.values(name)
            loaded = max(_LOADED * scale, _STEPS * 12**0.5 * rounding(column))
            dropped |= kept & _dropped(np.where(kept, column, np.nan), loaded)
            at_limit = moving & _clipped(column, moving, _LOADED * scale)
            if at_limit.any():
                cut.append(name)
            clipped |= at_limit
    foot_x = readings.running_values
    steps = np.abs(np.diff(foot_x))
    median = float(np.median(steps))
    return Record(
        missing=~finite & ~failed,
        repeated=repeated,
        dropped=dropped & ~clipped,
        clipped=clipped,
        where_clipped=tuple(cut),
        gaps=int((steps > _WIDE * median).sum()) if median > 0 else 0,
        widest=float(steps.max()),
        holes=_holes(np.where(direction(readings) * np.diff(foot_x) > 0, steps, 0.0)),
        column=readings.running,
        retreats=retreats(readings, by_jitter=not led_back.any()),
    )


def check_size(which: str, sweep: Readings) -> None:
    """Refuse numbers whose powers would overflow, and a sweep that does not move."""
    at, name = sweep.running_values, sweep.running
    if len(at) > 1 and np.ptp(at) == 0:
        remedy = f"write where the sweep is at each station into {name}"
        raise InputError(f"{name} of the {which} ({sweep.source})", f"{at[0]:g} at all stations",
                         "another one at each", remedy)  # fmt: skip
    for name, unit in zip(SENSED, units(sweep.beam, SENSED).tolist(), strict=True):
        largest = np.abs(sweep.values(name)[sweep.trusted]).max(initial=0.0)
        if not largest < _LARGEST * unit:
            what = f"{largest:.3g}"
            allowed = f"less than {_LARGEST:g} of the beam's units ({unit:.3g})"
            remedy = "check the units, and the beam"
            raise InputError(f"{name} of the {which} ({sweep.source})", what, allowed, remedy)


def without_dropouts(readings: Readings) -> Readings:
    """A sweep without the readings of rows that are filled with zeros amid contact."""
    dropped = inspect_record(readings).dropped
    if not dropped.any():
        return readings
    gaps = {name: np.where(dropped, np.nan, readings.values(name)) for name in CLAMP_READINGS}
    rows = {**readings.provenance.get("rows", {}), "dropped": int(dropped.sum())}
    return replace(
        readings,
        table=readings.table.assign(**gaps),
        provenance={**readings.provenance, "rows": rows},
    )


def direction(readings: Readings) -> float:
    """Which way the places along the sweep run, from the order of the rows."""
    foot_x = readings.running_values
    rows = np.arange(len(foot_x)) - (len(foot_x) - 1) / 2
    return 1.0 if rows @ (foot_x - foot_x.mean()) > 0 else -1.0


def _dropped(column: Floats, loaded: float) -> Booleans:
    """Zeros between two values that are both well away from it, on the same side."""
    known = np.flatnonzero(np.isfinite(column) & (column != 0))
    found = np.zeros(len(column), dtype=bool)
    if len(known) < 2:
        return found
    zeros = np.flatnonzero(column == 0)
    after = np.searchsorted(known, zeros)
    zeros, after = (x[(after > 0) & (after < len(known))] for x in (zeros, after))
    before, behind = column[known[after - 1]], column[known[after]]
    alike = (np.sign(before) == np.sign(behind)) & (
        np.minimum(np.abs(before), np.abs(behind)) > loaded
    )
    found[zeros[alike]] = True
    return found


def _clipped(column: Floats, moving: Booleans, loaded: float) -> Booleans:
    """Stations at the largest or the smallest value, if too many are to be there by chance."""
    found = np.zeros(len(column), dtype=bool)
    values, counts = np.unique(column[moving], return_counts=True)
    if len(values) < _FEWEST:
        return found
    others = counts[1:-1].max(initial=1)
    others += others > 1  # rounded; next to an extreme a step lasts 1/(sqrt(2) - 1) times as long
    for at, side in ((0, -1), (-1, 1)):
        piled = counts[at] >= max(_FEWEST, _PILED * others)
        if piled and side * values[at] > loaded:
            found |= column == values[at]
    return found


def _holes(steps: Floats) -> dict[int, int]:
    """Where rows are not there: elsewhere a source has fewer stations, as it likes, or jitter."""
    around = sliding_window_view(np.pad(steps, _BESIDE), 2 * _BESIDE + 1)
    beside = np.delete(around, _BESIDE, axis=1).max(axis=1)
    wide = np.flatnonzero((steps > _WIDE * beside) & (beside > 0))
    return {int(i): round(float(steps[i] / beside[i])) - 1 for i in wide}


def retreats(readings: Readings, *, by_jitter: bool = True) -> int:
    """Steps back, if the rows are not in the order of a motion to one side."""
    x = direction(readings) * readings.running_values
    median = float(np.median(np.abs(np.diff(x))))
    back = float(np.max(np.maximum.accumulate(x) - x))
    least, most = (fraction * float(np.ptp(x)) for fraction in _BACK)
    if by_jitter and back <= min(max(_JITTER * median, least), most):
        return 0
    return int((np.diff(x) < 0).sum())
