"""The report of a study: tables, figures and one offline page, from what is stored alone."""

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pandas as pd

from analytic import InputError
from compare.show.document import (
    Block,
    Document,
    Layout,
    Picture,
    Table,
    Text,
    Tile,
    Verdict,
    sections,
)
from compare.show.page import Content, write_all
from compare.study.keep.database import Warn
from compare.study.keep.store import read_plan, read_rows
from compare.study.show import pictures
from compare.study.show.results import Question, StudyResults, asked, curves, repeated
from compare.study.show.sentences import headline, orders, outcomes, vanishing, varied

_LONGEST_TABLE = 24  # rows on the page; all of them are in a file
_ELSEWHERE = "All lines are in report/curves.csv, all runs in the study's folder."
_TABLES = {"orders": "Observed orders", "phase-b-vanishes": "Where Phase B vanishes"}


def write_report(folder: Path, warn: Warn, place: Path | None = None) -> Path:
    """Write ``report.html``, ``report/*.png`` and ``report/*.csv`` of a study, by default there."""
    damage: list[str] = []
    rows = read_rows(folder, damage.append)
    found = StudyResults.of(read_plan(folder), rows)
    if found.done.empty:
        reasons = found.rows["reason"].tolist() if "reason" in found.rows else []
        reason = next(filter(None, [*reasons, *damage]), "start `vibrissa study` first")
        raise InputError("DIR", folder, "a study with a run that is done", str(reason))
    for line in damage:
        warn(line)
    numbers = {
        "outcomes": outcomes(found),
        "orders": orders(found),
        "phase-b-vanishes": vanishing(found),
        "curves": curves(found, [question.metric for question in asked(found)]),
    }
    document = _document(found, numbers)
    contents: dict[str, Content] = {
        f"report/{shows.replace(' ', '-')}.png": figure
        for picture in document.pictures()
        for shows, figure in picture.figures.items()
    }
    contents |= {f"report/{name}.csv": one for name, one in numbers.items() if not one.empty}
    return write_all(place or folder, {**contents, "report.html": document})[-1]


def _document(found: StudyResults, numbers: dict[str, pd.DataFrame]) -> Document:
    study, questions = found.plan.study, asked(found)
    answers = {question.name: headline(found, question) for question in questions}
    done, planned = len(found.done), len(found.plan)
    against = ", closed form alone"
    if study.beams:
        against = f", MuJoCo's {' and '.join(study.beams)} against the closed form"
    counted = list(numbers["outcomes"].itertuples(index=False, name=None))
    first = (
        answers[questions[0].name] if questions else "What was recorded does not vary over them."
    )
    lost = [(what, str(n), str(why)) for what, n, why in counted if what != "done"]
    head = ("outcome", "runs", "example")
    why = [Table("One example each", head, lost, words=(0, 2))] if lost else []
    made = [*found.plan.versions.items()]
    versions = Table("Of the programs that made the runs", (), made, words=(0, 1))
    return Document(
        f"Study {study.name}: {study.case}{against}",
        f"Varied: {varied(found)}.",
        Verdict(
            done == planned,
            f"{'All' if done == planned else f'{done} of'} {planned} runs are done.",
            first,
        ),
        sections(
            ("not-done", "Why runs are not done", why),
            *((one.name, one.text, _answer(found, one, answers[one.name])) for one in questions),
            ("time", "What does accuracy cost?", _cost(found)),
            *((name, title, _table(name, numbers[name])) for name, title in _TABLES.items()),
            ("versions", "Versions", [versions, Text(_ELSEWHERE, aside=True)]),
        ),
        [Tile(what, str(n), "run" if n == 1 else "runs") for what, n, _ in counted],
    )


def _answer(found: StudyResults, question: Question, answer: str) -> Iterator[Block]:
    yield Text(answer)
    drawn = pictures.axis_pictures(found, question) | pictures.maps(found, question)
    figures = {f"{question.name} {name}": draw for name, draw in drawn.items()}
    if figures:
        layout: Layout = "panels" if len(figures) > 1 else "middle"
        yield Picture(f"p-{question.name}", figures, _caption(found, question), layout)


def _cost(found: StudyResults) -> Iterator[Picture]:
    runs = pictures.timed(found)
    if len(runs) > 1:
        figure = {"error against time": partial(pictures.error_against_time, found, runs)}
        said = "Each dot is a run. No run beats the line in both time and error."
        yield Picture("p-time", figure, said, "middle")


def _caption(found: StudyResults, question: Question) -> str:
    said = (
        "A line is one beam with every other parameter held at what the legend or the title says."
    )
    bands = sorted({axis for one in found.plain_axes for axis in repeated(found, one)})
    if bands:
        said += f" Lines are medians and bands hold 80 % over {', '.join(bands)}."
    if question.limit is not None:
        said += f" Dashed, or orange in a map: {question.limit}."
    return said


def _table(name: str, table: pd.DataFrame) -> Iterator[Table]:
    if table.empty:
        return
    shown = table.head(_LONGEST_TABLE)
    rest = f"The first {len(shown)} of {len(table)} rows; all" if len(table) > len(shown) else "All"
    rows = [[_cell(value) for value in row] for row in shown.itertuples(index=False, name=None)]
    yield Table(f"{rest} are in report/{name}.csv", [str(column) for column in table], rows)


def _cell(value: object) -> str:
    if isinstance(value, float):
        return "" if value != value else f"{value:.4g}"
    return str(value)
