"""What is stored of a study, as its report looks at it, and the questions that it answers."""

import re
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

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
    """Say whether two axes are zipped."""
    return int(done.groupby(one)[other].nunique().max()) == 1


@dataclass(frozen=True)
class Question:
    """A question and the number that answers it."""

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
    """Choose the questions that a study has an answer to."""
    chosen = []
    for question in QUESTIONS:
        if question.metric in found.done:
            sizes = found.done[question.metric].dropna().abs()
            # What differs by rounding alone does not depend on anything.
            if len(sizes) and sizes.max() > 0 and sizes.max() > (1 + 1e-9) * sizes.min():
                chosen.append(question)
    return chosen
