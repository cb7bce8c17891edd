"""How the disagreement falls as the beam's segments are refined."""

from collections.abc import Mapping, Sequence

import numpy as np

from analytic import CLAMP_READINGS, Readings
from compare.explain.parts import Shared


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
