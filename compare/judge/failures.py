"""What exceeds the limits of agreement, in sentences that say where, by how much and why so."""

from collections.abc import Iterator, Mapping

from analytic import Readings
from compare.judge.allowance import NoiseAllowance
from compare.judge.failure import Failure, allowed, excess, plus_minus, where_allowed
from compare.judge.tolerances import Limit, Tolerances
from compare.measure.disagreement import Disagreement
from compare.measure.measurement import Measurement
from compare.sense.record import direction


def failures(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> Iterator[Failure]:
    """Every limit that is exceeded: what, where, how much, how much is allowed, and why so."""
    yield from _record(found)
    yield from _contact(found)
    for name, d in found.disagreement.items():
        yield from _reading(name, d, limits, noise)
    yield from _phases(found, limits, noise)
    yield from _events(found, limits)
    yield from _stations(found, limits)


def _record(found: Measurement) -> Iterator[Failure]:
    record = found.records["candidate"]
    if found.order.note is not None:
        wrong, _, compared = found.order.note.partition("; ")
        steps = f" ({record.retreats} of {len(record.missing) - 1} steps lead back)"
        yield Failure(
            "order",
            wrong + (steps if record.retreats else "") + f"; {compared}",
            f"its {wrong}",
            "write the rows in the order of the motion"
            if found.order.backwards_from is None
            else "write foot_x as it counts in the world, along x",
        )
    if found.order.opposite:
        yield Failure(
            "direction",
            "foot_x and moment_z of the candidate run opposite to the reference's",
            "it was swept in the opposite direction",
            "compare with a reference swept the same way (`[sweep] direction`), or with the mirror "
            "image (`Readings.mirrored`) if the object is symmetric",
        )


def _contact(found: Measurement) -> Iterator[Failure]:
    counts = found.alignment.counts
    compared = next(iter(found.disagreement.values())).stations
    if compared:
        return
    if counts["compared"]:
        yield Failure(
            "contact",
            f"all {counts['compared']} stations in contact in both sweeps lie in the window before "
            "the snap-off",
            "no station can be compared but just before the snap-off",
            "sweep more stations",
        )
        return
    touching = int((found.judged["reference"].phase != "free").sum())
    if not (found.judged["candidate"].phase == "").all() and counts["one_free"]:
        yield Failure(
            "contact",
            f"the candidate touches at none of the {touching} stations where the reference does",
            f"it touches at none of the {touching} stations where the reference does",
            "it must touch where the reference touches",
        )
        return
    reasons = ", ".join(f"{n} {reason}" for reason, n in counts.items() if n)
    yield Failure(
        "contact",
        f"no station in contact in both sweeps ({reasons})",
        f"no station can be compared ({reasons})",
        "sweep a stretch where both touch, or see why stations are not trusted",
    )


def _reading(
    name: str, d: Disagreement, limits: Tolerances, noise: NoiseAllowance
) -> Iterator[Failure]:
    limit = limits.of_sweep(name)
    widened = noise.rms(limit, name, d.stations)
    if d.rms > widened:
        worst = max(d.rms_by_phase, key=lambda phase: d.rms_by_phase[phase])
        yield Failure(
            name,
            f"rms {d.rms:.2e} of its largest magnitude, most in phase {worst} "
            f"({d.rms_by_phase[worst]:.2e})",
            f"{name} is off by {d.rms:.1e} rms{where_allowed(limit, noise.level[name])}, "
            f"most in phase {worst}",
            allowed(limit, noise.level[name]),
            excess(d.rms, widened),
        )
    for phase, rms in d.rms_by_phase.items():
        asked = limits.of_phase(name, phase)
        if asked is None:
            continue
        widened = noise.rms(asked, name, d.stations_by_phase[phase])
        if rms > widened:
            yield Failure(
                name,
                f"rms {rms:.2e} of its largest magnitude in phase {phase}",
                f"{name} is off by {rms:.1e} rms in phase {phase}"
                f"{where_allowed(asked, noise.level[name])}",
                allowed(asked, noise.level[name]),
                excess(rms, widened),
            )
    for phase, peak in d.peaks.items():
        limit = limits.of_reading("max", name, phase)
        widened = noise.max(limit, name, d.stations)
        if peak.size > widened:
            yield Failure(
                name,
                f"off by {peak.size:.2e} of its largest magnitude at foot_x = {peak.at:.6g} in "
                f"phase {phase}, the contact at arc length {peak.arc_length:.4g}",
                f"{name} is off by {peak.size:.1e} at foot_x = {peak.at:.6g}"
                f"{where_allowed(limit, noise.level[name])}",
                allowed(limit, noise.level[name]),
                excess(peak.size, widened),
            )


def _phases(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> Iterator[Failure]:
    limit = limits.limits()["phase_agreement"]
    for which, right in found.phase_agreement().items():
        if right < limit * noise.phase_agreement:
            yield Failure(
                f"phases of the {which}",
                f"{right:.1%} judged rightly from the clamp",
                f"{right:.1%} of the {which}'s phases follow from its clamp readings where "
                f"{float(limit):.1%} must",
                f"asked {float(limit):.1%} ({limit.reason})",
                1.0,  # it follows from the readings: the headline only if nothing else fails
            )


def _events(found: Measurement, tolerances: Tolerances) -> Iterator[Failure]:
    limits, length = tolerances.limits(), found.reference.beam.length
    beyond = found.beyond()
    events = {name: (event, limits["transition"]) for name, event in found.transitions.items()}
    events["snap_off"] = found.snap_off, _of_snap_off(found, limits)
    for name, (event, limit) in events.items():
        if event.agrees(limit * length):
            continue
        most = allowed(Limit(limit * length, limit.reason))
        if event.difference is None:
            which = "candidate" if event.candidate is None else "reference"
            covers = f", beyond the stretch {_stretch(found)}" if name in beyond else ""
            yield Failure(
                name,
                f"at foot_x = {_position(event.candidate)} instead of {_position(event.reference)}"
                f"{covers}",
                f"{name} is missing in the {which}{covers}",
                most,
            )
            continue
        yield Failure(
            name,
            f"at foot_x = {_position(event.candidate)} instead of {_position(event.reference)}, "
            f"{event.difference:+.2e}{plus_minus(event.uncertainty)} apart",
            f"{name} is {event.difference:+.1e} away{where_allowed(Limit(limit * length))}",
            most,
            excess(abs(event.difference), limit * length + event.uncertainty),
        )


def _of_snap_off(found: Measurement, limits: Mapping[str, Limit]) -> Limit:
    """A sweep in motion may let go later than one at rest, but no earlier."""
    apart, limit, late = found.snap_off.difference, limits["snap_off"], limits["lateness"]
    if apart is None or not late or direction(found.reference) * apart <= 0:
        return limit
    return Limit(limit + late, f"{limit:.1e} early or late ({limit.reason}); late, {late.reason}")


def _stations(found: Measurement, limits: Tolerances) -> Iterator[Failure]:
    limit = limits.limits()["untrusted"]
    counts, all_ = found.alignment.counts, len(found.candidate.table)
    untrusted = counts["untrusted"] + counts["dropped"]
    if untrusted <= limit * all_:
        return
    missing = int(found.records["candidate"].missing.sum())
    reasons = [f"{missing} of them lack a number"] if missing else []
    if counts["dropped"]:
        reasons.append(f"{counts['dropped']} of them are filled with zeros amid contact")
    reasons += _statuses(found.candidate)
    why = f" ({'; '.join(reasons)})" if reasons else ""
    yield Failure(
        "stations",
        f"{untrusted} of {all_} of the candidate are not to be trusted{why}",
        f"{untrusted} of its {all_} stations are not to be trusted{why} where {float(limit):.1%} "
        "may be",
        f"allowed {float(limit):.1%} ({limit.reason})",
        excess(untrusted, limit * all_),
    )


def _statuses(readings: Readings) -> Iterator[str]:
    """How many stations have which status that speaks against them, and where."""
    if "status" not in readings.table:
        return
    length = readings.beam.length
    for status, foot_x in readings.table.groupby("status", sort=False)["foot_x"]:
        if status != "ok":
            where = f"{foot_x.iloc[0] / length:.4g} to {foot_x.iloc[-1] / length:.4g} L"
            yield f"{len(foot_x)} {status}, foot_x {where}"


def _stretch(found: Measurement) -> str:
    foot_x = found.candidate.values("foot_x")
    return f"that it covers, {_position(foot_x.min())} to {_position(foot_x.max())}"


def _position(x: float | None) -> str:
    return "nowhere" if x is None else f"{x:.6g}"
