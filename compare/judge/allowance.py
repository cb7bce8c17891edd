"""What noise of the readings adds to the limits of agreement."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.special import ndtri

from analytic import CLAMP_READINGS, Readings
from compare.sense.noise import with_noise
from compare.sense.phases import classify
from compare.sense.transitions import TRANSITIONS, locate_transitions

_RISK = 1e-3  # of a false alarm, for each limit that noise widens
_REPLICAS = 24  # of the reference, each with noise of its own
_STATIONS = 2000  # that a replica has at most: a longer sweep is thinned out for this alone
_SIGMAS = 3


@dataclass(frozen=True)
class NoiseAllowance:
    """What noise of the readings adds to the limits of agreement."""

    # Standard deviation of each clamp reading's noise, relative to its largest magnitude.
    level: Mapping[str, float] = field(default_factory=lambda: dict.fromkeys(CLAMP_READINGS, 0.0))
    # How far noise may move each transition that is located from the clamp [length].
    transitions: Mapping[str, float] = field(default_factory=dict)
    # Share of stations whose phase can still be determined; 1 without noise.
    phase_agreement: float = 1.0

    def rms(self, limit: float, reading: str, stations: int) -> float:
        """The rms that a sweep at the limit still shows with noise, but for one case in 1000."""
        square = self.level[reading] ** 2
        spread = np.sqrt((2 * square**2 + 4 * square * limit**2) / max(stations, 1))
        return float(np.sqrt(limit**2 + square - ndtri(_RISK) * spread))

    def max(self, limit: float, reading: str, stations: int) -> float:
        """The largest difference that a sweep at the limit still shows with noise."""
        return float(limit - ndtri(_RISK / 2 / max(stations, 1)) * self.level[reading])


def noise_allowance(reference: Readings, level: Mapping[str, float]) -> NoiseAllowance:
    """What noise of that `level` does to the reference, from replicas of it."""
    if not any(level.values()):
        return NoiseAllowance()
    stride = -(-len(reference.table) // _STATIONS)
    thinned = reference.table.iloc[::stride].reset_index(drop=True)
    reference = replace(reference, table=thinned) if stride > 1 else reference
    calm = locate_transitions(reference, classify(reference))
    true = reference.table["phase"].to_numpy() if "phase" in reference.table else None
    moved: dict[str, list[float]] = {name: [] for name in TRANSITIONS}
    shares = []
    for seed in range(_REPLICAS):
        noisy = with_noise(reference, level, seed)
        judged = classify(noisy)
        for name, found in locate_transitions(noisy, judged).items():
            expected = calm[name]
            if found is not None and expected is not None:
                moved[name].append(found - expected)
        known = judged.phase != ""
        if true is not None and known.any():
            shares.append(np.mean(judged.phase[known] == true[known]))
    share = float(np.mean(shares) - _SIGMAS * np.std(shares)) if shares else 1.0
    return NoiseAllowance(
        level,
        {n: _SIGMAS * float(np.sqrt(np.mean(np.square(m)))) for n, m in moved.items() if m},
        max(share, 0.0),
    )
