"""What exceeds the limits of agreement, in sentences that say where, by how much and why so."""

from collections.abc import Iterator

from compare.judge.allowance import NoiseAllowance
from compare.judge.tolerances import Limit, Tolerances
from compare.measure.disagreement import Disagreement
from compare.measure.measurement import Measurement


def failures(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> Iterator[str]:
    """Every limit that is exceeded: what, where, how much, how much is allowed, and why so."""
    for name, d in found.disagreement.items():
        yield from _reading(name, d, limits, noise)
    yield from _phases(found, limits, noise)
    yield from _places(found, limits)
    yield from _stations(found, limits)


def _reading(
    name: str, d: Disagreement, limits: Tolerances, noise: NoiseAllowance
) -> Iterator[str]:
    limit = limits.of_sweep(name)
    if d.rms > noise.rms(limit, name, sum(d.stations_by_phase.values())):
        worst = max(d.rms_by_phase, key=lambda phase: d.rms_by_phase[phase])
        yield (
            f"{name}: rms {d.rms:.2e} of its largest magnitude, most in phase {worst} "
            f"({d.rms_by_phase[worst]:.2e}); {_allowed(limit, noise.level[name])}"
        )
    for phase, rms in d.rms_by_phase.items():
        asked = limits.of_phase(name, phase)
        if asked is not None and rms > noise.rms(asked, name, d.stations_by_phase[phase]):
            yield (
                f"{name}: rms {rms:.2e} of its largest magnitude in phase {phase}; "
                f"{_allowed(asked, noise.level[name])}"
            )
    for phase, peak in d.peaks.items():
        limit = limits.of_reading("max", name, phase)
        if peak.size > noise.max(limit, name, sum(d.stations_by_phase.values())):
            yield (
                f"{name}: off by {peak.size:.2e} of its largest magnitude at foot_x = "
                f"{peak.at:.6g} in phase {phase}, the contact at arc length {peak.arc_length:.4g}; "
                f"{_allowed(limit, noise.level[name])}"
            )


def _phases(found: Measurement, limits: Tolerances, noise: NoiseAllowance) -> Iterator[str]:
    limit = limits.limits()["phase_agreement"]
    for which, share in found.phase_agreement().items():
        if share < limit * noise.phase_agreement:
            yield (
                f"phases of the {which}: {share:.1%} judged rightly from the clamp, "
                f"asked {float(limit):.1%} ({limit.reason})"
            )


def _places(found: Measurement, tolerances: Tolerances) -> Iterator[str]:
    limits, length = tolerances.limits(), found.reference.beam.length
    places = {name: (place, limits["transition"]) for name, place in found.transitions.items()}
    places["snap_off"] = found.snap_off, limits["snap_off"]
    for name, (place, limit) in places.items():
        if not place.agrees(limit * length):
            wide = f" +- {place.uncertainty:.1e}" if place.uncertainty else ""
            apart = "" if place.difference is None else f", {place.difference:+.2e}{wide} apart"
            yield (
                f"{name}: at foot_x = {_told(place.candidate)} instead of "
                f"{_told(place.reference)}{apart}; {_allowed(Limit(limit * length, limit.reason))}"
            )


def _stations(found: Measurement, limits: Tolerances) -> Iterator[str]:
    limit = limits.limits()["untrusted"]
    untrusted, all_ = found.alignment.counts["untrusted"], len(found.candidate.table)
    if untrusted > limit * all_:
        yield (
            f"stations: {untrusted} of {all_} of the candidate are not to be trusted, "
            f"allowed {float(limit):.1%} ({limit.reason})"
        )


def _allowed(limit: Limit, noise: float = 0.0) -> str:
    beside = f" beside noise of {noise:.1e}" if noise else ""
    return f"allowed {float(limit):.2e}{beside} ({limit.reason})"


def _told(x: float | None) -> str:
    return "nowhere" if x is None else f"{x:.6g}"
