"""What exceeds the limits of agreement: where, by how much, how much is allowed, and why so."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from analytic import Readings
from analytic.space import SpatialReadings
from compare.judge.allowance import Allowance, NoiseAllowance, SpatialAllowance
from compare.judge.tolerances import Limit, Limits, SpatialTolerances, Tolerances
from compare.measure.in_space import SpatialMeasurement
from compare.measure.measurement import Measurement
from compare.sense.occurrence import Occurrence
from compare.sense.record import direction

_DROWNS = 0.1  # of a largest magnitude; beside more noise that is only estimated, nothing agrees
_FOLLOWS, _READINGS, _FIRST = -1, 1, 2  # weights of a failure, beside 0


@dataclass(frozen=True)
class Failure:
    name: str  # the reading, event or part of the record that it is about
    found: str  # what is wrong with it, with its number
    allowed: str  # how much is allowed, or what to do
    reason: str = ""  # why so much
    excess: float = math.inf  # how many times what is allowed; infinite for what must not be at all
    weight: int = 0  # the heavier leads: that nothing can be compared, readings, whatever follows
    overall: bool = False  # of a reading's rms over all stations, which every table has

    @property
    def clause(self) -> str:
        """The same as part of a sentence."""
        return f"{self.name} ({self.found}; {self.allowed})"

    def __str__(self) -> str:
        why = f" ({self.reason})" if self.reason else ""
        return f"{self.name}: {self.found}; {self.allowed}{why}"


def failures(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> Iterator[Failure]:
    _, unit = found.reference.running_unit
    yield from _order(found)
    yield from _contact(found)
    yield from _offset(found)
    yield from _components(found, limits, noise, f"{found.reference.running} = {{:.5g}} {unit}")
    asked = limits.limits()
    yield from _next_to_snap_off(found, limits, noise)
    for which, right in found.phase_agreement().items():
        judged = f"{right:.1%} judged rightly from the clamp"
        phases = asked["phase_agreement"]
        yield from _phases(f"phases of the {which}", judged, right, phases, noise.phase_agreement)
    events = {name: (event, asked["transition"]) for name, event in found.transitions.items()}
    events["snap_off"] = found.snap_off, _of_snap_off(found, asked)
    unasked = {*found.unsure(), *found.not_reached()}
    seen = {name: pair for name, pair in events.items() if name not in unasked}
    yield from _events(found, seen, found.beyond(), found.not_trusted())
    yield from _cut_off(found)
    counts, stations = found.alignment.counts, len(found.candidate.table)
    absent = _absent(found)
    untrusted = counts["untrusted"] + counts["dropped"] + absent
    why = "; ".join(_reasons(found, absent))
    yield from _stations(untrusted, stations + absent, asked["untrusted"], why)


def failures_in_space(
    found: SpatialMeasurement, limits: SpatialTolerances, noise: SpatialAllowance
) -> Iterator[Failure]:
    asked = limits.limits()
    if not found.compared.any():
        counts = [
            f"{which} " + ", ".join(f"{n} {status}" for status, n in of.items())
            for which, of in found.statuses.items()
        ]
        said = f"at no station do both touch ({'; '.join(counts)})"
        yield Failure("contact", said, "none can be compared", weight=_FIRST)
    yield from _components(found, limits, noise, "{:.4g} L of the way")
    one, limit = found.contact, asked["contact"]
    widened = math.hypot(limit, noise.contact)
    said = f"{one.rms:.2e} L rms, {one.max:.1e} L at most"
    yield from _beyond("contact", said, one.rms, limit, widened, noise.contact, " L")
    unknown, some = one.asked - one.stations, asked["untrusted"]
    said = f"at {unknown} of {one.asked} compared stations the clamp's readings are of no contact"
    yield from _more("contact", said, unknown, some, (some + noise.unknown) * one.asked)
    if found.phase_agreement is not None:
        said = f"{found.phase_agreement:.1%} of the compared stations are in the same phase"
        yield from _phases("phases", said, found.phase_agreement, asked["phase_agreement"])
    events = {name: (event, asked["event"]) for name, event in found.events.items()}
    yield from _events(found, events)
    stations = int(found.reference.trusted.sum())
    yield from _stations(found.untrusted, stations, some, "the reference has readings there")


def _beyond(
    name: str,
    found: str,
    size: float,
    limit: Limit,
    widened: float,
    noise: float = 0.0,
    unit: str = "",
    weight: int = 0,
    overall: bool = False,
) -> Iterator[Failure]:
    if size > widened:
        beside = f" beside noise of {noise:.1e}{unit}" if noise else ""
        most = f"allowed {limit:.2e}{unit}{beside}"
        excess = size / widened if widened else math.inf
        yield Failure(name, found, most, limit.reason, excess, weight, overall)


def _more(name: str, found: str, count: int, limit: Limit, most: float) -> Iterator[Failure]:
    """More stations than the fraction of them that may be so."""
    if count > most:
        excess = count / most if most else math.inf
        yield Failure(name, found, f"allowed {limit:.1%}", limit.reason, excess)


def _components(
    found: Measurement | SpatialMeasurement, limits: Limits, noise: Allowance, place: str
) -> Iterator[Failure]:
    """Root mean squares and the largest differences, at a place along the travel [L]."""
    length, (size, _) = found.reference.beam.length, found.reference.running_unit
    for name, one in found.disagreement.items():
        level = noise.level[name]
        if level > _DROWNS and name in noise.unsure:
            said = f"jumps from station to station by {level:.0%} of its largest magnitude"
            most = f"beyond {_DROWNS:.0%} no agreement shows; state the noise, or add stations"
            yield Failure(name, said, most, excess=level / _DROWNS, weight=_READINGS)
        most = max(one.rms_by_phase, key=one.rms_by_phase.__getitem__, default="")
        which = f", most in phase {most}" if most else ""
        asked = [(which, one.rms, limits.of(name, "rms"), one.stations, True)]
        for phase, rms in one.rms_by_phase.items():
            if (special := limits.of_phase(name, phase)) is not None:
                stations = one.stations_by_phase[phase]
                asked.append((f" in phase {phase}", rms, special, stations, False))
        for where, rms, limit, stations, all_ in asked:
            widened = noise.rms(limit, name, stations)
            said = f"rms {rms:.2e} of its largest magnitude{where}"
            yield from _beyond(
                name, said, rms, limit, widened, level, weight=_READINGS, overall=all_
            )
        for phase, peak in one.peaks.items():
            limit = limits.of(name, "max", phase)
            widened = noise.max(limit, name, one.stations)
            at = place.format(peak.at / size)
            said = f"off by {peak.size:.2e} of its largest magnitude at {at}"
            if phase:
                said += f" in phase {phase}"
            if not math.isnan(peak.arc_length):
                said += f", arc length {peak.arc_length / length:.4g} L"
            yield from _beyond(name, said, peak.size, limit, widened, level, weight=_READINGS)
        if one.idle is not None:
            why = "as at any one station: a clamp at rest reads its load alone"
            limit = Limit(limits.of(name, "max"), why)
            at = place.format(one.idle.at / size)
            said = f"off by {one.idle.size:.2e} of its largest magnitude at {at}, where one is free"
            widened = noise.max(limit, name, one.stations)
            yield from _beyond(name, said, one.idle.size, limit, widened, level, weight=_READINGS)


def _next_to_snap_off(
    found: Measurement, limits: Tolerances, noise: NoiseAllowance
) -> Iterator[Failure]:
    """In the window before the snap-off, where no rms is taken.

    There a station in motion, which is a mean over its way, takes in the snap-off.
    """
    if "motion" in found.candidate.provenance:
        return
    for name, one in found.disagreement.items():
        near = one.max_before_snap_off
        if not math.isnan(near * one.fold):
            limit = at_most_next_to_snap_off(found, name, limits)
            said = f"off by {near:.2e} of its largest magnitude next to the snap-off"
            widened = noise.max(limit, name, one.stations)
            level = noise.level[name]
            yield from _beyond(name, said, near, limit, widened, level, weight=_READINGS)


def at_most_next_to_snap_off(found: Measurement, name: str, limits: Tolerances) -> Limit:
    """The largest difference of a reading there; NaN if it is not known.

    Of 250 random sweeps with another place of the foot, by up to `snap_off`, two in three are off
    by more than `max` there, and none by more than 0.7 of this.
    """
    one, snap = found.disagreement[name], found.snap_off
    most = _of_snap_off(found, limits.limits()) * found.reference.running_unit[0]
    apart = max(most, abs(snap.difference or 0.0)) + snap.uncertainty
    why = "as at any one station, and what a snap-off as early or late as it may be adds"
    return Limit(limits.of(name, "max") + one.fold * math.sqrt(apart), why)


def _phases(
    name: str, found: str, right: float, limit: Limit, clear: float = 1.0
) -> Iterator[Failure]:
    """Of no excess: the headline only if nothing else fails."""
    if right < limit * clear:
        yield Failure(name, found, f"asked {limit:.1%}", limit.reason, 1.0)


def _events(
    found: Measurement | SpatialMeasurement,
    events: Mapping[str, tuple[Occurrence, Limit]],
    beyond: Iterable[str] = (),
    unknown: Iterable[str] = (),
) -> Iterator[Failure]:
    size, unit = found.reference.running_unit
    for name, (event, limit) in events.items():
        if event.agrees(limit * size):
            continue
        if event.difference is not None:
            wide = event.uncertainty / size
            apart = event.difference / size
            said = f"{apart:+.2e} {unit} apart" + (f" +- {wide:.1e} {unit}" if wide else "")
            yield from _beyond(name, said, abs(apart), limit, limit + wide, unit=f" {unit}")
            continue
        which, other, at = "reference", "candidate", event.reference
        if at is None:
            which, other, at = "candidate", "reference", event.candidate
        said = f"only in the {which}, at {(at or 0.0) / size:.5g} {unit}"
        if name in beyond:
            said += ", beyond the stretch that the candidate covers"
        if name in unknown:
            said += f", where stations of the {other} are not to be trusted"
        weight = _FOLLOWS if name in unknown else 0
        yield Failure(name, said, f"allowed {limit:.2e} {unit}", limit.reason, weight=weight)


def _stations(untrusted: int, stations: int, limit: Limit, why: str) -> Iterator[Failure]:
    said = f"{untrusted} of {stations} are not to be trusted" + (f" ({why})" if why else "")
    yield from _more("stations", said, untrusted, limit, limit * stations)


def _offset(found: Measurement) -> Iterator[Failure]:
    if found.offset.unknown:
        said = f"none was found ({found.offset.unknown}): compared without one"
        todo = "see the cause, sweep more of the contact, or give the offset as a number"
        yield Failure("offset", said, todo, weight=_FOLLOWS)


def _order(found: Measurement) -> Iterator[Failure]:
    if found.order.note is not None:
        todo = f"write the rows and {found.order.column} as the motion goes"
        yield Failure("order", found.order.note, todo, weight=_FIRST)
    if found.order.opposite:
        yield Failure(
            "direction",
            f"{found.order.column} and moment_z of the candidate run opposite to the reference's",
            "compare with a reference swept the same way (`[sweep] direction`), or with the mirror "
            "image (`Readings.mirrored`) if the object is symmetric",
            weight=_FIRST,
        )


def _contact(found: Measurement) -> Iterator[Failure]:
    counts = found.alignment.counts
    if next(iter(found.disagreement.values())).stations:
        return
    touching = int((found.judged["reference"].phase != "free").sum())
    reasons = ", ".join(f"{n} {reason}" for reason, n in counts.items() if n)
    said = f"no station in contact in both sweeps ({reasons})"
    if counts["compared"]:
        said = f"all {counts['compared']} stations in contact in both are next to the snap-off"
    elif counts["one_free"] and not counts["untrusted"]:
        of_all = f"{touching} stations where the reference's is loaded"
        said = f"the candidate's clamp reads no load above its noise at any of the {of_all}"
    todo = "sweep a stretch where both touch, or see why stations are not trusted"
    yield Failure("contact", said, todo, weight=_FIRST)


def _of_snap_off(found: Measurement, limits: Mapping[str, Limit]) -> Limit:
    """A sweep in motion may let go later than one at rest, but no earlier."""
    apart, limit, late = found.snap_off.difference, limits["snap_off"], limits["lateness"]
    if apart is None or not late or direction(found.reference) * apart <= 0:
        return limit
    return Limit(limit + late, f"{limit:.1e} early or late ({limit.reason}); late, {late.reason}")


def _absent(found: Measurement) -> int:
    """How many rows the candidate would have where the reference touches, and has not."""
    at = np.sort(found.reference.running_values[found.judged["reference"].phase != "free"])
    own = found.candidate.running_values
    holes = found.records["candidate"].holes.items()
    within = (np.diff(np.searchsorted(at, np.sort(own[i : i + 2])))[0] for i, _ in holes)
    return sum(count for (_, count), some in zip(holes, within, strict=True) if some)


def _cut_off(found: Measurement) -> Iterator[Failure]:
    (size, unit), running = found.reference.running_unit, found.reference.running
    for end, touching, rows in found.cut_off():
        said = (
            f"the candidate's stations end at {running} = {end / size:.4g} {unit}, and the "
            f"reference touches as far as {touching / size:.4g} {unit}: some {rows} rows are not "
            "there"
        )
        todo = "sweep both over one stretch, or the reference over that of the candidate"
        yield Failure("stretch", said, todo)


def _reasons(found: Measurement, absent: int) -> Iterator[str]:
    """Why stations of the candidate are not to be trusted, and where."""
    if absent:
        after = max((rows := found.records["candidate"].holes), key=rows.__getitem__)
        size, unit = found.candidate.running_unit
        one, other = found.candidate.running_values[after : after + 2] / size
        yield (f"some {absent} of them are not there: {found.candidate.running} leaps from "
               f"{one:.4g} to {other:.4g} {unit}")  # fmt: skip
    if missing := int(found.records["candidate"].missing.sum()):
        yield f"{missing} of them lack a number"
    if dropped := found.alignment.counts["dropped"]:
        yield f"{dropped} of them are filled with zeros amid contact"
    yield from untrusted_stretches(found.candidate)


def untrusted_stretches(readings: Readings | SpatialReadings) -> Iterator[str]:
    """Which stations a sweep itself does not trust, and where."""
    if "status" not in readings.table:
        return
    name, (size, unit) = readings.running, readings.running_unit
    table = readings.table.assign(**{name: readings.running_values})
    for status, along in table.groupby("status", sort=False)[name]:
        if status != "ok":
            first, last = along.iloc[[0, -1]] / size
            yield f"{len(along)} {status}, {name} {first:.4g} to {last:.4g} {unit}"
