"""The passes in the files of a rig: calibrated, without defects, their zero taken off."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, SENSED, Direction, InputError, Readings
from analytic.from_clamp.calibration.measured import check_size as check_decades
from analytic.from_clamp.noise import rounding
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.errors import called
from analytic.problem.table import as_numbers
from compare.read import nonsense
from compare.read.dialect import RawTable, read_text_table
from compare.read.drift import FEWEST, Bent, Zero, bent, no_zero, zero_of
from compare.read.kinds import TEXTS
from compare.read.rig import cells, check_recorded, read_sweeps
from compare.read.rig_file import Rig
from compare.read.units import DIMENSIONS, check_unit
from compare.sense.record import Record, check_size, inspect_record

_SHAPE = 0.25  # of a curve that is taken off: exp(-4 u) and sin(3 u) are so far from a cubic
_WORKBOOKS = (".xlsx", ".xls", ".ods", ".mat", ".tdms", ".h5")  # may hold passes, too
_NO_NUMBER = "fix the cell, or name it in rig.toml: missing = [...]"
_MIDDLE = 2.0  # times the root mean square of a bend is at most what it has midway, if lopsided


@dataclass(frozen=True, repr=False)
class Pass:
    name: str  # the file's, with the number of the pass if it has several
    direction: Direction  # which way the foot moves
    readings: Readings  # in the order of the motion; gaps (NaN) where a row has a defect
    rows: int  # how many rows of the file belong to it
    # How many of them are not used, by reason: ``without_foot_x`` and ``averaged`` (with the row
    # before, at the same place) have no row in `readings`, the others are gaps there.
    dropped: dict[str, int]
    sorted: int  # how many rows were out of order
    record: Record  # what was wrong with the record as such
    # Of each clamp reading where the vibrissa is free: before the contact, and by how much it
    # changes until after it [force, force length]. NaN if no such stretch is known.
    zero: dict[str, float]
    drift: dict[str, float]
    drawn: Zero  # the same, and how well it is known
    raw: Floats  # shape (3, rows); the clamp readings before defects and zero were taken off
    taken: Floats  # shape (3, rows); what was taken off, NaN if no free stretch is known
    free: Booleans  # shape (rows,); the free stretches
    fault: InputError | None  # why the pass is not to be used
    bends: bool = False  # whether the drift that was taken off is a curve

    @property
    def kept(self) -> int:
        """How many stations have all four numbers."""
        return int(self.readings.trusted.sum())

    def __repr__(self) -> str:
        return f"Pass({self.name} to the {self.direction}: {self.kept} of {self.rows} rows)"


def usable(passes: list[Pass]) -> list[Pass]:
    for one in passes:
        if one.fault is not None:
            raise one.fault
        check_decades(one.readings, one.readings.beam)
    for some in swept_alike(passes):
        each = [[one.readings.values(name) for name in CLAMP_READINGS] for one in some]
        nonsense.check_sizes([np.array(values) for values in each], [one.name for one in some])
    return passes


def look_at_passes(sources: Iterable[Path], rig: Rig) -> list[Pass]:
    """All passes in files, and in the files of folders, with their faults."""
    files = [path for source in sources for path in _files(source)]
    stems = [path.stem for path in files]
    for path in files:
        if stems.count(path.stem) > 1:
            allowed = "of a name that no other has"
            raise InputError("FILE", path, allowed, "rename it: passes take it")
    passes = [one for path in files for one in _of_file(path, rig)]
    names = [one.name for one in passes]
    for name in names:
        if names.count(name) > 1:
            remedy = "rename the file that is called so: of another file one pass has that name"
            raise InputError("passes", f"two that are called {name}", "of different names", remedy)
    return _straightened(passes)


def _files(source: Path) -> list[Path]:
    if not source.is_dir():
        return [source]
    there = sorted(path for path in source.iterdir() if path.is_file())
    files = [path for path in there if path.suffix.lower() in TEXTS]
    others = [path.name for path in there if path.suffix.lower() in _WORKBOOKS]
    if files and others:
        remedy = "export it as text, or move it elsewhere"
        raise InputError("FILE", source / others[0], f"named *{', *'.join(TEXTS)}", remedy)
    if not files:
        allowed = f"a folder with files named *{', *'.join(TEXTS)}"
        raise InputError("FILE", source, allowed, "name another")
    return files


def _of_file(path: Path, rig: Rig) -> Iterator[Pass]:
    table = read_text_table(path)
    raw = _calibrated(table, rig, path)
    groups = _groups(table, rig, path)
    sweeps, lost, beam = [], 0, rig.beam.build()
    for number, group in enumerate(np.unique(groups), 1):
        rows = raw[groups == group].reset_index(drop=True)
        if len(rows) < FEWEST:
            lost += len(rows)
            continue
        foot_x = rows["foot_x"].to_numpy(copy=True)
        foot_x[nonsense.spikes(foot_x[None])] = np.nan  # no stage leaps there and back
        which = f"{path}, pass {number}" if groups.max() > groups.min() else f"{path}"
        nonsense.check_travel(foot_x, beam.length, which)
        nonsense.check_back(foot_x, path.stem)
        try:
            sweeps += read_sweeps(rows.assign(foot_x=foot_x), beam)
        except InputError as error:
            raise called(error, f"{error.name} of {which}") from error
    if not sweeps:
        what = f"{len(raw)}, of which {len(raw) // max(number, 1)} to a pass"
        remedy = "is it the right file, and [passes] column the one that changes with every pass?"
        raise InputError(f"rows of {path}", what, f"{FEWEST} or more to a pass", remedy)
    for number, (direction, readings) in enumerate(sweeps, 1):
        name = path.stem if len(sweeps) == 1 else f"{path.stem}-{number}"
        one = _pass(name, direction, readings, rig)
        if lost:
            dropped = {**one.dropped, "of_too_short_passes": lost}
            one, lost = replace(one, rows=one.rows + lost, dropped=dropped), 0
        yield one


def _calibrated(table: RawTable, rig: Rig, path: Path) -> pd.DataFrame:
    """The sensed quantities, in SI if there are units, the readings with their constant zero.

    That is taken off later: a cell of 0 amid contact is a dropout, wherever the zero is.
    """
    found = {}
    for name in SENSED:
        said = rig.columns[name]
        column = cells(table.frame, said.column, path, "fix [columns]")
        if said.unit and abs(said.gain) == 1:  # else the gain may be what converts it
            written = table.units.get(said.column, "")
            check_unit(said.unit, said.column, written, DIMENSIONS[name], f" of {path}")
        if not pd.api.types.is_numeric_dtype(column):
            column = column.mask(column.astype(str).str.strip().isin(rig.missing))
        numbers = as_numbers(column, said.column, table.place, _NO_NUMBER)
        zero = 0.0 if name in CLAMP_READINGS else said.zero
        found[name] = said.scale(name) * (numbers - zero)
    clock = rig.columns.time
    if clock is not None:
        column = cells(table.frame, clock.column, path, "fix [columns]")
        found["time"] = clock.scale("time") * as_numbers(column, clock.column, table.place)
    return pd.DataFrame(found)


def _groups(table: RawTable, rig: Rig, path: Path) -> Floats:
    """The number of the group of passes that each row belongs to."""
    column = rig.passes.column
    if column is None:
        return np.zeros(len(table.frame))
    values = cells(table.frame, column, path, "fix [passes]")
    return np.asarray((values != values.shift()).cumsum(), dtype=float)


def _pass(name: str, direction: Direction, raw: Readings, rig: Rig) -> Pass:
    late = rig.passes.lag if direction == "right" else -rig.passes.lag
    speed = _speed(raw)
    there = raw.table.drop(columns="time", errors="ignore")
    raw = replace(raw, table=there.assign(foot_x=there["foot_x"] - late))
    read, counts = _read(raw), raw.provenance.get("rows", {})
    # They hide what else is wrong.
    leaps = nonsense.spikes(np.where(inspect_record(raw).sound, read, np.nan))
    read[:, leaps] = np.nan
    record = inspect_record(replace(raw, table=raw.table.assign(**_by_reading(read))))
    dropped = {
        "without_foot_x": int(raw.provenance.get("rows_without_foot_x", 0)),
        "averaged": int(counts.get("averaged", 0)),
    }
    rows = len(raw.table) + sum(dropped.values())
    for reason in ("missing", "dropped", "clipped", "repeated"):
        dropped[reason] = int((getattr(record, reason) & ~leaps).sum())
    dropped["spikes"] = int(leaps.sum())
    foot_x = raw.values("foot_x")
    said = {reading: rig.columns[reading] for reading in CLAMP_READINGS}
    check_recorded(raw, name)
    constant = np.array([one.scale(reading) * one.zero for reading, one in said.items()])
    before = np.where(record.sound, read - constant[:, None], np.nan)
    values, free, fault = before, np.zeros(len(foot_x), dtype=bool), None
    zero = no_zero(before)
    provenance: dict[str, Any] = {"pass": name, "direction": direction, "dropped": dropped}
    try:
        nonsense.check_channels(read, name)
        nonsense.check_ahead(foot_x, before, name)
        stretches = _free(foot_x, rig)
        if stretches:
            free = np.any([*stretches.values()], axis=0)
            for which, here in stretches.items():
                stated = getattr(rig.passes, which)
                nonsense.check_free(which, stated, foot_x, before, here, name, raw.beam.si)
            zero = zero_of(foot_x, before, stretches, name)
            nonsense.check_units(before, stretches.values(), name)
            values = before - zero.line
            nonsense.check_drift(zero.drift, values, name)
            with np.errstate(over="ignore"):  # such numbers are refused later
                known = np.nanstd(values[:, free], axis=1)
                known = np.maximum(known, [rounding(row) for row in before])
            nonsense.check_object(values, known, direction, name, "free_before" in stretches)
            provenance["free_noise"] = _by_reading(known.tolist())
    except InputError as error:
        fault = error
    table = raw.table.assign(**_by_reading(values))
    if speed is not None:
        provenance["speed"] = speed
    if np.isfinite(zero.uncertainty).all():
        provenance["zero_uncertainty"] = _by_reading(zero.uncertainty.tolist())
    readings = Readings(table, raw.beam, f"measured, {name}", provenance)
    check_size("pass", readings)
    return Pass(
        name,
        direction,
        readings,
        rows,
        dropped,
        int(counts.get("out_of_order", 0)),
        record,
        _by_reading(zero.before.tolist()),
        _by_reading(zero.drift.tolist()),
        zero,
        before,
        zero.line,
        free,
        fault,
    )


def _speed(raw: Readings) -> float | None:
    """Of the foot, in the median of the pass; None if no column has the time."""
    if "time" not in raw.table:
        return None
    with np.errstate(divide="ignore", invalid="ignore"):
        speeds = np.abs(np.diff(raw.values("foot_x")) / np.diff(raw.values("time")))
    known = speeds[np.isfinite(speeds) & (speeds > 0)]
    return float(np.median(known)) if len(known) else None


def _read(raw: Readings) -> Floats:
    return np.stack([raw.values(name) for name in CLAMP_READINGS])


def _by_reading(values: Iterable[Any]) -> dict[str, Any]:
    return dict(zip(CLAMP_READINGS, values, strict=True))


def _free(foot_x: Floats, rig: Rig) -> dict[str, Booleans]:
    """The stretches before and after the contact that are stated."""
    stated = ("free_before", foot_x[0]), ("free_after", foot_x[-1])
    return {
        which: np.abs(foot_x - end) <= getattr(rig.passes, which)
        for which, end in stated
        if getattr(rig.passes, which) > 0
    }


def _straightened(passes: list[Pass]) -> list[Pass]:
    """The passes without the curve that the drift of all of them has."""
    known = [one for one in passes if one.fault is None and one.drawn.stretches]
    curves = bent([one.drawn for one in known]) if known else []
    of_pass = {one.name: curve for one, curve in zip(known, curves, strict=True)}
    return [_without(one, of_pass[one.name]) if one.name in of_pass else one for one in passes]


def _without(one: Pass, curve: Bent) -> Pass:
    readings, fault = one.readings, one.fault
    values = _read(readings) - curve.away
    try:
        nonsense.check_drift(np.abs(curve.away).max(axis=1), values, one.name)
    except InputError as error:
        fault = error
    more = curve.uncertainty if curve.shows else 0.0  # a curve is lopsided, and no parabola
    uncertain = np.hypot(one.drawn.uncertainty, more)
    within = (one.drawn.share >= 0) & (one.drawn.share <= 1)
    shape = _SHAPE * np.abs(curve.away[:, within]).max(axis=1)
    middle = np.hypot(_MIDDLE * curve.uncertainty, shape)
    cleared = replace(
        readings,
        table=readings.table.assign(**_by_reading(values)),
        provenance={
            **readings.provenance,
            "zero_uncertainty": _by_reading(uncertain.tolist()),
            "bend_uncertainty": _by_reading(middle.tolist()),
        },
    )
    taken = one.taken + curve.away
    return replace(one, readings=cleared, taken=taken, bends=curve.shows, fault=fault)


def swept_alike(passes: Sequence[Pass]) -> list[list[Pass]]:
    """The passes, two or more, that went the same way past the same side."""
    alike: dict[tuple[Direction, bool], list[Pass]] = {}
    for one in passes:
        alike.setdefault((one.direction, one.readings.bends_left), []).append(one)
    return [some for some in alike.values() if len(some) > 1]
