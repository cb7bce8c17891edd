"""The numbers that a study comes to: outcomes, curves, orders, and where Phase B vanishes."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from analytic import CLAMP_READINGS
from analytic.problem.arrays import Floats
from compare.study.grid.plan import Plan
from compare.study.grid.study import BEAM

REFINED = ("mujoco.segments", "mujoco.contour_points", "sweep.stations")
"""Parameters that should make the disagreement fall."""
WORST = "disagreement_worst_rms"
_BAND = (0.1, 0.9)  # quantiles over everything else that varies


@dataclass(frozen=True)
class StudyResults:
    """What is stored of a study, as its reports look at it.

    Attributes
    ----------
    plan : Plan
        What was to be done.
    rows : pandas.DataFrame
        A row a run of the plan, whatever its outcome.
    done : pandas.DataFrame
        Those whose numbers count, with a column `WORST`: the largest of the clamp readings' rms
        disagreements.
    axes : tuple of str
        Numeric parameters that take more than one value.
    """

    plan: Plan
    rows: pd.DataFrame
    done: pd.DataFrame
    axes: tuple[str, ...]

    @classmethod
    def of(cls, plan: Plan, rows: pd.DataFrame) -> "StudyResults":
        """Those rows that belong to `plan`."""
        rows = rows[rows["run"].isin({run.id for run in plan})]
        done = rows[rows["outcome"] == "done"]
        readings = [f"disagreement_{name}_rms" for name in CLAMP_READINGS]
        if readings[0] in done:
            done = done.assign(**{WORST: done[readings].max(axis=1)})
        keys = [key for axis in plan.study.crossed for key in axis.keys]
        numeric = done.select_dtypes("number")
        axes = tuple(key for key in keys if key in numeric and len(numeric[key].unique()) > 1)
        return cls(plan, rows, done, axes)

    @property
    def plain_axes(self) -> tuple[str, ...]:
        """The axes without those whose values only repeat the run."""
        return tuple(key for key in self.axes if key != "noise.seed")


def outcomes(found: StudyResults) -> pd.DataFrame:
    """How many runs came to what, and one reason for each."""
    missing = len(found.plan) - len(found.rows)
    table = found.rows.groupby("outcome").agg(runs=("run", "size"), example=("reason", "first"))
    table = table.reset_index()
    if missing:
        waiting = pd.DataFrame({"outcome": ["not done yet"], "runs": [missing], "example": [""]})
        table = pd.concat([table, waiting], ignore_index=True)
    return table


def curve(found: StudyResults, axis: str, metric: str) -> pd.DataFrame:
    """Median of the size of `metric` and the band that holds 80 %, for each value of `axis`.

    A sampled axis is cut into stretches with equally many runs.
    """
    done = found.done[[axis, metric]].dropna()
    place = done[axis]
    if place.nunique() > 30:
        place = place.groupby(pd.qcut(place, 20)).transform("median")
    grouped = done[metric].abs().groupby(place)
    low, high = (grouped.quantile(q) for q in _BAND)
    table = pd.DataFrame({"median": grouped.median(), "low": low, "high": high})
    return table.rename_axis(axis).reset_index()


def curves(found: StudyResults, metrics: Sequence[str]) -> pd.DataFrame:
    """All curves in one long table."""
    tables = [
        curve(found, axis, metric).rename(columns={axis: "value"}).assign(axis=axis, metric=metric)
        for axis in found.plain_axes
        for metric in metrics
    ]
    columns = ["axis", "metric", "value", "median", "low", "high"]
    return pd.concat(tables)[columns] if tables else pd.DataFrame(columns=columns)


def orders(found: StudyResults) -> pd.DataFrame:
    """Observed orders: how fast the disagreement falls as a number is refined.

    The other refined numbers are at their largest, so that their error hides the least of it.
    ``order`` is the slope of the log-log fit, ``last`` that of the last two values alone: much
    smaller where another error has taken over.
    """
    refined = [axis for axis in REFINED if axis in found.axes]
    groups = [key for key in (*found.plain_axes, BEAM) if key in found.done and key not in refined]
    found_rows = []
    for axis in refined:
        done = found.done
        for other in refined:
            if other != axis and not together(done, axis, other):
                done = done[done[other] == done[other].max()]
        for values, group in _grouped(done, groups):
            for name in CLAMP_READINGS:
                error = group.groupby(axis)[f"disagreement_{name}_rms"].median()
                if len(error) < 2 or not (error > 0).all():
                    continue
                log_n, log_e = np.log(error.index.to_numpy(dtype=float)), np.log(error.to_numpy())
                found_rows.append(
                    {
                        "refined": axis,
                        **values,
                        "reading": name,
                        "order": -np.polyfit(log_n, log_e, 1)[0],
                        "last": -(log_e[-1] - log_e[-2]) / (log_n[-1] - log_n[-2]),
                        "error at the finest": error.iloc[-1],
                    }
                )
    return pd.DataFrame(found_rows)


def vanishing(found: StudyResults) -> pd.DataFrame:
    """Where Phase B vanishes: the contact length's minimum (eq. 21) passes 1, interpolated."""
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
    """The runs that no other run beats in both, by ascending cost."""
    ordered = done[[cost, error]].dropna().sort_values([cost, error])
    best = ordered[error].cummin()
    return ordered[(ordered[error] == best) & ~best.duplicated()]


def _zeros(x: Floats, y: Floats) -> Floats:
    """Where the polygon through the points changes its sign, by linear interpolation."""
    i = np.flatnonzero(np.diff(np.sign(y)))
    return np.asarray(x[i] - y[i] * (x[i + 1] - x[i]) / (y[i + 1] - y[i]))


def together(done: pd.DataFrame, one: str, other: str) -> bool:
    """Whether two axes are zipped: a value of the one goes with one value of the other."""
    return int(done.groupby(one)[other].nunique().max()) == 1


def _grouped(
    done: pd.DataFrame, keys: Sequence[str]
) -> Iterator[tuple[dict[str, object], pd.DataFrame]]:
    """The runs by the values of `keys`."""
    if not keys:
        yield {}, done
        return
    for values, group in done.groupby(list(keys)):
        yield dict(zip(keys, values, strict=True)), group
