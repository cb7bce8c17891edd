"""Two sweeps brought to the same foot positions, phase by phase."""

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.interpolate import CubicSpline

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.problem.arrays import Floats, Integers, Words
from compare.sense.phases import Classification

_SAME_STATION = 1e-9  # L; nearer foot positions are one and the same


@dataclass(frozen=True)
class Alignment:
    """Where both sweeps are in contact, and why the candidate's other stations are left out.

    Attributes
    ----------
    table : pandas.DataFrame
        A row a compared station of the candidate: ``foot_x``, ``phase`` (the reference's),
        ``contact_arc_length`` (the reference's at its nearest station, told from the clamp) and for
        each clamp reading ``<name>_reference`` and ``<name>_candidate``.
    counts : dict
        Every station of the candidate in one of: ``compared``; ``free`` (in both); ``one_free``
        (contact in one sweep only, as between two snap-offs); ``untrusted`` (the candidate says so
        itself); ``reference_untrusted``; ``between_phases`` (no reference stations of one phase on
        both sides, so there is nothing to interpolate); ``outside`` (beyond the reference).
    """

    table: pd.DataFrame
    counts: dict[str, int]


def align(
    reference: Readings,
    candidate: Readings,
    reference_phase: Classification,
    candidate_phase: Classification,
) -> Alignment:
    """Pair the candidate's stations with the reference, never across a transition or snap-off.

    A reference station at the same foot position is taken as it is. Otherwise the reference is
    interpolated by a cubic spline through one uninterrupted stretch of one phase.

    Raises
    ------
    InputError
        If the two sweeps are of different beams or have no common stretch.
    """
    length = reference.beam.length
    if not _same_beam(reference, candidate):
        raise InputError(
            "beams of the two readings",
            f"{reference.beam} and {candidate.beam}",
            "the same, in the same units",
            "compare sweeps of one vibrissa, both in its units",
        )
    x, x_ref = candidate.values("foot_x"), reference.values("foot_x")
    outside = (x < x_ref.min() - _SAME_STATION * length) | (
        x > x_ref.max() + _SAME_STATION * length
    )
    if outside.all():
        raise InputError(
            "foot_x of the two readings",
            f"{x_ref.min():.6g}..{x_ref.max():.6g} and {x.min():.6g}..{x.max():.6g}",
            "overlapping",
            "sweep a common stretch, or check units and origin of foot_x",
        )
    nearest = _nearest(x_ref, x)
    same = np.abs(x_ref[nearest] - x) <= _SAME_STATION * length

    state = reference_phase.phase[nearest]
    stretch = _stretches(reference_phase.phase)
    covering = np.where(same, stretch[nearest], _covering(x_ref, stretch, x))
    state = np.where(same, state, _stretch_phase(reference_phase.phase, stretch, covering))

    reasons = np.select(
        [
            candidate_phase.phase == "",
            outside,
            same & (state == ""),
            covering < 0,
            (state == "free") & (candidate_phase.phase == "free"),
            (state == "free") | (candidate_phase.phase == "free"),
        ],
        ["untrusted", "outside", "reference_untrusted", "between_phases", "free", "one_free"],
        "compared",
    )
    compared = reasons == "compared"
    columns = {
        "foot_x": x[compared],
        "phase": state[compared],
        "contact_arc_length": length * (1 - reference_phase.shortfall[nearest][compared]),
    }
    for name in CLAMP_READINGS:
        values = reference.values(name)
        there = values[nearest]
        for one in np.unique(covering[compared & ~same]):
            on = stretch == one
            here = compared & ~same & (covering == one)
            there[here] = _interpolate(x_ref[on], values[on], x[here])
        columns[f"{name}_reference"] = there[compared]
        columns[f"{name}_candidate"] = candidate.values(name)[compared]
    counts = {reason: int((reasons == reason).sum()) for reason in _REASONS}
    if counts["compared"] == 0:
        raise InputError(
            "stations in contact in both readings",
            ", ".join(f"{n} {reason}" for reason, n in counts.items() if n),
            "at least one",
            "sweep a stretch where both touch, or see why stations are not trusted",
        )
    return Alignment(pd.DataFrame(columns), counts)


_REASONS = (
    "compared",
    "free",
    "one_free",
    "untrusted",
    "reference_untrusted",
    "between_phases",
    "outside",
)


def _same_beam(reference: Readings, candidate: Readings) -> bool:
    one, other = reference.beam, candidate.beam
    return bool(
        np.allclose(
            [one.length, one.flexural_rigidity],
            [other.length, other.flexural_rigidity],
            rtol=1e-9,
            atol=0,
        )
    )


def _nearest(x_ref: Floats, x: Floats) -> Integers:
    order = np.argsort(x_ref)
    ordered = x_ref[order]
    right = np.clip(np.searchsorted(ordered, x), 1, len(ordered) - 1)
    nearer = np.where(x - ordered[right - 1] < ordered[right] - x, right - 1, right)
    return np.asarray(order[nearer])


def _stretches(
    phase: Words,
) -> Integers:
    """Number of the uninterrupted stretch of one phase that each station belongs to."""
    return np.cumsum(np.append(False, phase[1:] != phase[:-1]))


def _covering(x_ref: Floats, stretch: Integers, x: Floats) -> Integers:
    """The stretch with stations on both sides of each `x`; -1 where there is none."""
    covering = np.full(x.shape, -1)
    for one in np.unique(stretch):
        ends = x_ref[stretch == one]
        covering[(x >= ends.min()) & (x <= ends.max())] = one
    return covering


def _stretch_phase(
    phase: Words,
    stretch: Integers,
    wanted: Integers,
) -> Words:
    first = np.searchsorted(stretch, np.maximum(wanted, 0))
    return np.where(wanted < 0, "", phase[first])


def _interpolate(x_ref: Floats, values: Floats, x: Floats) -> Floats:
    order = np.argsort(x_ref)
    if len(order) < 4:
        return np.interp(x, x_ref[order], values[order])
    return np.asarray(CubicSpline(x_ref[order], values[order])(x), dtype=float)
