"""How far apart two aligned sweeps are: reading by reading, phase by phase, place by place."""

from dataclasses import asdict, dataclass

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, Readings
from analytic.problem.arrays import Booleans, Floats


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
    """How far one clamp reading of the candidate is off, relative to its largest magnitude.

    `rms` is over all compared stations, `max` over those outside the window before snap-off, `at`
    its foot position [length] and `phase` its phase; `max_before_snap_off` is over those inside
    (NaN if there are none). `rms_by_phase`, `stations_by_phase` and `peaks`, the largest outside
    the window, are over the reference's phases.
    """

    rms: float
    max: float
    at: float
    phase: str
    max_before_snap_off: float
    rms_by_phase: dict[str, float]
    scale: float
    stations_by_phase: dict[str, int]
    peaks: dict[str, Peak]


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


def disagreements(
    reference: Readings, table: pd.DataFrame, snap: Place, window: float
) -> dict[str, Disagreement]:
    """By clamp reading, over the stations that `align` paired; `snap` is where contact ends."""
    foot_x = table["foot_x"].to_numpy()
    phase = table["phase"].to_numpy()
    near = before_snap_off(reference, foot_x, snap, window)
    arc_length = table["contact_arc_length"].to_numpy()
    found = {}
    for name in CLAMP_READINGS:
        scale = float(np.abs(reference.values(name)[reference.trusted]).max())
        error = (table[f"{name}_candidate"] - table[f"{name}_reference"]).to_numpy() / scale
        outside = np.where(near, 0.0, np.abs(error))
        worst = {str(p): int(np.argmax(outside * (phase == p))) for p in np.unique(phase)}
        peaks = {
            p: Peak(float(outside[i]), float(foot_x[i]), float(arc_length[i]))
            for p, i in worst.items()
        }
        highest = max(peaks, key=lambda p: peaks[p].size)
        found[name] = Disagreement(
            rms=_rms(error),
            max=peaks[highest].size,
            at=peaks[highest].at,
            phase=highest,
            max_before_snap_off=float(np.abs(error[near]).max()) if near.any() else np.nan,
            rms_by_phase={p: _rms(error[phase == p]) for p in peaks},
            scale=scale,
            stations_by_phase={p: int((phase == p).sum()) for p in peaks},
            peaks=peaks,
        )
    return found


def before_snap_off(reference: Readings, foot_x: Floats, snap: Place, window: float) -> Booleans:
    """Whether each foot position lies in the window before either sweep's snap-off, or past it.

    Parameters
    ----------
    reference : Readings
        Its direction and length are the sweep's.
    foot_x : array, shape (n,)
        Foot positions [length].
    snap : Place
        The snap-offs.
    window : float
        Of the sweep's length.
    """
    ends = [x for x in (snap.reference, snap.candidate) if x is not None]
    if not ends:
        return np.zeros(len(foot_x), dtype=bool)
    swept = reference.values("foot_x")
    way = np.sign(swept[-1] - swept[0])
    ahead = min(way * np.array(ends)) - way * foot_x
    return np.asarray(ahead < window * np.ptp(swept))


def _rms(error: Floats) -> float:
    return float(np.sqrt(np.mean(error**2)))
