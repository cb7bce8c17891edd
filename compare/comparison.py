"""The comparison of two sweeps: how far apart, where, in which phase, and is that too far?"""

from dataclasses import asdict, dataclass, field
from typing import Any

import numpy as np
import pandas as pd

from analytic import Readings
from analytic.problem.arrays import Floats
from analytic.problem.readings import CLAMP_READINGS, PHASES
from compare.align import Alignment, align
from compare.phases import Classification, classify, confusion
from compare.tolerances import Tolerances
from compare.transitions import TRANSITIONS, locate_transitions, snap_off


@dataclass(frozen=True)
class Disagreement:
    """How far one clamp reading of the candidate is off, relative to its largest magnitude.

    `rms` is over all compared stations, `max` over those outside the window before snap-off, `at`
    its foot position [length] and `phase` its phase; `max_before_snap_off` is over those inside
    (NaN if there are none), `rms_by_phase` over the reference's phases.
    """

    rms: float
    max: float
    at: float
    phase: str
    max_before_snap_off: float
    rms_by_phase: dict[str, float]
    scale: float


@dataclass(frozen=True)
class Place:
    """Where something happens in both sweeps [length]; None where it does not."""

    reference: float | None
    candidate: float | None
    uncertainty: float = 0.0

    @property
    def difference(self) -> float | None:
        """Candidate less reference [length]."""
        if self.reference is None or self.candidate is None:
            return None
        return self.candidate - self.reference

    def agrees(self, tolerance: float) -> bool:
        """Whether both are absent, or within `tolerance` and what the stations can resolve."""
        if self.difference is None:
            return self.reference is None and self.candidate is None
        return abs(self.difference) <= tolerance + self.uncertainty

    def to_dict(self) -> dict[str, float | None]:
        """What ``comparison.json`` holds."""
        return {**asdict(self), "difference": self.difference}


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
    failures : tuple of str
        Every limit of `tolerances` that is exceeded, in a sentence each.
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
    failures: tuple[str, ...] = field(default=())

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
            "tolerances": asdict(self.tolerances),
            "reference": _origin(self.reference),
            "candidate": _origin(self.candidate),
        }


def compare(
    reference: Readings, candidate: Readings, tolerances: Tolerances | None = None
) -> Comparison:
    """Set `candidate` against `reference`, from their readings alone.

    Parameters
    ----------
    reference, candidate : Readings
        Two sweeps of the same beam.
    tolerances : Tolerances, optional
        Limits for the verdict.

    Raises
    ------
    InputError
        If the sweeps are of different beams or have no common stretch.
    """
    tolerances = Tolerances() if tolerances is None else tolerances
    judged = {"reference": classify(reference), "candidate": classify(candidate)}
    alignment = align(reference, candidate, judged["reference"], judged["candidate"])
    places = {
        which: locate_transitions(readings, judged[which])
        for which, readings in (("reference", reference), ("candidate", candidate))
    }
    ends = snap_off(reference, judged["reference"]), snap_off(candidate, judged["candidate"])
    snap = Place(ends[0][0], ends[1][0], ends[0][1] + ends[1][1])
    comparison = Comparison(
        reference,
        candidate,
        alignment,
        _disagreements(reference, alignment.table, snap, tolerances),
        judged,
        {
            which: confusion(judged[which], readings)
            for which, readings in (("reference", reference), ("candidate", candidate))
            if "phase" in readings.table
        },
        {name: Place(places["reference"][name], places["candidate"][name]) for name in TRANSITIONS},
        snap,
        tolerances,
    )
    object.__setattr__(comparison, "failures", tuple(_failures(comparison)))
    return comparison


def assert_agreement(
    reference: Readings, candidate: Readings, tolerances: Tolerances | None = None
) -> None:
    """Raise AssertionError, with every exceeded limit in a line, unless the sweeps agree."""
    comparison = compare(reference, candidate, tolerances)
    if not comparison.agrees:
        raise AssertionError(
            f"{candidate.source} disagrees with {reference.source}:\n  "
            + "\n  ".join(comparison.failures)
        )


def _disagreements(
    reference: Readings, table: pd.DataFrame, snap: Place, tolerances: Tolerances
) -> dict[str, Disagreement]:
    foot_x = table["foot_x"].to_numpy()
    phase = table["phase"].to_numpy()
    window = np.zeros(len(foot_x), dtype=bool)
    ends = [x for x in (snap.reference, snap.candidate) if x is not None]
    if ends:
        travel = np.ptp(reference.values("foot_x"))
        way = np.sign(reference.values("foot_x")[-1] - reference.values("foot_x")[0])
        ahead = min(way * np.array(ends)) - way * foot_x
        window = ahead < tolerances.snap_off_window * travel
    found = {}
    for name in CLAMP_READINGS:
        scale = float(np.abs(reference.values(name)[reference.trusted]).max())
        error = (table[f"{name}_candidate"] - table[f"{name}_reference"]).to_numpy() / scale
        outside = np.where(window, 0.0, np.abs(error))
        worst = int(np.argmax(outside))
        found[name] = Disagreement(
            rms=_rms(error),
            max=float(outside[worst]),
            at=float(foot_x[worst]),
            phase=str(phase[worst]),
            max_before_snap_off=float(np.abs(error[window]).max()) if window.any() else np.nan,
            rms_by_phase={str(p): _rms(error[phase == p]) for p in np.unique(phase)},
            scale=scale,
        )
    return found


def _failures(comparison: Comparison) -> list[str]:
    limits, length = comparison.tolerances, comparison.reference.beam.length
    said = []
    for name, d in comparison.disagreement.items():
        if d.rms > limits.rms:
            worst = max(d.rms_by_phase, key=lambda phase: d.rms_by_phase[phase])
            said.append(
                f"{name}: rms {d.rms:.2e} of its largest magnitude, allowed {limits.rms:.2e}; "
                f"most in phase {worst} ({d.rms_by_phase[worst]:.2e})"
            )
        if d.max > limits.max:
            said.append(
                f"{name}: off by {d.max:.2e} at foot_x = {d.at:.6g} (phase {d.phase}), "
                f"allowed {limits.max:.2e}"
            )
    for which, share in comparison.phase_agreement().items():
        if share < limits.phase_agreement:
            said.append(
                f"phases of the {which}: {share:.1%} judged rightly from the clamp, "
                f"asked {limits.phase_agreement:.1%}"
            )
    for name, place, limit in [
        *((name, place, limits.transition) for name, place in comparison.transitions.items()),
        ("snap_off", comparison.snap_off, limits.snap_off),
    ]:
        if not place.agrees(limit * length):
            said.append(
                f"{name}: at foot_x = {_told(place.candidate)} instead of "
                f"{_told(place.reference)}, allowed {limit * length:.2e} apart"
            )
    counts = comparison.alignment.counts
    if counts["untrusted"] > limits.untrusted * len(comparison.candidate.table):
        said.append(
            f"stations: {counts['untrusted']} of {len(comparison.candidate.table)} of the "
            f"candidate are not to be trusted, allowed {limits.untrusted:.1%}"
        )
    return said


def _told(x: float | None) -> str:
    return "nowhere" if x is None else f"{x:.6g}"


def _rms(error: Floats) -> float:
    return float(np.sqrt(np.mean(error**2)))


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
