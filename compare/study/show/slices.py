"""Lines through a study's grid: one number over one axis, with everything else held."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from analytic.problem.arrays import Floats
from compare.study.show.results import REFINED, SEED, StudyResults, together

_BAND = (0.1, 0.9)  # quantiles over repetitions and samples
_ROUNDING = 1e-9
_BINS = 20  # that a sampled axis is cut into
_LINES = {1: 5, 2: 3}  # lines a beam, by the number of beams; more cannot be distinguished


@dataclass(frozen=True)
class Line:
    """One number over one axis."""

    beam: str  # whose it is; ``""`` in a study without simulation
    # Values of the other axes; those that are not here are repeated or sampled.
    held: dict[str, float]
    # Columns ``value`` (of the axis), ``median``, ``low``, ``high`` (the band that holds 80 % of
    # the repetitions and samples) and ``runs``.
    table: pd.DataFrame


def lines(found: StudyResults, axis: str, metric: str) -> list[Line]:
    cut = []
    groups = [
        (beam, group)
        for beam, group in found.by_beam(metric)
        if _varies(group[axis]) and _matters(found, group, axis, metric)
    ]
    most = _LINES.get(len(groups), 2)
    for beam, group in groups:
        crossed = _crossed(found, group, [axis], metric)
        if not crossed:
            cut.append(Line(beam, {}, _table(found, group, axis, metric)))
            continue
        first, *others = crossed
        held, rest = _hold(group, others)
        for value in _some(np.unique(rest[first]), most):
            chosen = _at(rest, {first: value})
            if _varies(chosen[axis]):
                here = {first: float(value), **held}
                cut.append(Line(beam, here, _table(found, chosen, axis, metric)))
    return cut


def curves(found: StudyResults, metrics: Sequence[str]) -> pd.DataFrame:
    """Put all lines of several numbers into one long table."""
    tables = [
        line.table.assign(axis=axis, metric=metric, beam=line.beam, held=words(line.held))
        for axis in found.plain_axes
        for metric in metrics
        for line in lines(found, axis, metric)
    ]
    columns = ["axis", "metric", "beam", "held", "value", "median", "low", "high", "runs"]
    return pd.concat(tables)[columns] if tables else pd.DataFrame(columns=columns)


def words(held: Mapping[str, float]) -> str:
    """Name what is held, as ``mujoco.segments = 40``."""
    return ", ".join(f"{axis} = {value:.4g}" for axis, value in held.items())


def plane(
    found: StudyResults, group: pd.DataFrame, axes: Sequence[str], metric: str
) -> tuple[dict[str, float], pd.DataFrame]:
    """Hold all axes but some."""
    return _hold(group, _crossed(found, group, axes, metric))


def _crossed(
    found: StudyResults, group: pd.DataFrame, axes: Sequence[str], metric: str
) -> list[str]:
    """The axes that are crossed with `axes` in a grid; of those that are zipped, the first."""
    crossed: list[str] = []
    for other in found.plain_axes:
        if other in axes or other in found.sampled or not _varies(group[other]):
            continue
        if any(together(group, one, other) for one in [*axes, *crossed]):
            continue
        if _matters(found, group, other, metric):
            crossed.append(other)
    return crossed


def _matters(found: StudyResults, group: pd.DataFrame, axis: str, metric: str) -> bool:
    """Whether a number depends on an axis where everything else is equal, beyond rounding."""
    others = [
        other
        for other in found.axes
        if other != axis and _varies(group[other]) and not together(group, axis, other)
    ]
    if axis in found.sampled or not others:
        return True
    sizes = group.groupby(others)[metric]
    spread = sizes.max() - sizes.min()
    return bool((sizes.size() == 1).all() or (spread > _ROUNDING * sizes.max().abs()).any())


def _hold(group: pd.DataFrame, axes: Sequence[str]) -> tuple[dict[str, float], pd.DataFrame]:
    held = {axis: _held(axis, group[axis]) for axis in axes}
    return held, _at(group, held)


def _varies(values: pd.Series) -> bool:
    return bool(values.min() < values.max())


def _held(axis: str, values: pd.Series) -> float:
    distinct = np.unique(values)
    return float(distinct[-1] if axis in REFINED else distinct[len(distinct) // 2])


def _some(values: Floats, most: int) -> Floats:
    """At most so many of the values, the first and the last among them."""
    if len(values) <= most:
        return values
    chosen = np.unique(np.rint(np.linspace(0, len(values) - 1, most)).astype(int))
    return np.asarray(values[chosen])


def _at(group: pd.DataFrame, held: Mapping[str, float]) -> pd.DataFrame:
    for axis, value in held.items():
        group = group[group[axis] == value]
    return group


def _table(found: StudyResults, group: pd.DataFrame, axis: str, metric: str) -> pd.DataFrame:
    place = group[axis]
    if axis in found.sampled and place.nunique() > 1.5 * _BINS:
        place = place.groupby(pd.qcut(place, _BINS)).transform("median")
    sizes = group[metric].abs().groupby(place)
    low, high = (sizes.quantile(q) for q in _BAND)
    table = pd.DataFrame({"median": sizes.median(), "low": low, "high": high, "runs": sizes.size()})
    return table.rename_axis("value").reset_index()


def repeated(found: StudyResults, axis: str) -> tuple[str, ...]:
    """Name what the bands of the lines over an axis range over: repetitions and samples."""
    seeds = (SEED,) if SEED in found.axes else ()
    return (*seeds, *(other for other in found.sampled if other != axis))
