"""How far two aligned sweeps are apart: component by component, phase by phase."""

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Generic, TypeVar

import numpy as np
import pandas as pd

from analytic import Readings
from analytic.numerics.arrays import Booleans, Floats, Words
from analytic.problem.shown import Shown
from analytic.space import SpatialReadings
from compare.sense.noise import scales
from compare.sense.occurrence import Occurrence
from compare.sense.record import direction

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Sweep = TypeVar("Sweep", Readings, SpatialReadings)

_LAST = 3  # stations of the reference before its snap-off: in the window there is one


@dataclass(frozen=True)
class Peak:
    """The largest difference in one phase, relative to the component's largest magnitude.

    `at` is where along the sweep it is, and `arc_length` where on the vibrissa the contact is; NaN
    where that is not known [length].
    """

    size: float
    at: float
    arc_length: float


@dataclass(frozen=True)
class Disagreement:
    """How far one component of the candidate is off, relative to its largest magnitude."""

    # Over the compared stations, in the plane those outside the window before the snap-off, as are
    # all the following but one; NaN if there are none.
    rms: float
    max: float  # the largest difference
    at: float  # where along the sweep it is: the foot's position, or its travel in space [length]
    phase: str  # its phase; empty where the reference records none
    rms_by_phase: dict[str, float]  # by the reference's phases
    scale: float  # what the differences are relative to, in the readings' unit
    stations_by_phase: dict[str, int]  # how many stations there are of each phase
    peaks: dict[str, Peak]  # the largest difference of each phase
    # The largest difference inside the window before the snap-off; NaN if no station is.
    max_before_snap_off: float = np.nan
    # By how much the reference changes there over the root of a length; NaN if that is not known.
    fold: float = np.nan
    # The largest difference where a sweep is free, at rest; None if no station is there.
    idle: Peak | None = None

    @property
    def stations(self) -> int:
        """How many stations `rms` and `max` are over."""
        return sum(self.stations_by_phase.values())


@dataclass(frozen=True, eq=False, repr=False)
class SweepPair(Shown, Generic[Sweep]):
    """Two sweeps, and how far each component of the candidate is off along their travel."""

    reference: Sweep
    candidate: Sweep
    disagreement: dict[str, Disagreement]
    events: dict[str, Occurrence]

    def plot(self) -> "list[Axes]":
        """Draw the clamp readings of both sweeps along the way.

        Returns
        -------
        list of matplotlib.axes.Axes
            One a reading; a notebook shows them.
        """
        return self.candidate.plot(self.reference.plot())

    def _draw(self, figure: "Figure") -> None:
        self.reference._draw(figure)
        self.candidate.plot(figure.axes)


def disagreement(
    error: Floats, at: Floats, phase: Words, scale: float, arc_length: Floats | None = None
) -> Disagreement:
    """How far a component is off at the stations of a travel, each in a phase."""
    size = np.abs(error)
    arc_length = np.full_like(size, np.nan) if arc_length is None else arc_length
    worst = {str(p): int(np.argmax(np.where(phase == p, size, -1.0))) for p in np.unique(phase)}
    peaks = {p: Peak(float(size[i]), float(at[i]), float(arc_length[i])) for p, i in worst.items()}
    highest = max(peaks, key=lambda p: peaks[p].size, default="")
    peak = peaks.get(highest, Peak(np.nan, np.nan, np.nan))
    return Disagreement(
        rms=float(rms(error)),
        max=peak.size,
        at=peak.at,
        phase=highest,
        rms_by_phase={p: float(rms(error[phase == p])) for p in peaks if p},
        scale=scale,
        stations_by_phase={p: int((phase == p).sum()) for p in peaks},
        peaks=peaks,
    )


def disagreements(
    reference: Readings,
    table: pd.DataFrame,
    snap: Occurrence,
    window: float,
    idle: pd.DataFrame,
) -> dict[str, Disagreement]:
    """How far the clamp readings are apart at the stations that `align` paired.

    `idle` are those without contact, as `at_rest` has them.
    """
    at = table["at"].to_numpy()
    near = before_snap_off(reference, at, snap, window)
    phase, arc_length = (table[name].to_numpy()[~near] for name in ("phase", "contact_arc_length"))
    found = {}
    for name, scale in scales(reference).items():
        error, free = (
            (rows[f"{name}_candidate"] - rows[f"{name}_reference"]).to_numpy() / scale
            for rows in (table, idle)
        )
        here = disagreement(error[~near], at[~near], phase, scale, arc_length)
        inside = float(np.abs(error[near]).max()) if near.any() else np.nan
        fold = _fold(reference, name, snap) / scale
        peak = worst(free, idle["at"].to_numpy())
        found[name] = replace(here, max_before_snap_off=inside, fold=fold, idle=peak)
    return found


def worst(error: Floats, at: Floats) -> Peak | None:
    """The largest difference at stations that are in no phase; None if there are none."""
    if not len(error):
        return None
    i = int(np.argmax(np.abs(error)))
    return Peak(float(abs(error[i])), float(at[i]), np.nan)


def at_rest(candidate: Readings, idle: pd.DataFrame, snap: Occurrence) -> pd.DataFrame:
    """Idle stations but those between two snap-offs: the event is what is off there.

    None in motion, where a vibrissa bounces, and swings when it is released.
    """
    if snap.reference is None:
        late = np.zeros(len(idle), dtype=bool)
    else:
        way = direction(candidate)
        end = way * np.inf if snap.candidate is None else snap.candidate
        after = way * idle["at"].to_numpy()
        late = (after > way * snap.reference) & (after < way * end)
    return idle[~late & ("motion" not in candidate.provenance)].reset_index(drop=True)


def _fold(reference: Readings, name: str, snap: Occurrence) -> float:
    """What a reading changes by over the root of the way to the snap-off, at the last stations."""
    if snap.reference is None:
        return np.nan
    ahead = direction(reference) * (snap.reference - reference.running_values)
    last = np.flatnonzero((ahead > 0) & reference.trusted)[-_LAST:]
    if len(last) < _LAST:
        return np.nan
    roots, values = np.sqrt(ahead[last]), reference.values(name)[last]
    return float(np.ptp(values) / np.ptp(roots))


def before_snap_off(reference: Readings, at: Floats, snap: Occurrence, window: float) -> Booleans:
    """Whether each place lies within the window at the earlier one of two snap-offs.

    There the readings grow without bound. What both sweeps still read far beyond it does count.
    """
    ends = [x for x in (snap.reference, snap.candidate) if x is not None]
    if not ends:
        return np.zeros(len(at), dtype=bool)
    sign = direction(reference)
    ahead = min(sign * np.array(ends)) - sign * at
    return np.asarray(np.abs(ahead) < window * np.ptp(reference.running_values))


def rms(errors: Floats) -> Floats:
    """Root mean square over the last axis; NaN of nothing."""
    if not errors.shape[-1]:
        return np.full(errors.shape[:-1], np.nan)
    return np.asarray(np.sqrt(np.mean(errors**2, axis=-1)))
