"""Contact phases from the clamp readings alone, and where one phase gives way to the next."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analytic import PHASES, Readings, reconstruct
from analytic.from_clamp.phases import judge_phases
from analytic.problem.arrays import Floats, Words
from analytic.problem.table import says

_CATEGORIES = pd.CategoricalDtype([*PHASES])


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
        """How many stations there are of each phase."""
        names, counts = np.unique(self.phase, return_counts=True)
        found = ", ".join(
            f"{n} {name or 'untrusted'}" for name, n in zip(names, counts, strict=True)
        )
        return f"Classification({found})"


def classify(readings: Readings) -> Classification:
    """Decide each station's phase, as `analytic.reconstruct` does.

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
    judged = judge_phases(readings)
    phase = np.where(readings.trusted, judged.phase, "")
    return Classification(phase, *judged[1:], readings)


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
