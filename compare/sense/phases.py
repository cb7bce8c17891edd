"""Contact phases from the clamp readings alone, and where one phase gives way to the next."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analytic import PHASES, Readings, reconstruct
from analytic.from_clamp.phases import judge_phases
from analytic.numerics.arrays import Booleans, Floats, Words
from analytic.problem.readings import require_readings
from analytic.problem.table import says

_CATEGORIES = pd.CategoricalDtype([*PHASES])
_STARTS = 0.05  # of the largest force, at most, of what the start of a drive excites
_LAST = 3  # stations before a release, of which the largest force is that of the contact ...
_ASTRAY = 0.25  # ... and the mean of a swing at most so much of it


@dataclass(frozen=True, repr=False)
class Classification:
    """Phases of one sweep, judged from foot position, clamp force and clamp moment.

    Attributes
    ----------
    phase : array of str, shape (stations,)
        ``"free"``, ``"tip"``, ``"tangent"``; empty where the station is not trusted.
    criterion : array
        (2 F_y - M^2)/(2 f) = sin(phi_1 - alpha) of eq. 26: zero in Phase B.
    criterion_tolerance : array
        Its standard deviation, from the noise of the readings.
    shortfall : array
        1 - s1/L of the reconstructed contact: zero in Phase A.
    shortfall_tolerance : array
        Its standard deviation.
    readings : Readings
        The sweep.
    """

    phase: Words
    criterion: Floats
    criterion_tolerance: Floats
    shortfall: Floats
    shortfall_tolerance: Floats
    readings: Readings

    @property
    def contact(self) -> pd.DataFrame:
        """The contact as `analytic.reconstruct` finds it, a row a station."""
        return reconstruct(self.readings)

    def __repr__(self) -> str:
        names, counts = np.unique(self.phase, return_counts=True)
        found = ", ".join(
            f"{n} {name or 'untrusted'}" for name, n in zip(names, counts, strict=True)
        )
        return f"Classification({found})"


def classify(readings: Readings) -> Classification:
    """Decide each station's phase, as `analytic.reconstruct` does.

    A sweep that records no events may ring before its contact and after the release, as a loop of
    a simulator's steps does: such stations are free.

    Parameters
    ----------
    readings : Readings
        One sweep; only the four sensed columns and ``status`` are used.

    Returns
    -------
    Classification
        The phase of each station, and what it was decided by.

    Raises
    ------
    InputError
        If the vibrissa varies along its length.

    See Also
    --------
    analytic.from_clamp.phases.judge_phases : how.
    """
    judged = judge_phases(require_readings(readings))
    phase = np.where(readings.trusted, judged.phase, "")
    if "events" not in readings.provenance:
        phase[_ringing(readings, phase, judged.explained)] = "free"
    return Classification(phase, *judged[1:], readings)


def _ringing(readings: Readings, phase: Words, explained: Booleans) -> Booleans:
    """Stations that seem to touch, but swing about zero: as the drive starts, and once released.

    An object only pushes, and bends the clamp to one side. A swing pulls in its turn; its mean is
    next to nothing, where that of a contact that chatters is the contact's.
    """
    touching = np.isin(phase, ("tip", "tangent"))
    force = np.nan_to_num(np.stack([readings.values("force_x"), readings.values("force_y")]))
    size = np.where(touching, np.hypot(*force), 0.0)
    peak = int(np.argmax(size))
    found = np.zeros_like(touching)
    before = np.flatnonzero(phase[:peak] == "free")
    if touching[0] and before.size and size[: before[-1]].max() <= _STARTS * size[peak]:
        found[: before[-1]] = touching[: before[-1]]
    moment = np.where(touching, readings.values("moment_z"), 0.0)
    odd = touching & ~(explained & (moment * moment.sum() > 0))
    for begin in (np.flatnonzero(odd[peak + 1 :]) + peak + 1).tolist():
        first = max(begin - _LAST, 0)
        last = force[:, first + int(np.argmax(size[first:begin]))]
        along = last @ force[:, begin:]
        if along.mean() <= _ASTRAY * (last @ last) and (along < 0)[touching[begin:]].any():
            found[begin:] = touching[begin:]
            break
    return found


def confusion(judged: Classification, truth: Readings) -> pd.DataFrame:
    """Stations counted by judged phase and by true phase."""
    known = (judged.phase != "") & truth.trusted
    if "second_contact_x" in truth.table:  # two contacts show neither phase
        known &= truth.table["second_contact_x"].isna().to_numpy()
    true = np.array([says(truth.table["phase"], phase) for phase in PHASES])
    seen = np.array([judged.phase == phase for phase in PHASES])
    rows, columns = (
        pd.CategoricalIndex(PHASES, dtype=_CATEGORIES, name=name) for name in ("truth", "judged")
    )
    return pd.DataFrame((true & known).astype(int) @ seen.T, rows, columns)
