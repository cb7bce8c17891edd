"""How well the clamp tells the phases when its sensor is noisy."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd

from analytic import Readings
from compare.findings.collect import Run
from compare.phases import classify, confusion
from compare.study.noise import Noise
from compare.transitions import locate_transitions

LEVELS = (0.0, 1e-3, 1e-2)  # standard deviation of the noise, of each largest magnitude


@dataclass(frozen=True)
class Judgement:
    """The phases of one run, judged through noise.

    `table` counts stations by contact truth (rows) and judged phase (columns); `apart` is how many
    stations the farthest transition lies from the reference's, None where the two do not have the
    same transitions.
    """

    case: str
    noise: float
    table: pd.DataFrame
    apart: float | None

    @property
    def right(self) -> float:
        """Share of the stations on the diagonal."""
        counts = self.table.to_numpy()
        return float(np.trace(counts) / counts.sum())


def judgements(runs: list[Run]) -> Iterator[Judgement]:
    """Of the first run of each case whose readings are there and tell the contact's truth."""
    seen = set()
    for run in runs:
        file = run.folder / f"mujoco-{run.beam}.parquet"
        if run.case in seen or not file.exists():
            continue
        seen.add(run.case)
        readings = Readings.read(file)
        for level in LEVELS:
            noisy = Noise(relative=level).add_to(readings)
            judged = classify(noisy)
            found = locate_transitions(noisy, judged)
            apart = _stations_apart(run, readings, dict(found))
            yield Judgement(run.case, level, confusion(judged, readings), apart)


def _stations_apart(run: Run, readings: Readings, found: dict[str, float | None]) -> float | None:
    step = float(np.abs(np.diff(readings.values("foot_x"))).mean())
    apart = [0.0]
    for name, place in run.comparison["phases"]["transitions"].items():
        true, seen = place["reference"], found[name]
        if true is None and seen is None:
            continue
        if true is None or seen is None:
            return None
        apart.append(abs(seen - true) / step)
    return max(apart)
