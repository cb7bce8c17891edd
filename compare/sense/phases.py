"""Contact phases from the clamp readings alone, and where one phase gives way to the next."""

from dataclasses import dataclass

import numpy as np
import pandas as pd

from analytic import PHASES, SENSED, Readings, reconstruct
from analytic.problem.arrays import Floats, Words
from compare.sense.noise import reading_noise

_SIGMAS = 5  # a force below so many standard deviations of its noise is none
_BEYOND_TIP = -0.1  # what lies farther beyond the tip is not located
_UNLOADED = 1e-9  # of EI/L^2: the same for noise-free readings


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
    contact : pandas.DataFrame
        The contact as `analytic.reconstruct` finds it, a row a station.
    """

    phase: Words
    criterion: Floats
    criterion_tolerance: Floats
    shortfall: Floats
    shortfall_tolerance: Floats
    contact: pd.DataFrame

    def __repr__(self) -> str:
        """How many stations there are of each phase."""
        names, counts = np.unique(self.phase, return_counts=True)
        found = ", ".join(
            f"{n} {name or 'untrusted'}" for name, n in zip(names, counts, strict=True)
        )
        return f"Classification({found})"


@np.errstate(divide="ignore", over="ignore", invalid="ignore")  # next to no load: no contact
def classify(readings: Readings) -> Classification:
    """Decide each station's phase by which phase's own condition its readings meet better.

    In Phase B the criterion (26) vanishes and the contact lies short of the tip; in Phase A it is
    the other way round. Each deviation is measured in standard deviations, which the noise of the
    readings gives; the smaller one wins. So no tolerance has to be chosen, and readings that are
    all a little off, as a coarse beam's are, still fall on the right side.

    Parameters
    ----------
    readings : Readings
        One sweep; only the four sensed columns and ``status`` are used.

    Returns
    -------
    Classification
        The phase of each station, and what it was decided by.

    References
    ----------
    C. Will, J. Steigenberger, C. Behn, *Quasi-static object scanning using technical vibrissae*,
    eq. 26, for the criterion.
    """
    beam = readings.beam
    force_x = readings.values("force_x") / beam.force_unit
    force_y = readings.values("force_y") / beam.force_unit
    moment = readings.values("moment_z") / beam.moment_unit
    noise = reading_noise(readings)
    noise_x, noise_y = noise["force_x"] / beam.force_unit, noise["force_y"] / beam.force_unit
    noise_m = noise["moment_z"] / beam.moment_unit
    f = np.hypot(force_x, force_y)
    loaded = f > max(_SIGMAS * np.hypot(noise_x, noise_y), _UNLOADED)

    criterion = np.where(loaded, (2 * force_y - moment**2) / (2 * f), np.nan)
    by_x = criterion * force_x / f**2
    by_y = 1 / f - criterion * force_y / f**2
    by_m = moment / f
    criterion_tolerance = np.sqrt(
        (by_x * noise_x) ** 2 + (by_y * noise_y) ** 2 + (by_m * noise_m) ** 2
    )
    contact, moved = _contacts(readings, noise)
    shortfall = np.where(loaded, _shortfall(contact, beam.length), np.nan)
    variance = np.zeros_like(shortfall)
    for there in moved:
        variance += np.nan_to_num(_shortfall(there, beam.length) - shortfall) ** 2
    shortfall_tolerance = np.sqrt(variance)

    tangent = np.abs(criterion) / criterion_tolerance < np.abs(shortfall) / shortfall_tolerance
    # A negative deviation belongs to neither phase: it is noise about zero, evidence for its own.
    tangent = np.where(shortfall <= 0, False, np.where(criterion <= 0, True, tangent))
    phase = np.where(loaded, np.where(tangent, "tangent", "tip"), "free")
    phase = np.where(readings.trusted, phase, "")
    return Classification(
        phase, criterion, criterion_tolerance, shortfall, shortfall_tolerance, contact
    )


def confusion(judged: Classification, truth: Readings) -> pd.DataFrame:
    """Stations counted by judged phase and by true phase.

    Parameters
    ----------
    judged : Classification
        As the clamp readings show it.
    truth : Readings
        The same sweep, whose source recorded the ``phase``.

    Returns
    -------
    pandas.DataFrame
        Shape (3, 3), rows the truth and columns what was judged, both ``free``, ``tip``,
        ``tangent``.
    """
    known = (judged.phase != "") & truth.trusted
    return pd.crosstab(
        pd.Categorical(truth.table["phase"][known], categories=list(PHASES)),
        pd.Categorical(judged.phase[known], categories=list(PHASES)),
        rownames=["truth"],
        colnames=["judged"],
        dropna=False,
    )


def _contacts(
    readings: Readings, noise: dict[str, float]
) -> tuple[pd.DataFrame, list[pd.DataFrame]]:
    """The contact of the readings, and of the readings each moved by its noise."""
    sensed = readings.table[list(SENSED)]
    moved = [sensed.assign(**{name: sensed[name] + size}) for name, size in noise.items()]
    together = pd.concat([sensed, *moved], ignore_index=True)
    found = reconstruct(Readings(together, readings.beam, readings.source))
    parts = [found.iloc[i : i + len(sensed)] for i in range(0, len(found), len(sensed))]
    return parts[0], parts[1:]


def _shortfall(contact: pd.DataFrame, length: float) -> Floats:
    """NaN where no elastica has such readings; a contact beyond the tip is short by less than 0."""
    found = 1 - contact["contact_arc_length"].to_numpy(dtype=float) / length
    beyond = (contact["status"] == "longer than the vibrissa").to_numpy()
    return np.where(beyond, _BEYOND_TIP, found)
