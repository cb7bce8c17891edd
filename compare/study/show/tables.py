"""The numbers that a study comes to: outcomes, observed orders, and where Phase B vanishes."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS
from analytic.problem.arrays import Floats
from compare.align.frames import COMPONENTS
from compare.study.grid.study import BEAM
from compare.study.show.results import REFINED, StudyResults, together

ONLY_IN_SPACE = tuple(name for name in COMPONENTS if name not in CLAMP_READINGS)


def outcomes(found: StudyResults) -> pd.DataFrame:
    missing = len(found.plan) - len(found.rows)
    table = found.rows.groupby("outcome").agg(runs=("run", "size"), example=("reason", "first"))
    table = table.reset_index()
    if missing:
        waiting = pd.DataFrame({"outcome": ["not done yet"], "runs": [missing], "example": [""]})
        table = pd.concat([table, waiting], ignore_index=True)
    return table


def orders(found: StudyResults) -> pd.DataFrame:
    """Determine how fast the disagreement falls as a number is refined.

    The other refined numbers are at their largest, so that their error hides the least of it.
    """
    refined = [axis for axis in REFINED if axis in found.axes]
    groups = [key for key in (*found.plain_axes, BEAM) if key in found.done and key not in refined]
    rows = []
    for axis in refined:
        done = found.done
        for other in refined:
            if other != axis and not together(done, axis, other):
                done = done[done[other] == done[other].max()]
        for values, group in _grouped(done, groups):
            for name in (*CLAMP_READINGS, *ONLY_IN_SPACE):
                metric = f"disagreement_{name}_rms"
                if metric not in group:
                    continue
                error = group.groupby(axis)[metric].median()
                if len(error) < 2 or not (error > 0).all():
                    continue
                log_n, log_e = np.log(error.index.to_numpy(dtype=float)), np.log(error.to_numpy())
                rows.append(
                    {
                        "refined": axis,
                        **values,
                        "reading": name,
                        "order": -np.polyfit(log_n, log_e, 1)[0],
                        "last": -(log_e[-1] - log_e[-2]) / (log_n[-1] - log_n[-2]),
                        "error at the finest": error.iloc[-1],
                    }
                )
    return pd.DataFrame(rows)


def vanishing(found: StudyResults) -> pd.DataFrame:
    """Find where Phase B vanishes: where the contact length's minimum (eq. 21) passes 1."""
    rows = []
    if "contact_length_minimum" in found.done:
        for axis in found.plain_axes:
            others = [key for key in found.plain_axes if key != axis]
            for values, group in _grouped(found.done, others):
                line = group.groupby(axis)["contact_length_minimum"].first() - 1
                x, y = line.index.to_numpy(dtype=float), line.to_numpy()
                rows += [
                    {"axis": axis, **values, "vanishes at": float(zero)} for zero in _zeros(x, y)
                ]
    return pd.DataFrame(rows)


def pareto_front(done: pd.DataFrame, cost: str, error: str) -> pd.DataFrame:
    """Choose the runs that no other run beats in both cost and error."""
    ordered = done[[cost, error]].dropna().sort_values([cost, error])
    best = ordered[error].cummin()
    return ordered[(ordered[error] == best) & ~best.duplicated()]


def _zeros(x: Floats, y: Floats) -> Floats:
    """Where the polygon through the points changes its sign, by linear interpolation."""
    i = np.flatnonzero(np.diff(np.sign(y)))
    return np.asarray(x[i] - y[i] * (x[i + 1] - x[i]) / (y[i + 1] - y[i]))


def _grouped(
    done: pd.DataFrame, keys: Sequence[str]
) -> Iterator[tuple[dict[str, object], pd.DataFrame]]:
    if not keys:
        yield {}, done
        return
    for values, group in done.groupby(list(keys)):
        yield dict(zip(keys, values, strict=True)), group
