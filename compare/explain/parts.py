"""What every budget has: sweeps over the stations that all share, and the parts of a whole."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.problem.arrays import Booleans, Floats
from analytic.problem.shown import Shown
from compare.judge.tolerances import Tolerances
from compare.measure.disagreement import before_snap_off, rms
from compare.sense.noise import scales
from compare.sense.occurrence import Occurrence

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SAFETY = 1.25
"""Roache's, for a convergence index from three or more grids: how far an extrapolated limit is from
what the finest grid says, and from what the two finest alone would make of it."""


@dataclass(frozen=True)
class Part:
    """One part of the disagreement of one reading, relative to its largest magnitude."""

    rms: float
    uncertainty: float


@dataclass(frozen=True, repr=False)
class Parted(Shown):
    """What every disagreement that was taken apart has."""

    parts: dict[str, dict[str, Part]]  # by name and reading
    # Root mean square by reading, over the stations in contact and trusted in all sweeps: fewer
    # than a comparison's, where some of them failed to settle.
    disagreement: dict[str, float]
    order: float  # observed, in the number of segments or in the speed
    # Whether what is unexplained lies within the uncertainty of the parts, and is small.
    closes: bool
    blame: str  # the part that dominates
    stations: int  # compared stations

    @property
    def left(self) -> Part:
        """What stays unexplained, of the reading where it is most."""
        return max(self.parts["unexplained"].values(), key=lambda part: part.rms)

    def _tiles(self) -> dict[str, object]:
        left = self.left
        return {
            "closes": self.closes,
            "largest part": self.blame,
            "unexplained": f"{left.rms:.1e} +- {left.uncertainty:.1e}",
            "disagreement": ", ".join(f"{n} {x:.1e}" for n, x in self.disagreement.items()),
            "stations": self.stations,
        }

    def _draw(self, figure: "Figure") -> None:
        ax, names = figure.subplots(), [*self.parts][::-1]
        rows, wide = np.arange(len(names)), 0.8 / len(CLAMP_READINGS)
        for i, reading in enumerate(CLAMP_READINGS):
            found = [self.parts[name][reading] for name in names]
            sizes, unsure = zip(*((one.rms, one.uncertainty) for one in found), strict=True)
            ax.barh(rows - i * wide, sizes, wide, xerr=unsure, label=reading)
        ax.set_yticks(rows - wide, names)
        ax.set(xscale="log", xlabel="rms / largest magnitude")
        ax.legend(fontsize="small")

    def to_dict(self) -> dict[str, Any]:
        """What the budget's JSON file holds."""
        return asdict(self)


class Shared:
    """The stations that the sweeps of a budget share, seen from the exact one."""

    def __init__(self, exact: Readings, kept: Booleans) -> None:
        if not kept.any():
            raise InputError(
                "stations common to all sweeps of the budget",
                0,
                "some",
                "see their status: a sweep that chatters has none",
            )
        self.kept = kept  # shape (stations of the sweep,)
        self._scales = scales(exact)
        self.exact = self.signal(exact)

    @classmethod
    def of(cls, exact: Readings, *runs: Readings) -> Self:
        """Those in contact and trusted in all of the sweeps."""
        return cls(exact, common_stations(exact, runs))

    def signal(self, readings: Readings) -> Floats:
        """The clamp readings there, over their largest magnitudes, shape (3, stations)."""
        return np.stack(
            [readings.values(name)[self.kept] / size for name, size in self._scales.items()]
        )

    def off(self, readings: Readings) -> Floats:
        """What they are off by."""
        return self.signal(readings) - self.exact


class Account:
    """The disagreement of ``runs["base"]``, and the terms that it is taken apart into.

    A term is what a part does at every station, shape (3, stations), and how uncertain its root
    mean square is, (3,).
    """

    def __init__(self, shared: Shared, runs: Mapping[str, Readings]) -> None:
        self.shared = shared
        self.run = {name: shared.signal(readings) for name, readings in runs.items()}
        self.total = shared.off(runs["base"])
        self.terms: dict[str, tuple[Floats, Floats]] = {}

    def add(self, name: str, signal: Floats, uncertainty: Floats | float = 0.0) -> None:
        """A part, known to so much."""
        self.terms[name] = signal, np.broadcast_to(uncertainty, len(signal))

    def add_uncertain(self, name: str, signal: Floats) -> None:
        """A part that is as uncertain as it is large."""
        self.add(name, signal, rms(signal))

    def add_extrapolated(self, name: str, more: Floats, less: Floats, factor: float) -> None:
        """A part that falls in proportion, from two sweeps of which one has less by a factor."""
        signal = (more - less) * factor / (factor - 1)
        self.add(name, signal, SAFETY * rms(signal) / (factor - 1))

    def settle(self) -> tuple[Floats, Floats]:
        """The root mean square of what the parts leave, and how uncertain that is: as all parts."""
        signals, uncertainties = zip(*self.terms.values(), strict=True)
        rest = self.total - np.sum(signals, axis=0)
        self.add("unexplained", rest, np.sqrt(np.sum(np.square(uncertainties), axis=0)))
        return rms(rest), self.terms["unexplained"][1]

    def blame(self, sure: bool = False) -> str:
        """The part that dominates, or of which that much is sure."""
        sizes = {
            name: np.linalg.norm(np.maximum(rms(signal) - sure * unsure, 0.0))
            for name, (signal, unsure) in self.terms.items()
        }
        return max(sizes, key=lambda name: float(sizes[name]))

    def common(self) -> dict[str, Any]:
        """What every budget has of it."""
        return {
            "parts": {
                name: {
                    reading: Part(*sizes)
                    for reading, *sizes in zip(
                        CLAMP_READINGS, rms(signal).tolist(), unsure.tolist(), strict=True
                    )
                }
                for name, (signal, unsure) in self.terms.items()
            },
            "disagreement": by_reading(self.total),
            "stations": int(self.shared.kept.sum()),
        }


def common_stations(
    exact: Readings, runs: Iterable[Readings], window: float = Tolerances.snap_off_window
) -> Booleans:
    """Stations in contact and trusted in every sweep, outside the window before the snap-off."""
    along = exact.running_values
    kept = np.ones(len(along), dtype=bool)
    for readings in (exact, *runs):
        kept &= readings.trusted & (readings.table["phase"] != "free").to_numpy()
    if exact.snap_off is not None:
        kept &= ~before_snap_off(exact, along, Occurrence(exact.snap_off, None), window)
    return kept


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
