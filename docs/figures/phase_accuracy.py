"""How well the contact phases are determined from the clamp: counts by case, engine and noise."""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS, PHASES, Readings
from analytic.numerics.arrays import Integers
from compare.sense.noise import with_noise
from compare.sense.phases import classify, confusion
from compare.sense.transitions import TRANSITIONS, locate_transitions

LEVELS = (0.0, 1e-3, 1e-2)
"""Noise of the clamp readings, relative to their largest magnitudes."""


def phase_table(
    sweeps: Mapping[str, Iterable[Readings]],
    levels: Sequence[float] = LEVELS,
    seeds: Sequence[int] = range(10),
) -> pd.DataFrame:
    """Judged phases against the contact truth, summed over the seeds of the noise."""
    return pd.DataFrame(
        [
            _row(case, sweep, level, seeds if level else seeds[:1])
            for case, several in sweeps.items()
            for sweep in several
            for level in levels
        ]
    )


def _row(case: str, sweep: Readings, level: float, seeds: Sequence[int]) -> dict[str, object]:
    counts = np.zeros((len(PHASES), len(PHASES)), dtype=int)
    off: dict[str, list[float]] = {name: [] for name in TRANSITIONS}
    missed = 0
    true = true_transitions(sweep)
    step = float(np.median(np.abs(np.diff(sweep.values("foot_x")))))
    for seed in seeds:
        noisy = with_noise(sweep, dict.fromkeys(CLAMP_READINGS, level), seed) if level else sweep
        judged = classify(noisy)
        counts += confusion(judged, sweep).to_numpy()
        for name, (found, _) in locate_transitions(noisy, judged).items():
            expected = true[name]
            if expected is not None and found is not None:
                off[name].append(abs(found - expected) / step)
            missed += expected is not None and found is None
    return {
        "case": case,
        "source": sweep.source,
        "noise": level,
        "right": float(np.trace(counts) / counts.sum()),
        **{
            f"{truth}_as_{judged_}": int(counts[i, j])
            for i, truth in enumerate(PHASES)
            for j, judged_ in enumerate(PHASES)
        },
        **{name: max(stations, default=np.nan) for name, stations in off.items()},
        "missed": missed,
    }


def true_transitions(sweep: Readings) -> dict[str, float | None]:
    """Where the phases that the source recorded change."""
    phase, foot_x = sweep.table["phase"].to_numpy(), sweep.values("foot_x")
    touching = np.flatnonzero(phase != "free")
    tangent = np.flatnonzero(phase == "tangent")

    def between(before: Integers | int, after: Integers | int) -> float:
        return float(foot_x[before] + foot_x[after]) / 2

    places: dict[str, float | None] = dict.fromkeys(TRANSITIONS)
    if touching.size and touching[0] > 0:
        places["first_contact"] = between(touching[0] - 1, touching[0])
    if tangent.size and tangent[0] > touching[0]:
        places["phase_b_start"] = between(tangent[0] - 1, tangent[0])
    if tangent.size and tangent[-1] < touching[-1]:
        places["phase_b_end"] = between(tangent[-1], tangent[-1] + 1)
    return places
