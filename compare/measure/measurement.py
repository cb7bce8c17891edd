"""Two sweeps set side by side: how far apart, where, and in which phase."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
import pandas as pd

from analytic import Readings
from compare.align.offset import Offset, estimate_offset, without_offset
from compare.align.stations import Alignment, align
from compare.measure.disagreement import Disagreement, Place, disagreements
from compare.sense.phases import Classification, classify, confusion
from compare.sense.transitions import TRANSITIONS, locate_transitions, snap_off


@dataclass(frozen=True)
class Measurement:
    """What two sweeps differ by, before anyone judges it.

    Attributes
    ----------
    reference, candidate : Readings
        The sweeps; the candidate's ``foot_x`` without the offset.
    alignment : Alignment
        The compared stations, and why the others are not.
    disagreement : dict of Disagreement
        By clamp reading.
    judged : dict of Classification
        The phases that the clamp readings show, of ``"reference"`` and ``"candidate"``.
    confusion : dict of pandas.DataFrame
        Those against the contact truth, where the source recorded it.
    transitions : dict of Place
        ``first_contact``, ``phase_b_start``, ``phase_b_end``.
    snap_off : Place
        The end of contact.
    offset : Offset
        What was taken from the candidate's ``foot_x`` before anything else.
    """

    reference: Readings
    candidate: Readings
    alignment: Alignment
    disagreement: dict[str, Disagreement]
    judged: dict[str, Classification]
    confusion: dict[str, pd.DataFrame]
    transitions: dict[str, Place]
    snap_off: Place
    offset: Offset

    def phase_agreement(self) -> dict[str, float]:
        """Share of stations whose judged phase is the true one, by sweep."""
        return {
            which: float(np.trace(table) / table.to_numpy().sum())
            for which, table in self.confusion.items()
        }


def measure(
    reference: Readings,
    candidate: Readings,
    window: float,
    offset: float | Literal["auto"] = 0.0,
) -> Measurement:
    """Measure how far `candidate` is from `reference`, from their readings alone.

    Parameters
    ----------
    reference, candidate : Readings
        Two sweeps of the same beam.
    window : float
        Stretch before the snap-off, of the sweep's length, that the largest differences leave out:
        there the readings grow without bound.
    offset : float or "auto"
        By how much the candidate's ``foot_x`` exceeds the reference's for one and the same place
        [length]; ``"auto"`` estimates it from the readings.

    Returns
    -------
    Measurement
        What they differ by.

    Raises
    ------
    InputError
        If the sweeps are of different beams or have no common stretch, or the offset is ambiguous.
    """
    judged = {"reference": classify(reference), "candidate": classify(candidate)}
    shift = (
        estimate_offset(reference, candidate, judged["reference"], judged["candidate"])
        if offset == "auto"
        else Offset(offset)
    )
    candidate = without_offset(candidate, shift.value)
    alignment = align(reference, candidate, judged["reference"], judged["candidate"])
    ends = snap_off(reference, judged["reference"]), snap_off(candidate, judged["candidate"])
    snap = Place(ends[0][0], ends[1][0], ends[0][1] + ends[1][1] + shift.uncertainty)
    sweeps: Mapping[str, Readings] = {"reference": reference, "candidate": candidate}
    places = {which: locate_transitions(sweep, judged[which]) for which, sweep in sweeps.items()}
    return Measurement(
        reference,
        candidate,
        alignment,
        disagreements(reference, alignment.table, snap, window),
        judged,
        {
            which: confusion(judged[which], sweep)
            for which, sweep in sweeps.items()
            if "phase" in sweep.table
        },
        {
            name: Place(places["reference"][name], places["candidate"][name], shift.uncertainty)
            for name in TRANSITIONS
        },
        snap,
        shift,
    )
