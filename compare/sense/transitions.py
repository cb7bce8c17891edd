"""Where one phase gives way to the next, located between stations from clamp readings alone."""

from collections.abc import Mapping

import numpy as np

from analytic import Readings
from analytic.numerics.arrays import Booleans, Floats, Integers
from compare.sense.phases import Classification

TRANSITIONS = ("first_contact", "phase_b_start", "phase_b_end")
SECOND = ("second_contact_start", "second_contact_end")
_FIT = 3  # stations on either side that a parabola is laid through
_TINY = 1e-290  # values that differ by less cannot be scaled for the fit
_ALIKE = 1e-9  # of the span of all: two values that are nearer to each other are one


def locate_transitions(
    readings: Readings, judged: Classification
) -> Mapping[str, tuple[float | None, float]]:
    """Places along the sweep of the transitions, and how far they may be off.

    None is the place of a transition that does not occur.

    Phase B is the one stretch that agrees best with the judged phases, so that single stations that
    noise put on the wrong side move nothing; where another one does nearly, so far it may be off.
    At its ends the criterion (26), which is zero inside, is extrapolated to zero from outside, and
    the shortfall of the contact, which is zero outside, from inside; the limit is half-way between
    the two results, which differ where a contact jumps. First contact is where the clamp moment,
    extrapolated from the first two loaded stations, vanishes; what a third one changes says how far
    that is off, as it does at the limits. In motion, where the vibrissa's mass loads the clamp
    without contact, it is where the source recorded it, and stations before it and behind the
    snap-off show no phase.
    """
    at = readings.running_values
    moving = "motion" in readings.provenance
    loaded = np.isin(judged.phase, ("tip", "tangent"))
    touching = np.flatnonzero(loaded & _in_contact(readings) if moving else loaded)
    found: dict[str, tuple[float | None, float]] = dict.fromkeys(TRANSITIONS, (None, 0.0))
    if touching.size < 2:
        return found
    moment = readings.values("moment_z")
    if moving:
        found["first_contact"] = _recorded(readings, at), 0.0
    elif (free := np.flatnonzero(judged.phase[: touching[0]] == "free")).size:
        line, curve = (_zero(at, moment, touching[:n], free[-1], touching[0]) for n in (2, _FIT))
        found["first_contact"] = line, abs(line - curve)
    votes = np.where(judged.phase[touching] == "tangent", 1, -1)
    begin, end = _best_stretch(votes)
    inside = touching[begin:end]
    before, after = touching[:begin], touching[end:]
    begins, ends = (at[touching[rivals]] for rivals in _rivals(votes, begin, end))
    if inside.size and before.size:
        place, off = _limit(at, judged, before[::-1], inside)
        found["phase_b_start"] = place, max(off, float(np.abs(begins - at[inside[0]]).max()))
    if inside.size and after.size:
        place, off = _limit(at, judged, after, inside[::-1])
        found["phase_b_end"] = place, max(off, float(np.abs(ends - at[inside[-1]]).max()))
    return found


def shows_beyond(
    name: str, place: float, off: float, readings: Readings, judged: Classification
) -> bool:
    """Whether stations touch beyond a limit of Phase B, by more than it may be off.

    The tip may hold for less than a station before the snap-off, or after the first contact. Where
    it is not free beyond the last station that touches, nothing excuses a sweep.
    """
    at = readings.running_values
    touching = np.flatnonzero(np.isin(judged.phase, ("tip", "tangent")))
    if not touching.size:
        return True
    way, last = (1, touching.max()) if name == "phase_b_end" else (-1, touching.min())
    ahead = way * np.sign(at[-1] - at[0]) * (at[touching] - place)
    free = judged.phase[last + way : last + way + 1] == "free"
    return bool((ahead > off + _ALIKE * np.ptp(at)).any() or not free.any())


def snap_off(readings: Readings, judged: Classification) -> tuple[float | None, float]:
    """Where along the sweep the snap-off is, and how far it may be off.

    The source's own value where it located one; else half-way between the last station in contact
    and the next free one, give or take half of that way. None if the sweep ends in contact.
    """
    if readings.snap_off is not None:
        return readings.snap_off, 0.0
    at = readings.running_values
    touching = np.flatnonzero(np.isin(judged.phase, ("tip", "tangent")))
    free = np.flatnonzero(judged.phase == "free")
    free = free[free > touching[-1]] if touching.size else touching
    if free.size == 0:
        return None, 0.0
    one, other = at[touching[-1]], at[free[0]]
    return float(one + other) / 2, float(abs(one - other)) / 2


def second_contacts(readings: Readings) -> dict[str, tuple[float | None, float]] | None:
    """Where along the sweep a second contact begins and ends, and how far that may be off.

    The source's own values where it locates them, as far as it could; else half-way between
    stations. None if it does not look for one, and for an end that is the snap-off.
    """
    recorded = readings.provenance.get("events", {})
    known = {name: (recorded[name], 0.0) for name in SECOND if name in recorded}
    if known or "second_contact_x" not in readings.table:
        return known or None
    found: dict[str, tuple[float | None, float]] = dict.fromkeys(SECOND, (None, 0.0))
    at = readings.running_values
    touching = np.flatnonzero(np.isfinite(readings.values("contact_x")))
    second = np.isfinite(readings.values("second_contact_x"))[touching]
    for name, change in zip(SECOND, (1, -1), strict=True):
        changes = np.flatnonzero(np.diff(second.astype(int)) == change)
        if changes.size:
            one, other = at[touching[changes[0 if change > 0 else -1] + np.arange(2)]]
            found[name] = float(one + other) / 2, float(abs(one - other)) / 2
    return found


def _in_contact(readings: Readings) -> Booleans:
    """Stations from the first contact to the snap-off, as far as the source recorded them."""
    at = readings.running_values
    sign = np.sign(at[-1] - at[0])
    first = readings.provenance.get("events", {}).get("first_contact")
    begin = sign * at[0] if first is None else sign * first
    end = sign * at[-1] if readings.snap_off is None else sign * readings.snap_off
    return np.asarray((begin <= sign * at) & (sign * at <= end))


def _recorded(readings: Readings, at: Floats) -> float | None:
    """The first contact by the source's own word, if a station comes before it."""
    place = readings.provenance.get("events", {}).get("first_contact")
    first, last = at[0], at[-1]
    return None if place is None or (first - place) * (place - last) < 0 else float(place)


def _best_stretch(votes: Integers) -> tuple[int, int]:
    """The slice with the largest sum; empty if no vote is positive."""
    sums = np.append(0, np.cumsum(votes))
    least = np.minimum.accumulate(sums)
    end = int(np.argmax(sums - least))
    return int(np.argmin(sums[: end + 1])), end


def _rivals(votes: Integers, begin: int, end: int) -> tuple[Integers, Integers]:
    """First and last stations of stretches that other stations might have preferred.

    Past corners there are several; each change between one end and another may be a station off.
    """
    sums = np.append(0, np.cumsum(votes))
    changes = np.append(0, np.cumsum(votes[1:] != votes[:-1]))
    best = sums[end] - sums[begin]
    first = np.flatnonzero(votes == 1)
    from_here = np.maximum.accumulate(sums[::-1])[::-1][first + 1] - sums[first]
    to_here = sums[first + 1] - np.minimum.accumulate(sums)[first]
    return tuple(
        first[scores >= best - np.abs(changes[first] - changes[chosen])]
        for scores, chosen in ((from_here, begin), (to_here, end - 1))
    )


def _limit(
    at: Floats, judged: Classification, tip: Integers, tangent: Integers
) -> tuple[float, float]:
    """A limit of Phase B between stations on either side, the nearest ones first."""
    sides = (judged.criterion, tip), (judged.shortfall, tangent)
    curves, lines = (
        [_zero(at, values, stations[:n], tip[0], tangent[0]) for values, stations in sides]
        for n in (_FIT, 2)
    )
    place = sum(curves) / 2
    return place, max(abs(one - place) for one in (*curves, *lines))


def _zero(at: Floats, values: Floats, stations: Integers, one: int, other: int) -> float:
    """Where `values` through `stations` vanish, between the stations `one` and `other`."""
    low, high = sorted((at[one], at[other]))
    # The place as a polynomial in the value: its constant term is the zero.
    order = len(stations) - 1
    monotone = np.all(np.diff(values[stations]) > 0) or np.all(np.diff(values[stations]) < 0)
    span = np.ptp(values[stations])
    if order == 0 or not monotone or span < _TINY:
        return float(low + high) / 2
    if np.abs(np.diff(values[stations])).min() < _ALIKE * span:  # no polynomial goes through them
        return float(low + high) / 2
    zero = np.polynomial.Polynomial.fit(values[stations], at[stations], order)(0.0)
    return float(np.clip(zero, low, high))
