"""What every budget has: sweeps over the stations that all share, and the parts of a whole."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.problem.arrays import Booleans, Floats
from compare.measure.disagreement import before_snap_off, rms
from compare.sense.noise import scales
from compare.sense.occurrence import Occurrence

SAFETY = 1.25
"""Roache's, for a convergence index from three or more grids: how far an extrapolated limit is from
what the finest grid says, and from what the two finest alone would make of it."""


@dataclass(frozen=True)
class Part:
    """One part of the disagreement of one reading, relative to its largest magnitude."""

    rms: float
    uncertainty: float


@dataclass(frozen=True)
class Shared:
    """The stations that the sweeps of a budget share, seen from the exact one."""

    exact: Readings
    kept: Booleans  # shape (stations of the sweep,)

    def __post_init__(self) -> None:
        if not self.kept.any():
            raise InputError(
                "stations common to all sweeps of the budget",
                0,
                "some",
                "see their status: a sweep that chatters has none",
            )

    def signal(self, readings: Readings) -> Floats:
        """The clamp readings there, over their largest magnitudes, shape (3, stations)."""
        return np.stack(
            [readings.values(name)[self.kept] / size for name, size in scales(self.exact).items()]
        )

    def off(self, readings: Readings) -> Floats:
        """What they are off by."""
        return self.signal(readings) - self.signal(self.exact)


def common_stations(exact: Readings, runs: Iterable[Readings], window: float) -> Booleans:
    """Stations in contact and trusted in every sweep, outside the window before the snap-off."""
    foot_x = exact.values("foot_x")
    kept = np.ones(len(foot_x), dtype=bool)
    for readings in (exact, *runs):
        kept &= readings.trusted & (readings.table["phase"] != "free").to_numpy()
    if exact.snap_off is not None:
        kept &= ~before_snap_off(exact, foot_x, Occurrence(exact.snap_off, None), window)
    return kept


def with_unexplained(whole: Floats, signals: Mapping[str, Floats]) -> dict[str, Floats]:
    """The parts of a whole, and what they leave of it."""
    return {**signals, "unexplained": whole - np.sum(list(signals.values()), axis=0)}


def root_of_squares(uncertainties: Iterable[Floats]) -> Floats:
    """The uncertainty of a sum."""
    return np.asarray(np.sqrt(np.sum([u**2 for u in uncertainties], axis=0)))


def parts_of(
    names: Iterable[str], sizes: Mapping[str, Floats], uncertainties: Mapping[str, Floats]
) -> dict[str, dict[str, Part]]:
    """The parts by name and reading."""
    return {
        name: {
            reading: Part(float(sizes[name][i]), float(uncertainties[name][i]))
            for i, reading in enumerate(CLAMP_READINGS)
        }
        for name in names
    }


def observed_order(coarse: Floats, fine: Floats, nominal: float, least: float) -> float:
    """Order of convergence of two refinements by a factor of two, within what it can be.

    Nominal where neither changes anything.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        observed = np.log2(np.linalg.norm(coarse) / np.linalg.norm(fine))
    return float(np.clip(np.nan_to_num(observed, nan=nominal), least, 2.0))


def by_reading(signals: Floats) -> dict[str, float]:
    """The root mean square of each reading."""
    return dict(zip(CLAMP_READINGS, rms(signals).tolist(), strict=True))
