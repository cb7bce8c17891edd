"""What noise of the readings adds to the limits of agreement."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.special import ndtri

from analytic import CLAMP_READINGS, Readings
from analytic.numerics.arrays import Booleans, Floats
from analytic.space import SpatialReadings
from analytic.space.from_clamp.reconstruct import contacts_moved
from compare.align.frames import COMPONENTS
from compare.sense.noise import Noise, with_noise
from compare.sense.phases import classify
from compare.sense.transitions import TRANSITIONS, locate_transitions

_RISK = 1e-3  # of a false alarm, for each limit that noise widens
_REPLICAS = 24  # of the reference, each with noise of its own
_STATIONS = 2000  # that a replica has at most: a longer sweep is thinned out for this alone
_STATIONS_IN_SPACE = 10_000  # that an rms is estimated from: more take memory, and say the same
_SIGMAS = 3


@dataclass(frozen=True)
class Allowance:
    """What noise adds to the limits of the components."""

    level: Mapping[str, float]  # its standard deviation, relative to the largest of each component
    unsure: Mapping[str, float] = field(default_factory=dict)  # relative, standard, of that
    # Fraction of the stations of which independent noise would say as much of its size.
    independent: Mapping[str, float] = field(default_factory=dict)

    def rms(self, limit: float, component: str, stations: int) -> float:
        """The rms that a sweep at the limit still shows with noise, but for one case in 1000."""
        square = self.level[component] ** 2
        independent = max(self.independent.get(component, 1.0) * stations, 1.0)
        spread = np.sqrt((2 * square**2 + 4 * square * limit**2) / independent)
        spread = np.hypot(spread, 2 * square * self.unsure.get(component, 0.0))
        return float(np.sqrt(limit**2 + square - ndtri(_RISK) * spread))

    def max(self, limit: float, component: str, stations: int) -> float:
        """The largest difference that a sweep at the limit still shows with noise."""
        most = self.level[component] * (1 - ndtri(_RISK) * self.unsure.get(component, 0.0))
        return float(limit - ndtri(_RISK / 2 / max(stations, 1)) * most)


@dataclass(frozen=True)
class NoiseAllowance(Allowance):
    level: Mapping[str, float] = field(default_factory=lambda: dict.fromkeys(CLAMP_READINGS, 0.0))
    # How far noise may move each transition that is located from the clamp [length].
    transitions: Mapping[str, float] = field(default_factory=dict)
    # Fraction of stations whose phase can still be determined; 1 without noise.
    phase_agreement: float = 1.0


@dataclass(frozen=True)
class SpatialAllowance(Allowance):
    level: Mapping[str, float] = field(default_factory=lambda: dict.fromkeys(COMPONENTS, 0.0))
    # The rms of contact points that noise alone moves, in all but one of 400 cases [L].
    contact: float = 0.0
    unknown: float = 0.0  # fraction of stations at which it leaves no contact, in as many cases


def noise_allowance(reference: Readings, noise: Noise) -> NoiseAllowance:
    """What such noise does to the reference, from replicas of it."""
    level = noise.level
    if not any(level.values()):
        return NoiseAllowance()
    stride = -(-len(reference.table) // _STATIONS)
    thinned = reference.table.iloc[::stride].reset_index(drop=True)
    reference = replace(reference, table=thinned) if stride > 1 else reference
    calm = locate_transitions(reference, classify(reference))
    true = reference.table["phase"].to_numpy() if "phase" in reference.table else None
    moved: dict[str, list[float]] = {name: [] for name in TRANSITIONS}
    right = []
    for seed in range(_REPLICAS):
        noisy = with_noise(reference, level, seed)
        judged = classify(noisy)
        for name, (found, _) in locate_transitions(noisy, judged).items():
            expected, _ = calm[name]
            if found is not None and expected is not None:
                moved[name].append(found - expected)
        known = judged.phase != ""
        if true is not None and known.any():
            right.append(np.mean(judged.phase[known] == true[known]))
    fraction = float(np.mean(right) - _SIGMAS * np.std(right)) if right else 1.0
    far = {n: _SIGMAS * float(np.sqrt(np.mean(np.square(m)))) for n, m in moved.items() if m}
    return NoiseAllowance(*noise, far, max(fraction, 0.0))


def spatial_allowance(
    reference: SpatialReadings,
    level: Mapping[str, float],
    stated: Mapping[str, float],
    clear: Booleans,
) -> SpatialAllowance:
    """What noise of that `level` does to the reference's contacts, at stations clear of it."""
    if not any(level.values()):
        return SpatialAllowance()
    if not clear.any():
        return SpatialAllowance(level)
    some = np.flatnonzero(clear)
    some = some[:: len(some) // _STATIONS_IN_SPACE + 1]
    moved: Floats = contacts_moved(reference, stated, some) / reference.beam.length
    known = np.isfinite(moved)
    squares = np.where(known, moved, 0.0) ** 2
    rms = np.sqrt(squares.sum(axis=1) / np.maximum(known.sum(axis=1), 1))
    return SpatialAllowance(
        level, contact=float(rms.max()), unknown=float((~known).mean(axis=1).max())
    )
