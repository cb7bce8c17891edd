"""What every budget has: sweeps over the stations that all share, and the parts of a whole."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.numerics.arrays import Booleans, Floats
from analytic.problem.shown import Shown
from analytic.space import SpatialReadings
from compare.judge.tolerances import Tolerances
from compare.measure.disagreement import before_snap_off, rms
from compare.sense.noise import scales
from compare.sense.occurrence import Occurrence
from compare.sense.touching import component_scales

if TYPE_CHECKING:
    from matplotlib.figure import Figure


SAFETY = 1.25
"""Roache's, for a convergence index from three or more grids: how far an extrapolated limit is from
what the finest grid says, and from what the two finest alone would make of it."""
SMALL = 5e-5
"""What counts as small in any case."""
UNRESOLVED = 1e-5
"""What no budget resolves, of a reading's largest magnitude."""
LEFT, _UNSURE = 0.1, 1 / 3
"""What may stay unexplained of a disagreement that counts as explained, and how uncertain it is."""


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
    # Whether it lies within an uncertainty that is not small: then the budget neither closes nor
    # shows that something is missing.
    undecided: bool = field(default=False, kw_only=True)

    @property
    def left(self) -> Part:
        """What stays unexplained where it is most, of readings beyond its uncertainty if any is."""
        parts = self.parts["unexplained"].values()
        beyond = [one for one in parts if one.rms > np.hypot(one.uncertainty, UNRESOLVED)]
        return max(beyond or parts, key=lambda part: part.rms)

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
        rows, wide = np.arange(len(names)), 0.8 / len(self.disagreement)
        for i, reading in enumerate(self.disagreement):
            found = [self.parts[name][reading] for name in names]
            sizes, unsure = zip(*((one.rms, one.uncertainty) for one in found), strict=True)
            ax.barh(rows - i * wide, sizes, wide, xerr=unsure, label=reading)
        ax.set_yticks(rows - wide * (len(self.disagreement) - 1) / 2, names)
        ax.set(xscale="log", xlabel="rms / largest magnitude")
        ax.legend(fontsize="small")

    def to_dict(self) -> dict[str, Any]:
        return asdict(self)


class Shared:
    """The stations that the sweeps of a budget share, seen from the exact one."""

    def __init__(self, exact: Readings | SpatialReadings, kept: Booleans) -> None:
        if not kept.any():
            common, remedy = "common to all sweeps of the budget", "a sweep that chatters has none"
            raise InputError(f"stations {common}", 0, "some", f"see their status: {remedy}")
        self.kept = kept  # shape (stations of the sweep,)
        self._scales: Mapping[str, float] = (
            component_scales(exact) if isinstance(exact, SpatialReadings) else scales(exact)
        )
        self.exact = self.signal(exact)

    @classmethod
    def of(cls, exact: Readings, *runs: Readings) -> Self:
        """Those in contact and trusted in all of the sweeps."""
        return cls(exact, common_stations(exact, runs))

    def signal(self, readings: Readings | SpatialReadings) -> Floats:
        """The clamp readings there, over their largest magnitudes, shape (readings, stations)."""
        sizes = self._scales.items()
        return np.stack([readings.values(name)[self.kept] / (size or 1.0) for name, size in sizes])

    def off(self, readings: Readings | SpatialReadings) -> Floats:
        return self.signal(readings) - self.exact

    def rms(self, signals: Floats) -> dict[str, float]:
        return dict(zip(self._scales, rms(signals).tolist(), strict=True))


class Account:
    """The disagreement of ``runs["base"]``, and the terms that it is taken apart into.

    A term is what a part does at every station, shape (readings, stations), and how uncertain its
    root mean square is, (readings,).
    """

    def __init__(self, shared: Shared, runs: Mapping[str, Readings | SpatialReadings]) -> None:
        self.shared = shared
        self.run = {name: shared.signal(readings) for name, readings in runs.items()}
        self.total = shared.off(runs["base"])
        self.terms: dict[str, tuple[Floats, Floats]] = {}

    def add(self, name: str, signal: Floats, uncertainty: Floats | float = 0.0) -> None:
        self.terms[name] = signal, np.broadcast_to(uncertainty, len(signal))

    def add_uncertain(self, name: str, signal: Floats) -> None:
        """A part that is as uncertain as it is large."""
        self.add(name, signal, rms(signal))

    def add_extrapolated(self, name: str, more: Floats, less: Floats, factor: float) -> None:
        """A part that falls in proportion, from two sweeps of which one has less by a factor."""
        signal = (more - less) * factor / (factor - 1)
        self.add(name, signal, SAFETY * rms(signal) / abs(factor - 1))

    def settle(self) -> tuple[Floats, Floats]:
        """The root mean square of what the parts leave, and how uncertain that is: as all parts."""
        signals, uncertainties = zip(*self.terms.values(), strict=True)
        rest = self.total - np.sum(signals, axis=0)
        self.add("unexplained", rest, np.sqrt(np.sum(np.square(uncertainties), axis=0)))
        return rms(rest), self.terms["unexplained"][1]

    def closing(self) -> dict[str, Any]:
        """Whether what the parts leave is within its uncertainty, and both of them small."""
        rest, unsure = self.terms["unexplained"]
        left, whole = rms(rest), rms(self.total)
        within = bool((left <= np.hypot(unsure, UNRESOLVED)).all())
        small = left <= np.hypot(SMALL, LEFT * whole)
        resolved = bool((small & (unsure <= np.hypot(SMALL, _UNSURE * whole))).all())
        return {"closes": within and resolved, "undecided": within and not resolved}

    def blame(self, sure: bool = False) -> str:
        """The part that dominates, or of which that much is sure."""
        sizes = {
            name: np.linalg.norm(np.maximum(rms(signal) - sure * unsure, 0.0))
            for name, (signal, unsure) in self.terms.items()
        }
        return max(sizes, key=lambda name: float(sizes[name]))

    def common(self) -> dict[str, Any]:
        whole = self.shared.rms(self.total)
        return {
            "parts": {
                name: dict(zip(whole, map(Part, rms(x).tolist(), unsure.tolist()), strict=True))
                for name, (x, unsure) in self.terms.items()
            },
            "disagreement": whole,
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


def convergence(shared: Shared, runs: Sequence[Readings]) -> dict[int, dict[str, float]]:
    """Disagreement at each number of segments, which the sources record."""
    segments = [run.provenance.get("settings", {}).get("segments") for run in runs]
    pairs = zip(segments, runs, strict=True)
    return {int(n): shared.rms(shared.off(run)) for n, run in pairs if n is not None}


def fitted_orders(found: Mapping[int, Mapping[str, float]]) -> dict[str, float]:
    """Order of each reading's disagreement in 1/N: the slope of a line through the logarithms.

    It falls short of the beam's own order where something else than its segments, as the facets of
    the obstacle, is what is left at the finest ones.
    """
    n = np.log(list(found))
    return {
        name: -float(np.polyfit(n, np.log([errors[name] for errors in found.values()]), 1)[0])
        for name in CLAMP_READINGS
    }
