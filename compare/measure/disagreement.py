"""How far apart two aligned sweeps are: reading by reading, phase by phase, event by event."""

from dataclasses import asdict, dataclass

import numpy as np
import pandas as pd

from analytic import Readings
from analytic.problem.arrays import Booleans, Floats
from compare.sense.noise import scales
from compare.sense.record import direction


@dataclass(frozen=True)
class Peak:
    """The largest difference in one phase, relative to the reading's largest magnitude.

    `at` is its foot position and `arc_length` where on the vibrissa the contact is [length].
    """

    size: float
    at: float
    arc_length: float


@dataclass(frozen=True)
class Disagreement:
    """How far one clamp reading of the candidate is off, relative to its largest magnitude."""

    # Over the compared stations outside the window before snap-off, as are all the following but
    # one; NaN if there are none.
    rms: float
    max: float  # the largest difference
    at: float  # its foot position [length]
    phase: str  # its phase
    max_before_snap_off: float  # the largest difference inside the window; NaN if no station is
    rms_by_phase: dict[str, float]  # by the reference's phases
    scale: float  # what the differences are relative to, in the reading's unit
    stations_by_phase: dict[str, int]  # how many stations there are of each phase
    peaks: dict[str, Peak]  # the largest difference of each phase

    @property
    def stations(self) -> int:
        """How many stations `rms` and `max` are over."""
        return sum(self.stations_by_phase.values())


@dataclass(frozen=True)
class Occurrence:
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
        """Whether it happens in neither sweep, or at nearly the same foot position in both."""
        if self.difference is None:
            return self.reference is None and self.candidate is None
        return abs(self.difference) <= tolerance + self.uncertainty

    def to_dict(self) -> dict[str, float | None]:
        """What ``comparison.json`` holds."""
        return {**asdict(self), "difference": self.difference}


def disagreements(
    reference: Readings, table: pd.DataFrame, snap: Occurrence, window: float
) -> dict[str, Disagreement]:
    """How far the readings are apart at the stations that `align` paired."""
    foot_x = table["foot_x"].to_numpy()
    near = before_snap_off(reference, foot_x, snap, window)
    phase = table["phase"].to_numpy()[~near]
    arc_length = table["contact_arc_length"].to_numpy()[~near]
    found = {}
    for name, scale in scales(reference).items():
        error = (table[f"{name}_candidate"] - table[f"{name}_reference"]).to_numpy() / scale
        inside, error = error[near], error[~near]
        worst = {
            str(p): int(np.argmax(np.where(phase == p, np.abs(error), -1.0)))
            for p in np.unique(phase)
        }
        peaks = {
            p: Peak(abs(float(error[i])), float(foot_x[~near][i]), float(arc_length[i]))
            for p, i in worst.items()
        }
        highest = max(peaks, key=lambda p: peaks[p].size, default=None)
        peak = peaks[highest] if highest is not None else Peak(np.nan, np.nan, np.nan)
        found[name] = Disagreement(
            rms=_rms(error),
            max=peak.size,
            at=peak.at,
            phase=highest or "",
            max_before_snap_off=float(np.abs(inside).max()) if near.any() else np.nan,
            rms_by_phase={p: _rms(error[phase == p]) for p in peaks},
            scale=scale,
            stations_by_phase={p: int((phase == p).sum()) for p in peaks},
            peaks=peaks,
        )
    return found


def before_snap_off(
    reference: Readings, foot_x: Floats, snap: Occurrence, window: float
) -> Booleans:
    """Whether each foot position lies within the window at the earlier one of two snap-offs.

    There the readings grow without bound. What both sweeps still read far beyond it does count.
    """
    ends = [x for x in (snap.reference, snap.candidate) if x is not None]
    if not ends:
        return np.zeros(len(foot_x), dtype=bool)
    way = direction(reference)
    ahead = min(way * np.array(ends)) - way * foot_x
    return np.asarray(np.abs(ahead) < window * np.ptp(reference.values("foot_x")))


def _rms(error: Floats) -> float:
    return float(np.sqrt(np.mean(error**2))) if error.size else np.nan
