"""The comparison of two sweeps: how far apart, where, in which phase, and is that too far?"""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
import pandas as pd

from analytic import Readings
from analytic.problem.readings import PHASES
from compare.align import Alignment, align
from compare.allowance import NoiseAllowance, noise_allowance
from compare.causes import likely_cause
from compare.disagreement import Disagreement, Place, disagreements
from compare.failures import failures
from compare.noise import checked_level, noise_level
from compare.offset import Offset, estimate_offset, without_offset
from compare.phases import Classification, classify, confusion
from compare.tolerances import Tolerances
from compare.transitions import TRANSITIONS, locate_transitions, snap_off


@dataclass(frozen=True)
class Comparison:
    """Two sweeps set side by side.

    Attributes
    ----------
    disagreement : dict of Disagreement
        By clamp reading.
    alignment : Alignment
        The compared stations, and why the others are not.
    judged : dict of Classification
        The phases that the clamp readings tell, of ``"reference"`` and ``"candidate"``.
    confusion : dict of pandas.DataFrame
        Those against the contact truth, where the source recorded it.
    transitions : dict of Place
        ``first_contact``, ``phase_b_start``, ``phase_b_end``.
    snap_off : Place
        The end of contact.
    tolerances : Tolerances
        Limits for the verdict.
    offset : Offset
        What was taken from the candidate's ``foot_x`` before anything else.
    noise : NoiseAllowance
        What noise adds to the limits.
    """

    reference: Readings
    candidate: Readings
    alignment: Alignment
    disagreement: dict[str, Disagreement]
    judged: dict[str, Classification]
    confusion: dict[str, pd.DataFrame]
    transitions: dict[str, Place]
    snap_off: Place
    tolerances: Tolerances
    offset: Offset
    noise: NoiseAllowance

    @cached_property
    def failures(self) -> tuple[str, ...]:
        """Every limit that is exceeded, in a sentence each."""
        return tuple(failures(self))

    @cached_property
    def likely(self) -> str | None:
        """What the disagreement looks like; None if it agrees, or like nothing known."""
        return None if self.agrees else likely_cause(self)

    @property
    def agrees(self) -> bool:
        """Whether no tolerance is exceeded."""
        return not self.failures

    def phase_agreement(self) -> dict[str, float]:
        """Share of stations whose judged phase is the true one, by sweep."""
        return {
            which: float(np.trace(table) / table.to_numpy().sum())
            for which, table in self.confusion.items()
        }

    def to_dict(self) -> dict[str, Any]:
        """What ``comparison.json`` holds; lengths in the beam's unit, the rest relative."""
        agreement = self.phase_agreement()
        return {
            "verdict": "agrees" if self.agrees else "disagrees",
            "failures": list(self.failures),
            "likely": self.likely,
            "offset": asdict(self.offset),
            "noise": asdict(self.noise),
            "disagreement": {name: _plain(asdict(d)) for name, d in self.disagreement.items()},
            "phases": {
                "agreement": min(agreement.values()) if agreement else None,
                "agreement_by_sweep": agreement,
                "confusion": {
                    which: {"phases": list(PHASES), "counts": table.to_numpy().tolist()}
                    for which, table in self.confusion.items()
                },
                "transitions": {name: place.to_dict() for name, place in self.transitions.items()},
            },
            "snap_off": self.snap_off.to_dict(),
            "stations": self.alignment.counts,
            "tolerances": {name: float(x) for name, x in self.tolerances.limits().items()},
            "tolerance_reasons": {n: x.reason for n, x in self.tolerances.limits().items()},
            "reference": _origin(self.reference),
            "candidate": _origin(self.candidate),
        }


def compare(
    reference: Readings,
    candidate: Readings,
    tolerances: Tolerances | None = None,
    *,
    offset: float | Literal["auto"] = 0.0,
    noise: float | Literal["auto"] = 0.0,
) -> Comparison:
    """Set `candidate` against `reference`, from their readings alone.

    Parameters
    ----------
    reference, candidate : Readings
        Two sweeps of the same beam.
    tolerances : Tolerances, optional
        Limits for the verdict.
    offset : float or "auto"
        By how much the candidate's ``foot_x`` exceeds the reference's for one and the same place
        [length]; ``"auto"`` has it estimated from the readings.
    noise : float or "auto"
        Standard deviation of the clamp readings' noise over their largest magnitude. The limits are
        widened by what such noise does. ``"auto"`` has it estimated from both sweeps, which takes
        everything for noise that jumps from station to station.

    Raises
    ------
    InputError
        If the sweeps are of different beams or have no common stretch, the offset is ambiguous, or
        the noise is no share of the largest magnitude.
    """
    tolerances = Tolerances() if tolerances is None else tolerances
    judged = {"reference": classify(reference), "candidate": classify(candidate)}
    shift = (
        estimate_offset(reference, candidate, judged["reference"], judged["candidate"])
        if offset == "auto"
        else Offset(offset)
    )
    candidate = without_offset(candidate, shift.value)
    alignment = align(reference, candidate, judged["reference"], judged["candidate"])
    level = noise_level(reference, candidate) if noise == "auto" else checked_level(noise)
    allowance = noise_allowance(reference, level)
    ends = snap_off(reference, judged["reference"]), snap_off(candidate, judged["candidate"])
    snap = Place(ends[0][0], ends[1][0], ends[0][1] + ends[1][1] + shift.uncertainty)
    sweeps: Mapping[str, Readings] = {"reference": reference, "candidate": candidate}
    places = {which: locate_transitions(sweep, judged[which]) for which, sweep in sweeps.items()}
    return Comparison(
        reference,
        candidate,
        alignment,
        disagreements(reference, alignment.table, snap, tolerances),
        judged,
        {
            which: confusion(judged[which], sweep)
            for which, sweep in sweeps.items()
            if "phase" in sweep.table
        },
        {
            name: Place(
                places["reference"][name],
                places["candidate"][name],
                shift.uncertainty + allowance.transitions.get(name, 0.0),
            )
            for name in TRANSITIONS
        },
        snap,
        tolerances,
        shift,
        allowance,
    )


def _plain(value: dict[str, Any]) -> dict[str, Any]:
    """JSON has no NaN."""
    return {k: None if isinstance(v, float) and np.isnan(v) else v for k, v in value.items()}


def _origin(readings: Readings) -> dict[str, Any]:
    return {
        "source": readings.source,
        "beam": asdict(readings.beam),
        "stations": len(readings.table),
        "provenance": {k: v for k, v in readings.provenance.items() if k != "contour"},
    }
