"""What is wrong at some stations alone: single ones, those at the end, those without contact."""

from typing import TypeAlias

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS
from analytic.numerics.arrays import Booleans, Floats
from compare.explain.one_or_two import CONVINCING
from compare.judge.allowance import Allowance, NoiseAllowance
from compare.judge.failures import at_most_next_to_snap_off
from compare.judge.tolerances import Limits, Tolerances
from compare.measure.disagreement import at_rest, rms
from compare.measure.in_space import SpatialMeasurement
from compare.measure.measurement import Measurement
from compare.sense.record import direction

_FAR_OFF, _SELDOM = 20.0, 0.05  # times the median difference; fraction of the stations, at the most
_HOLDS = 0.5  # of the last force before its release: a contact that goes on has no less
_SWINGS = 3  # stations at least that show it

Found: TypeAlias = Measurement | SpatialMeasurement


def lone(found: Found, error: Floats, at: Floats, limits: Limits, noise: Allowance) -> str | None:
    """Single stations that are far off, if all others agree or nearly all of it is theirs.

    `error` has a row a component, over its largest magnitude.
    """
    size = np.abs(error).max(axis=0)
    off = size > _FAR_OFF * np.median(size)
    neighbours = np.append(off[1:], False) & off
    if not off.any() or neighbours.any() or off.mean() > _SELDOM:
        return None
    agree = agree_to(error[:, ~off], limits, noise)
    if not agree and np.sum(error[:, ~off] ** 2) > (1 - CONVINCING) * np.sum(error**2):
        return None
    rest = "all others agree" if agree else "nearly all of the disagreement is theirs"
    return f"single stations: {_off(found, off, error, at, 'compared')}; {rest}"


def ended(found: Measurement, limits: Tolerances) -> str | None:
    """That the candidate lets go early, late or not at all, if that is all that is wrong."""
    ends, (size, unit), name = found.snap_off, found.reference.running_unit, found.reference.running
    if ends.reference is None or "snap_off" in (*found.beyond(), *found.not_trusted()):
        return None
    way, at = direction(found.reference), found.candidate.running_values
    end = way * np.inf if ends.candidate is None else ends.candidate
    early = way * (ends.reference - end) / size
    if abs(early) <= limits.snap_off + ends.uncertainty / size:
        return None
    after = (way * at > way * ends.reference) & (way * at < way * end)
    if (found.judged["candidate"].phase[after] == "free").any():
        return None
    if not (early > 0 or _goes_on(found, after)):
        return None
    due = f"{name} = {ends.reference / size:.4g} {unit}"
    if ends.candidate is None:
        return f"the contact does not end: the clamp stays loaded beyond {due}, and agrees before"
    place = f"{name} = {end / size:.4g} {unit}"
    when = "early" if early > 0 else "late"
    return f"the contact ends {when}, at {place} instead of {due}, and agrees up to there"


def agree_to(error: Floats, limits: Limits, noise: Allowance, jumps: Floats | float = 0.0) -> bool:
    """Whether the readings agree at some stations, beside what jumps from one to the next."""
    stations = error.shape[1]
    allowed = [noise.rms(limits.of(name, "rms"), name, stations) for name in noise.level]
    return bool((rms(error) <= np.hypot(allowed, jumps)).all())


def without_contact(found: Found, limits: Limits, noise: Allowance) -> str | None:
    """Stations where one sweep is free, if the readings there are off."""
    error, at, released = _idle(found)
    allowed = [noise.max(limits.of(n, "max"), n, len(at)) for n in found.disagreement]
    off = np.asarray((np.abs(error) > np.array(allowed)[:, None]).any(axis=0))
    begins = None
    if isinstance(found, Measurement) and isinstance(limits, Tolerances):
        begins, _ = begun(found, limits, at)
    beside = _free(found, off, error, at, bool(released[off].all())) if off.any() else None
    return "; beside that ".join(filter(None, (begins, beside))) or None


def begun(found: Measurement, limits: Tolerances, at: Floats) -> tuple[str | None, Booleans]:
    """That the candidate's contact begins late, and which places its first load lies behind."""
    first, (size, unit) = found.events["first_contact"], found.reference.running_unit
    begin, due, nowhere = first.candidate, first.reference, np.zeros(len(at), dtype=bool)
    if begin is None or due is None:
        return None, nowhere
    way, name = direction(found.reference), found.reference.running
    if way * (begin - due) <= limits.transition * size + first.uncertainty:
        return None, nowhere
    places = f"at {name} = {begin / size:.4g} {unit} instead of {due / size:.4g} {unit}"
    loaded = found.candidate.running_values[found.judged["candidate"].phase != "free"][0]
    between = (way * at >= way * due) & (way * at <= way * loaded)
    return f"the contact begins late, {places}, and agrees from there on", between


def _free(found: Found, off: Booleans, error: Floats, at: Floats, released: bool) -> str:
    """What is off where one sweep is free."""
    said = _off(found, off, error, at, "where a sweep is free")
    if off.sum() == 1:
        return f"single stations: {said}; all others agree"
    turns = (error[:, off].min(axis=1) < 0) & (error[:, off].max(axis=1) > 0)
    todo = "let it come to rest at each station, or say so in `status`"
    if released and off.sum() >= _SWINGS and turns.any():
        return f"ringing: the released vibrissa swings, {said}; {todo}"
    return f"no rest: {said}, and all others agree; {todo}"


def _idle(found: Found) -> tuple[Floats, Floats, Booleans]:
    """What is off where one sweep is free, where that is, and whether it is after the release."""
    if isinstance(found, SpatialMeasurement):
        last = np.flatnonzero(found.touching.reference).max(initial=-1)
        after = np.arange(len(found.travel)) > last
        return found.error[:, found.idle], found.travel[found.idle], after[found.idle]
    rows = at_rest(found.candidate, found.alignment.idle, found.snap_off)
    way = direction(found.reference)
    at, end = rows["at"].to_numpy(), found.snap_off.reference
    late = np.zeros(len(at), dtype=bool) if end is None else way * at > way * end
    return _error(found, rows), at, np.asarray(late)


def next_to_snap_off(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> str | None:
    """That nothing else is off than the stations in the window before the snap-off."""
    for name, one in found.disagreement.items():
        limit = at_most_next_to_snap_off(found, name, limits)
        if one.max_before_snap_off > noise.max(limit, name, one.stations):
            return (
                f"single stations: next to the snap-off {name} is off by up to "
                f"{one.max_before_snap_off:.1e} of its largest magnitude; all others agree"
            )
    return None


def _off(found: Found, off: Booleans, error: Floats, at: Floats, where: str) -> str:
    """How many stations are off, by how much and in what the worst of them is."""
    size = np.abs(error).max(axis=0)
    worst = int(size.argmax())
    reading = [*found.disagreement][int(np.abs(error[:, worst]).argmax())]
    unit, name = found.reference.running_unit, found.reference.running
    return (
        f"{off.sum()} of {len(off)} {where} {'is' if off.sum() == 1 else 'are'} off by up to "
        f"{size[worst]:.1e} of the largest {reading} (at {name} = "
        f"{at[worst] / unit[0]:.4g} {unit[1]})"
    )


def _error(found: Measurement, rows: pd.DataFrame) -> Floats:
    return np.stack(
        [
            (rows[f"{name}_candidate"] - rows[f"{name}_reference"]) / found.disagreement[name].scale
            for name in CLAMP_READINGS
        ]
    )


def _goes_on(found: Measurement, late: Booleans) -> bool:
    """Whether what is felt after the release is a contact, whose force does not fall at once."""
    if not late.any():
        return True
    force = np.hypot(found.candidate.values("force_x"), found.candidate.values("force_y"))
    first = int(np.flatnonzero(late)[0])
    return bool(force[late].min() >= _HOLDS * force[max(first - 1, 0)])
