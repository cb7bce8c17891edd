"""What is stored of a study, the questions that it answers, and lines through its grid."""

import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from analytic.numerics.arrays import Floats
from compare.study.grid.plan import Plan
from compare.study.grid.study import BEAM

WORST = "disagreement_worst_rms"
SEED = "noise.seed"
METHOD = "reconstruction.method"
REFINED = ("mujoco.segments", "mujoco.contour_points", "sweep.stations", "path.stations")
"""Parameters that should make the disagreement fall."""
_FEW_POINTS = 12  # parameters that advance together in more points than these are a sample


@dataclass(frozen=True)
class StudyResults:
    plan: Plan  # what was to be done
    rows: pd.DataFrame  # A row a run of the plan, whatever its outcome
    # Those whose numbers count, with a column `WORST`: the largest of the clamp readings' rms
    # disagreements.
    done: pd.DataFrame
    axes: tuple[str, ...]  # numeric parameters that take more than one value

    @classmethod
    def of(cls, plan: Plan, rows: pd.DataFrame) -> "StudyResults":
        rows = rows[rows["run"].isin({run.id for run in plan})]
        done = rows[rows["outcome"] == "done"]
        readings = [name for name in done if re.fullmatch(r"disagreement_\w+_rms", str(name))]
        if readings:
            done = done.assign(**{WORST: done[readings].max(axis=1)})
        keys = [key for axis in plan.study.crossed for key in axis.keys]
        numeric = done.select_dtypes("number")
        axes = tuple(key for key in keys if key in numeric and len(numeric[key].unique()) > 1)
        return cls(plan, rows, done, axes)

    @property
    def plain_axes(self) -> tuple[str, ...]:
        """The axes without those whose values only repeat the run."""
        return tuple(key for key in self.axes if key != SEED)

    @property
    def sampled(self) -> tuple[str, ...]:
        groups = [a.keys for a in self.plan.study.crossed
                  if len(a.keys) > 1 and len(a.points) > _FEW_POINTS]  # fmt: skip
        return tuple(key for keys in groups for key in keys if key in self.axes)

    def by_beam(self, metric: str) -> Iterator[tuple[str, pd.DataFrame]]:
        """Split the runs by beam and method: the median of two models is that of neither."""
        done = self.done.dropna(subset=[metric])
        keys = [key for key in (BEAM, METHOD) if key in done]
        if not keys:
            yield "", done
            return
        for values, group in done.groupby(keys):
            said = dict(zip(keys, values, strict=True))
            method = f"method {said[METHOD]}" if METHOD in said else ""
            yield ", ".join(filter(None, (str(said.get(BEAM, "")), method))), group


def together(done: pd.DataFrame, one: str, other: str) -> bool:
    return int(done.groupby(one)[other].nunique().max()) == 1


@dataclass(frozen=True)
class Question:
    name: str  # what its pictures' files are called
    text: str  # as a heading
    metric: str  # A column of the runs
    number: str  # what a sentence calls the number
    label: str  # what a picture calls it
    limit: float | None = None  # A value that means something, which pictures draw
    least: float = 0.0  # pictures draw what is less at this: nobody can see the difference


_WORDS = tomllib.loads(Path(__file__).with_name("words.toml").read_text(encoding="utf-8"))
QUESTIONS = tuple(Question(**one) for one in _WORDS["question"])
AXES: dict[str, str] = _WORDS["axes"]
"""What pictures call an axis."""


def asked(found: StudyResults) -> list[Question]:
    chosen = []
    for question in QUESTIONS:
        if question.metric in found.done:
            sizes = found.done[question.metric].dropna().abs()
            # What differs by rounding alone does not depend on anything.
            if len(sizes) and sizes.max() > 0 and sizes.max() > (1 + 1e-9) * sizes.min():
                chosen.append(question)
    return chosen


_BAND = (0.1, 0.9)  # quantiles over repetitions and samples
_ROUNDING = 1e-9
_BINS = 20  # that a sampled axis is cut into
_LINES = {1: 5, 2: 3}  # lines a beam, by the number of beams; more cannot be distinguished


@dataclass(frozen=True)
class Line:
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
    held = {}
    for axis in axes:
        distinct = np.unique(group[axis])
        held[axis] = float(distinct[-1 if axis in REFINED else len(distinct) // 2])
    return held, _at(group, held)


def _varies(values: pd.Series) -> bool:
    return bool(values.min() < values.max())


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
