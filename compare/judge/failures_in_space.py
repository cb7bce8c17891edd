"""What exceeds the limits of agreement in space."""

import math
from collections.abc import Iterator

from compare.judge.allowance import SpatialAllowance
from compare.judge.failure import Failure, allowed, excess, plus_minus, where_allowed
from compare.judge.spatial import SpatialTolerances
from compare.measure.in_space import SpatialMeasurement


def failures_in_space(
    found: SpatialMeasurement, limits: SpatialTolerances, noise: SpatialAllowance
) -> Iterator[Failure]:
    """Every limit that is exceeded: what, where, how much, how much is allowed, and why so."""
    if not found.compared.any():
        counts = f"reference {found.statuses['reference']}, candidate {found.statuses['candidate']}"
        yield Failure(
            "contact",
            f"at no station do both touch ({counts})",
            "there is no station at which both touch",
            "no station can be compared",
        )
    yield from _components(found, limits, noise)
    yield from _contacts(found, limits, noise)
    yield from _phases(found, limits)
    yield from _events(found, limits)
    yield from _stations(found, limits)


def _components(
    found: SpatialMeasurement, limits: SpatialTolerances, noise: SpatialAllowance
) -> Iterator[Failure]:
    length, stations = found.reference.beam.length, int(found.compared.sum())
    for name, one in found.disagreement.items():
        for kind, size, widen in (("rms", one.rms, noise.rms), ("max", one.max, noise.max)):
            limit, level = limits.of(name, kind), noise.level[name]
            widened = widen(limit, name, stations)
            if not size > widened:
                continue
            where = f" at {one.at / length:.4g} L of the way" if kind == "max" else ""
            phase = f", phase {one.phase}" if kind == "max" and one.phase else ""
            yield Failure(
                name,
                f"{kind} {size:.2e} of the largest component{where}{phase}",
                f"{name} is off by {size:.1e} {kind}{where}{where_allowed(limit, level)}",
                allowed(limit, level),
                excess(size, widened),
            )


def _contacts(
    found: SpatialMeasurement, limits: SpatialTolerances, noise: SpatialAllowance
) -> Iterator[Failure]:
    one, limit = found.contact, limits.limits()["contact"]
    widened = math.hypot(limit, noise.contact)
    if one.rms > widened:
        yield Failure(
            "contact",
            f"{one.rms:.2e} L rms, {one.max:.1e} L at most",
            f"the contact is off by {one.rms:.1e} L rms{where_allowed(limit, noise.contact, ' L')}",
            allowed(limit, noise.contact, " L"),
            excess(one.rms, widened),
        )
    unknown, some = one.asked - one.stations, limits.limits()["untrusted"]
    most = (some + noise.unknown) * one.asked
    if unknown > most:
        yield Failure(
            "contact",
            f"at {unknown} of {one.asked} compared stations the clamp's readings are of no contact",
            f"{unknown} of {one.asked} readings are of no contact",
            f"allowed {float(some):.1%} ({some.reason})",
            excess(unknown, most),
        )


def _phases(found: SpatialMeasurement, limits: SpatialTolerances) -> Iterator[Failure]:
    alike, asked = found.phase_agreement, limits.limits()["phase_agreement"]
    if alike is not None and alike < asked:
        yield Failure(
            "phases",
            f"{alike:.1%} of the compared stations are in the same phase",
            f"{alike:.1%} of the phases agree where {float(asked):.1%} must",
            f"asked {float(asked):.1%} ({asked.reason})",
            1.0,  # it follows from the readings: the headline only if nothing else fails
        )


def _events(found: SpatialMeasurement, limits: SpatialTolerances) -> Iterator[Failure]:
    length, limit = found.reference.beam.length, limits.limits()["event"]
    for name, event in found.events.items():
        if event.agrees(limit * length):
            continue
        if event.difference is None:
            here = found.candidate if event.reference is None else found.reference
            at = event.candidate if event.reference is None else event.reference
            place = f"only in {here.source}, at {math.nan if at is None else at / length:.5g} L"
            text, clause, size = f"{place} of the way", f"{name} is {place}", math.inf
        else:
            apart, wide = event.difference / length, event.uncertainty / length
            text = f"{apart:+.2e}{plus_minus(wide)} L apart"
            clause = (
                f"{name} is {apart:+.1e}{plus_minus(wide)} L away{where_allowed(limit, unit=' L')}"
            )
            size = excess(abs(apart), limit + wide)
        yield Failure(name, text, clause, allowed(limit, unit=" L"), size)


def _stations(found: SpatialMeasurement, limits: SpatialTolerances) -> Iterator[Failure]:
    limit, every = limits.limits()["untrusted"], int(found.reference.trusted.sum())
    if found.untrusted > limit * every:
        yield Failure(
            "stations",
            f"{found.untrusted} of {every} without readings that the reference has",
            f"{found.untrusted} of {every} stations lack readings where {float(limit):.1%} may",
            f"allowed {float(limit):.1%} ({limit.reason})",
            excess(found.untrusted, limit * every),
        )
