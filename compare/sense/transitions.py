"""Where one phase gives way to the next, located between stations from clamp readings alone."""

from collections.abc import Mapping

import numpy as np

from analytic import Readings
from analytic.problem.arrays import Booleans, Floats, Integers
from compare.sense.phases import Classification

TRANSITIONS = ("first_contact", "phase_b_start", "phase_b_end")
_FIT = 3  # stations on either side that a parabola is laid through
_TINY = 1e-290  # values that differ by less cannot be scaled for the fit
_ALIKE = 1e-9  # of the span of all: two values that are nearer to each other are one


def locate_transitions(readings: Readings, judged: Classification) -> Mapping[str, float | None]:
    """Foot positions of the transitions [length]; None where a transition does not occur.

    Phase B is the one stretch that agrees best with the judged phases, so that single stations that
    noise put on the wrong side move nothing. At its ends the criterion (26), which is zero inside,
    is extrapolated to zero from outside, and the shortfall of the contact, which is zero outside,
    from inside; the limit is half-way between the two results. First contact is where the clamp
    moment, extrapolated from the first loaded stations, vanishes. In motion, where the vibrissa's
    mass loads the clamp without contact, it is where the source recorded it, and stations before it
    and behind the snap-off show no phase.
    """
    foot_x = readings.values("foot_x")
    moving = "motion" in readings.provenance
    loaded = np.isin(judged.phase, ("tip", "tangent"))
    touching = np.flatnonzero(loaded & _in_contact(readings) if moving else loaded)
    found: dict[str, float | None] = dict.fromkeys(TRANSITIONS)
    if touching.size < 2:
        return found
    moment = readings.values("moment_z")
    if moving:
        found["first_contact"] = _recorded(readings, foot_x)
    elif touching[0] > 0:
        found["first_contact"] = _zero(foot_x, moment, touching[:2], touching[0] - 1, touching[0])
    begin, end = _best_stretch(np.where(judged.phase[touching] == "tangent", 1, -1))
    inside = touching[begin:end]
    before, after = touching[:begin], touching[end:]
    if inside.size and before.size:
        found["phase_b_start"] = _limit(foot_x, judged, before[-_FIT:], inside[:_FIT])
    if inside.size and after.size:
        found["phase_b_end"] = _limit(foot_x, judged, after[:_FIT], inside[-_FIT:])
    return found


def snap_off(readings: Readings, judged: Classification) -> tuple[float | None, float]:
    """Foot position of the snap-off and how far it may be off [length].

    The source's own value where it located one; else half-way between the last station in contact
    and the free one after it, give or take half a step. None if the sweep ends in contact.
    """
    if readings.snap_off is not None:
        return readings.snap_off, 0.0
    foot_x = readings.values("foot_x")
    touching = np.flatnonzero(np.isin(judged.phase, ("tip", "tangent")))
    if touching.size == 0 or touching[-1] + 1 == len(foot_x):
        return None, 0.0
    last, free = foot_x[touching[-1]], foot_x[touching[-1] + 1]
    return float(last + free) / 2, float(abs(last - free)) / 2


def _in_contact(readings: Readings) -> Booleans:
    """Stations from the first contact to the snap-off, as far as the source recorded them."""
    foot_x = readings.values("foot_x")
    sign = np.sign(foot_x[-1] - foot_x[0])
    first = readings.provenance.get("events", {}).get("first_contact")
    begin = sign * foot_x[0] if first is None else sign * first
    end = sign * foot_x[-1] if readings.snap_off is None else sign * readings.snap_off
    return np.asarray((begin <= sign * foot_x) & (sign * foot_x <= end))


def _recorded(readings: Readings, foot_x: Floats) -> float | None:
    """The first contact by the source's own word, if a station comes before it."""
    place = readings.provenance.get("events", {}).get("first_contact")
    first, last = foot_x[0], foot_x[-1]
    return None if place is None or (first - place) * (place - last) < 0 else float(place)


def _best_stretch(votes: Integers) -> tuple[int, int]:
    """The slice with the largest sum; empty if no vote is positive."""
    sums = np.append(0, np.cumsum(votes))
    least = np.minimum.accumulate(sums)
    end = int(np.argmax(sums - least))
    return int(np.argmin(sums[: end + 1])), end


def _limit(foot_x: Floats, judged: Classification, tip: Integers, tangent: Integers) -> float:
    """A limit of Phase B between the neighbouring stations `tip` and `tangent`."""
    ends = (tip[-1], tangent[0]) if tip[-1] < tangent[0] else (tip[0], tangent[-1])
    outside = _zero(foot_x, judged.criterion, tip, *ends)
    inside = _zero(foot_x, judged.shortfall, tangent, *ends)
    return float(outside + inside) / 2


def _zero(foot_x: Floats, values: Floats, stations: Integers, one: int, other: int) -> float:
    """Where `values` through `stations` vanish, between the stations `one` and `other`."""
    low, high = sorted((foot_x[one], foot_x[other]))
    # Foot position as a polynomial in the value: its constant term is the zero.
    order = len(stations) - 1
    monotone = np.all(np.diff(values[stations]) > 0) or np.all(np.diff(values[stations]) < 0)
    span = np.ptp(values[stations])
    if order == 0 or not monotone or span < _TINY:
        return float(low + high) / 2
    if np.abs(np.diff(values[stations])).min() < _ALIKE * span:  # no polynomial goes through them
        return float(low + high) / 2
    zero = np.polynomial.Polynomial.fit(values[stations], foot_x[stations], order)(0.0)
    return float(np.clip(zero, low, high))
