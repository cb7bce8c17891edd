"""Two sweeps brought to the same places along their way, phase by phase; in space they are."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.numerics.arrays import Booleans, Floats, Integers
from analytic.space import SpatialReadings
from analytic.space.problem.readings import FOOT
from compare.align.jumps import LARGE, beside, jumps, sides
from compare.sense.noise import scales
from compare.sense.phases import Classification

_SAME_STATION = 1e-9  # L or rad; nearer places are one and the same
_SELDOM = 0.01  # of the stations; of more, what they are off is not this
_EXACT, _ON_SIDE = 1e-9, 1e-4  # rad; of the closed form's contact, and of one in links
_ALIKE = 5e-3  # rad; contacts that are no farther apart are on one facet
_SAME_PLACE = 1e-3  # of the way from station to station, where they are as near as that
_SAME_POSE = 1e-6  # L, rad, and of a tangent's components
# L: a stage's last digit; past an ellipsoid it moves readings by 1.1e-4 of the largest in rms.
_SAME_FOOT = 1e-4
_CUBIC = 4  # stations that a cubic spline needs
_APART = 1e-12  # of the stretch; between nearer stations a cubic spline swings out
# Of a reading's largest magnitude: half of the rms that sweeps of 40 segments are allowed.
_KNOWN = 1e-3


@dataclass(frozen=True, repr=False)
class Alignment:
    """Where both sweeps are in contact, and why the candidate's other stations are left out."""

    # A row a compared station of the candidate: ``station`` (its row), ``at`` (where along the
    # sweep it is), ``phase`` (the
    # reference's), ``contact_arc_length`` (the reference's at its nearest station, from the clamp)
    # and for each clamp reading ``<name>_reference`` and ``<name>_candidate``.
    table: pd.DataFrame
    # Every station of the candidate in one of: ``compared``; ``beside_jump`` (as the reference is
    # on its other side: where it jumps is known to a station); ``reference_coarse`` (its stations
    # are too far apart to say what is between them); ``free`` (in both); ``one_free`` (contact in
    # one sweep only, as between two snap-offs); ``reference_untrusted`` (there, or on one side);
    # ``untrusted`` (the candidate says so itself, and the reference does not); ``dropped`` (zeros
    # where the reference is in contact, between loads of its own); ``between_phases`` (no reference
    # stations of one phase on both sides, or a jump between them: there is nothing to interpolate);
    # ``outside`` (beyond the reference).
    counts: dict[str, int]
    # The same rows of the stations where the reference is free, as at those beside them or behind
    # its last contact, and where the candidate alone is, amid the contact of both.
    idle: pd.DataFrame

    def __repr__(self) -> str:
        counted = ", ".join(f"{n} {reason}" for reason, n in self.counts.items() if n)
        return f"Alignment({counted})"


def align(
    reference: Readings,
    candidate: Readings,
    reference_phase: Classification,
    candidate_phase: Classification,
    dropped: Booleans,
) -> Alignment:
    """Pair the candidate's stations with the reference, never across a transition or a jump.

    A reference station at the same place is taken as it is. Otherwise the reference is
    interpolated by a cubic spline through one uninterrupted stretch of one phase. Stations
    beside a jump from corner to corner are left out, if they are as on its other side, or
    if both sweeps record contacts on facets side by side there alone: one holds on longer.
    """
    length = reference.beam.length
    size, _ = reference.running_unit
    x, x_ref = candidate.running_values, reference.running_values
    outside = (x < x_ref.min() - _SAME_STATION * size) | (x > x_ref.max() + _SAME_STATION * size)
    if outside.all():
        what = f"{x_ref.min():.6g}..{x_ref.max():.6g} and {x.min():.6g}..{x.max():.6g}"
        remedy = f"sweep a common stretch, or check units and origin of {reference.running}"
        raise InputError(f"{reference.running} of the two readings", what, "overlapping", remedy)
    order = np.argsort(x_ref)
    between = (x_ref[order][1:] + x_ref[order][:-1]) / 2
    nearest = order[np.searchsorted(between, x, side="right")]
    step = float(np.ptp(x_ref)) / len(x_ref)
    same = np.abs(x_ref[nearest] - x) <= min(_SAME_STATION * size, _SAME_PLACE * step)

    scale = np.array([*scales(reference).values()])[:, None]
    values, own = (
        np.stack([sweep.values(name) for name in CLAMP_READINGS])
        for sweep in (reference, candidate)
    )
    phase = reference_phase.phase
    phases = np.flatnonzero(np.append(True, phase[1:] != phase[:-1]))
    after = jumps(x_ref, values / scale, phases)
    starts = np.union1d(phases, after + 1)
    stretch = np.searchsorted(starts, nearest, side="right") - 1
    covering = np.where(same, stretch, _covering(x_ref, starts, x))
    state = np.where(same, phase[nearest], np.where(covering < 0, "", phase[starts[covering]]))
    above = np.searchsorted(x_ref[order], x)
    beside_it = order[np.clip([above - 1, above], 0, len(order) - 1)]
    unknown = (phase[np.where(same, nearest, beside_it)] == "").any(axis=0)
    idle = candidate_phase.phase == "free"
    # The first that holds, in the order of the reasons.
    why_not = {
        "reference_untrusted": unknown & ~outside,
        "untrusted": candidate_phase.phase == "",
        "outside": outside,
        "between_phases": covering < 0,
        "free": (state == "free") & idle,
        "dropped": dropped & idle,
        "one_free": (state == "free") | idle,
    }
    reasons = np.select([*why_not.values()], [*why_not], "compared")
    there, ends = values[:, nearest], np.append(starts, len(x_ref))
    behind = nearest > np.flatnonzero(np.isin(phase, ("tip", "tangent"))).max(initial=0)
    resting = (state == "free") & (_amid(phase == "free")[nearest] | behind)
    resting |= idle & (state != "") & _amid_contact(reference_phase, candidate_phase, nearest)
    resting &= (candidate_phase.phase != "") & ~outside & ~unknown & ~dropped
    between_two = np.flatnonzero(((reasons == "compared") | resting) & ~same)
    coarse = np.zeros(len(x))
    for group in pd.Series(between_two).groupby(covering[between_two]).indices.values():
        here = between_two[group]
        one = covering[here[0]]
        on = slice(ends[one], ends[one + 1])
        there[:, here] = interpolant(x_ref[on], values[:, on])(x[here])
        coarse[here] = _unknown(x_ref[on], values[:, on] / scale, x[here])
    reasons[(reasons == "compared") & (coarse > _KNOWN)] = "reference_coarse"
    off = (np.abs(own - there) / scale).max(axis=0)
    for i in after.tolist():
        near = np.flatnonzero((reasons == "compared") & beside(x, x_ref[i : i + 2], size))
        for covered, beyond in sides(i, starts, len(x_ref)):
            here = near[covering[near] == covered]
            other = interpolant(x_ref[beyond], values[:, beyond])(x[here])
            jumped = (np.abs(own[:, here] - other) / scale).max(axis=0) < off[here]
            reasons[here[jumped]] = "beside_jump"
    leapt = (reasons == "compared") & same & (off > LARGE) & _leapt(reference, candidate, nearest)
    if leapt.sum() <= 1 + _SELDOM * (reasons == "compared").sum():
        reasons[leapt] = "beside_jump"
    every = {
        "station": np.arange(len(x)),
        "at": x,
        "phase": state,
        "contact_arc_length": length * (1 - reference_phase.shortfall[nearest]),
    }
    for name, true, seen in zip(CLAMP_READINGS, there, own, strict=True):
        every |= {f"{name}_reference": true, f"{name}_candidate": seen}
    table, idle_table = (
        pd.DataFrame({name: row[here] for name, row in every.items()})
        for here in (reasons == "compared", resting)
    )
    counts = {
        reason: int((reasons == reason).sum())
        for reason in ("compared", "beside_jump", "reference_coarse", *why_not)
    }
    return Alignment(table, counts, idle_table)


def check_same_beam(
    reference: Readings | SpatialReadings, candidate: Readings | SpatialReadings
) -> None:
    """Refuse sweeps of two vibrissae, but for what the digits of a file leave."""
    one, other = reference.beam, candidate.beam
    sizes, others = ((beam.length, beam.base_rigidity) for beam in (one, other))
    if not np.allclose(sizes, others, rtol=1e-9, atol=0):
        what = f"of length {sizes[0]:g} and EI {sizes[1]:g}, and of {others[0]:g} and {others[1]:g}"
        remedy = (
            "state the one that was measured: Readings(table, case.beam), of a file --beam FILE"
        )
        raise InputError("vibrissae of the two sweeps", what, "the same, in the same units", remedy)


def check_same_way(reference: Readings, candidate: Readings) -> None:
    """Refuse sweeps of two vibrissae, or of clamps that turn or leave their line on two ways."""
    check_same_beam(reference, candidate)
    if reference.running != candidate.running:
        what = f"over {reference.running} and over {candidate.running}"
        remedy = "sweep both along one way; measured readings need its columns, as clamp_angle"
        raise InputError("ways of the two clamps", what, "one and the same", remedy)
    if reference.running == "foot_x":
        return
    order, at = np.argsort(reference.running_values), candidate.running_values
    x, length = reference.running_values[order], reference.beam.length
    within = (at >= x[0]) & (at <= x[-1])
    for name, (ours, theirs), size in (
        ("foot_x", (reference.values("foot_x"), candidate.values("foot_x")), length),
        ("foot_y", (reference.foot_y, candidate.foot_y), length),
        ("clamp_angle", (reference.clamp_angle, candidate.clamp_angle), 1.0),
    ):
        off = np.abs(np.interp(at, x, ours[order]) - theirs)[within].max(initial=0.0) / size
        if off > _SAME_POSE:
            what = f"up to {off:.2g} away from that of {reference.source}"
            allowed = f"the same at the same {reference.running}, to {_SAME_POSE:g} L or rad"
            remedy = "sweep both along one way, at the same stations if it is curved"
            raise InputError(f"{name} of {candidate.source}", what, allowed, remedy)


def _leapt(reference: Readings, candidate: Readings, nearest: Integers) -> Booleans:
    """Stations at which the contacts are on two facets side by side, and elsewhere not apart.

    Both contacts have the slope of a side of the polygon that the reference records, as hardly any
    contact on a smooth contour has.
    """
    corners = np.asarray(reference.provenance.get("contour", []), dtype=float)
    sweeps = reference, candidate
    if corners.ndim != 2 or not all("contact_angle" in sweep.table for sweep in sweeps):
        return np.zeros(len(nearest), dtype=bool)
    with np.errstate(divide="ignore"):  # of an upright side
        sides_ = np.unique(np.arctan(np.divide(*np.diff(corners)[::-1])))
    true, own = (np.nan_to_num(sweep.values("contact_angle"), nan=9.0) for sweep in sweeps)
    true = true[nearest]
    (of_true, off_true), (of_own, off_own) = (
        (away.argmin(axis=1), away.min(axis=1))
        for away in (np.abs(angles[:, None] - sides_) for angles in (true, own))
    )
    leapt = (np.abs(of_true - of_own) == 1) & (off_true < _EXACT) & (off_own < _ON_SIDE)
    apart = np.abs(true - own)
    beside_it = np.maximum(np.append(0.0, apart[:-1]), np.append(apart[1:], 0.0))
    return np.asarray(leapt & (beside_it < _ALIKE))


def _amid(those: Booleans) -> Booleans:
    """Which of those have none but their like beside them."""
    beside = np.pad(those, 1, constant_values=True)
    return np.asarray(beside[:-2] & those & beside[2:])


def _amid_contact(
    reference: Classification, candidate: Classification, nearest: Integers
) -> Booleans:
    there, own = (np.isin(one.phase, ("tip", "tangent")) for one in (reference, candidate))
    within = np.maximum.accumulate(own) & np.maximum.accumulate(own[::-1])[::-1]
    return np.asarray(_amid(there)[nearest] & within)


def _covering(x_ref: Floats, starts: Integers, x: Floats) -> Integers:
    """The stretch with stations on both sides of each `x`, the last of several; -1 for none."""
    low, high = np.minimum.reduceat(x_ref, starts), np.maximum.reduceat(x_ref, starts)
    order = np.argsort(x, kind="stable")
    first, last = np.searchsorted(x[order], low), np.searchsorted(x[order], high, side="right")
    covering = np.full(x.shape, -1)
    for one in np.flatnonzero(first < last):
        covering[order[first[one] : last[one]]] = one
    return covering


def interpolant(x: Floats, values: Floats) -> Callable[..., Any]:
    """A cubic spline through the values at increasing or decreasing, possibly repeated `x`.

    Values at one and the same `x` count by their mean. Fewer than four places are joined by
    straight lines.
    """
    from scipy.interpolate import CubicSpline, make_interp_spline  # slow to load

    places, which, counts = np.unique(x, return_inverse=True, return_counts=True)
    if len(places) < len(x):
        order = np.argsort(which, kind="stable")
        starts = np.append(0, np.cumsum(counts)[:-1])
        values = np.add.reduceat(values[..., order], starts, axis=-1) / counts
    else:
        values = values[..., np.argsort(x)]
    if len(places) == 1:
        return lambda at, order=0: np.broadcast_to(
            0.0 * values if order else values, (*values.shape[:-1], len(at))
        )
    if len(places) < _CUBIC or np.diff(places).min() < _APART * np.ptp(places):
        return make_interp_spline(places, values, k=1, axis=-1)
    return CubicSpline(places, values, axis=-1)


def _unknown(x: Floats, values: Floats, at: Floats) -> Floats:
    """By how much a spline through the values may be off, from what each is off its neighbours'.

    A cubic through two on either side misses a value by twice as much as the spline does past a
    kink, and by more where they are smooth.
    """
    x, first = np.unique(x, return_index=True)
    count = len(x)
    if count == 1:
        return np.zeros(len(at))
    each, some = np.arange(count)[:, None], min(count, 5)
    around = np.clip(each - 2, 0, count - some) + np.arange(some)
    around = around[around != each].reshape(count, -1)
    ahead = x[:, None] - x[around]
    apart = x[around][:, :, None] - x[around][:, None, :] + np.eye(some - 1)
    weights = ahead.prod(axis=1, keepdims=True) / ahead / apart.prod(axis=2)
    values = values[:, first]
    missed = np.abs((values[:, around] * weights).sum(axis=2) - values).max(axis=0) / 2
    missed[[0, -1]] = missed[[1, -2]]
    above = np.clip(np.searchsorted(x, at), 1, count - 1)
    return np.asarray(np.maximum(missed[above - 1], missed[above]))


def check_same_stations(reference: SpatialReadings, candidate: SpatialReadings) -> None:
    """Refuse sweeps of two vibrissae, of two clamps, or at other stations."""
    check_same_beam(reference, candidate)
    if np.abs(reference.clamp_tangent - candidate.clamp_tangent).max() > _SAME_POSE:
        raise InputError(
            f"tangent of {candidate.source}", candidate.clamp_tangent.tolist(),
            f"{reference.clamp_tangent.tolist()}, that of {reference.source}",
            "compare sweeps of one clamp: SpatialReadings(..., tangent=case.path.tangent)",
        )  # fmt: skip
    feet = reference.values(*FOOT), candidate.values(*FOOT)
    what = f"{len(feet[1])}, not the {len(feet[0])} of {reference.source}"
    if feet[0].shape == feet[1].shape:
        off = np.abs(feet[0] - feet[1]).max() / reference.beam.length
        if off < _SAME_FOOT:
            return
        what = f"up to {off:.2g} L from those of {reference.source}"
    allowed = f"the same foot positions in the same order, to {_SAME_FOOT:g} L"
    remedy = "sweep both along one [path]; check the foot's unit and zero, and the rows' order"
    raise InputError(f"stations of {candidate.source}", what, allowed, remedy)
