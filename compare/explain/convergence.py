"""How the disagreement falls as the beam's segments are refined."""

from collections.abc import Iterable, Mapping

import numpy as np

from analytic import CLAMP_READINGS, Readings
from analytic.problem.arrays import Booleans
from compare.explain.parts import Shared, by_reading


def convergence(
    exact: Readings, runs: Iterable[Readings], kept: Booleans
) -> dict[int, dict[str, float]]:
    """Disagreement with `exact` at each number of segments, which the sources record."""
    found = {}
    for readings in runs:
        segments = readings.provenance.get("settings", {}).get("segments")
        if segments is not None:
            found[int(segments)] = by_reading(Shared(exact, kept).off(readings))
    return found


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
