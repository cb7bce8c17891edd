"""What exceeds the limits of agreement in space: where, by how much and why so."""

import math
from collections.abc import Iterator

from compare.judge.failures import Failure
from compare.judge.tolerances import Limit
from compare.spatial.measured import SpatialMeasurement


def failures(found: SpatialMeasurement) -> Iterator[Failure]:
    """Every limit that is exceeded."""
    if not found.compared.any():
        counts = f"reference {found.statuses['reference']}, candidate {found.statuses['candidate']}"
        yield Failure(
            "contact",
            f"at no station do both touch ({counts})",
            "there is no station at which both touch",
            "no station can be compared",
        )
    yield from _components(found)
    yield from _contacts(found)
    yield from _events(found)
    limits = found.tolerances.limits()
    limit = limits["untrusted"]
    every = int(found.reference.trusted.sum())
    if found.untrusted > limit * every:
        yield Failure(
            "stations",
            f"{found.untrusted} of {every} without readings that the reference has",
            f"{found.untrusted} of {every} stations lack readings where {float(limit):.1%} may",
            f"allowed {float(limit):.1%} ({limit.reason})",
            _ratio(found.untrusted, limit * every),
        )


def _components(found: SpatialMeasurement) -> Iterator[Failure]:
    length = found.reference.beam.length
    for name, one in found.disagreement.items():
        for kind, size in (("rms", one.rms), ("max", one.max)):
            limit = found.tolerances.of(name, kind)
            noise, stations = found.noise.readings, int(found.compared.sum())
            widen = noise.rms if kind == "rms" else noise.max
            widened = widen(limit, name, stations)
            if not size > widened:
                continue
            beside = _beside(noise.level[name])
            where = f" at {one.at / length:.4g} L of the way" if kind == "max" else ""
            phase = f", phase {one.phase}" if kind == "max" and one.phase else ""
            yield Failure(
                name,
                f"{kind} {size:.2e} of the largest component{where}{phase}",
                f"{name} is off by {size:.1e} {kind}{where} where {float(limit):.1e} is "
                f"allowed{beside}",
                f"allowed {float(limit):.2e}{beside} ({limit.reason})",
                _ratio(size, widened),
            )


def _contacts(found: SpatialMeasurement) -> Iterator[Failure]:
    limits, one = found.tolerances.limits(), found.contact
    limit, noise = limits["contact"], found.noise
    widened, beside = math.hypot(limit, noise.contact), _beside(noise.contact, " L")
    if one.rms > widened:
        yield Failure(
            "contact",
            f"{one.rms:.2e} L rms, {one.max:.1e} L at most",
            f"the contact is off by {one.rms:.1e} L rms where {float(limit):.1e} L is "
            f"allowed{beside}",
            f"allowed {float(limit):.2e} L{beside} ({limit.reason})",
            _ratio(one.rms, widened),
        )
    unknown, some = one.asked - one.stations, limits["untrusted"]
    most = (some + noise.unknown) * one.asked
    if unknown > most:
        yield Failure(
            "contact",
            f"at {unknown} of {one.asked} compared stations the clamp's readings are of no contact",
            f"{unknown} of {one.asked} readings are of no contact",
            f"allowed {float(some):.1%} ({some.reason})",
            _ratio(unknown, most),
        )
    share, asked = found.phase_agreement, limits["phase_agreement"]
    if share is not None and share < asked:
        yield Failure(
            "phases",
            f"{share:.1%} of the compared stations are in the same phase",
            f"{share:.1%} of the phases agree where {float(asked):.1%} must",
            f"asked {float(asked):.1%} ({asked.reason})",
            1.0,  # it follows from the readings: the headline only if nothing else fails
        )


def _events(found: SpatialMeasurement) -> Iterator[Failure]:
    length = found.reference.beam.length
    limit = found.tolerances.limits()["event"]
    for name, pair in found.events.items():
        if pair.agrees(limit * length):
            continue
        allowed = f"allowed {float(limit):.2e} L ({limit.reason})"
        if pair.difference is None:
            here = found.candidate if pair.reference is None else found.reference
            at = pair.candidate if pair.reference is None else pair.reference
            place = f"only in {here.source}, at {math.nan if at is None else at / length:.5g} L"
            yield Failure(name, f"{place} of the way", f"{name} is {place}", allowed)
            continue
        apart, wide = pair.difference / length, pair.uncertainty / length
        beside = f" +- {wide:.1e}" if wide else ""
        yield Failure(
            name,
            f"{apart:+.2e}{beside} L apart",
            f"{name} is {apart:+.1e}{beside} L away where {float(limit):.1e} L is allowed",
            allowed,
            _ratio(abs(apart), limit + wide),
        )


def _beside(noise: float, unit: str = "") -> str:
    return f" beside noise of {noise:.1e}{unit}" if noise else ""


def _ratio(found: float, allowed: Limit | float) -> float:
    return float(found / allowed) if allowed > 0 else math.inf
