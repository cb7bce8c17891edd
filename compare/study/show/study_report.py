"""The report of a study: tables, figures and one offline page, from what is stored alone."""

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from analytic import InputError
from analytic.problem.files import write_whole
from compare.show.page import inline_svg, png, render
from compare.study.keep.database import Warn
from compare.study.keep.reading import read_plan, read_rows
from compare.study.show import pictures, tables
from compare.study.show.questions import asked
from compare.study.show.results import StudyResults
from compare.study.show.sentences import headline, varied
from compare.study.show.slices import curves, repeated

_LONGEST_TABLE = 24  # rows on the page; all of them are in a file


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
        "outcomes": tables.outcomes(found),
        "orders": tables.orders(found),
        "phase-b-vanishes": tables.vanishing(found),
        "curves": curves(found, [question.metric for question in asked(found)]),
    }
    drawn = _drawn(found)
    place = place or folder
    (place / "report").mkdir(exist_ok=True)
    for section in drawn.values():
        for name, figure in section.items():
            write_whole(place / "report" / f"{name}.png", png(figure))
    for name, table in numbers.items():
        if not table.empty:
            write_whole(place / "report" / f"{name}.csv", table.to_csv(index=False).encode())
    write_whole(place / "report.html", _page(found, numbers, drawn).encode())
    return place / "report.html"


def _drawn(found: StudyResults) -> dict[str, dict[str, Figure]]:
    """The pictures of every question, by the names of their files."""
    drawn = {}
    for question in asked(found):
        over_axes = pictures.axis_pictures(found, question)
        over_pairs = pictures.maps(found, question)
        drawn[question.name] = {
            **{f"{question.name}-{axis}": figure for axis, figure in over_axes.items()},
            **{f"{question.name}-map-{pair}": figure for pair, figure in over_pairs.items()},
        }
    against_time = pictures.error_against_time(found)
    if against_time is not None:
        drawn["time"] = {"error-against-time": against_time}
    return drawn


def _page(
    found: StudyResults, numbers: dict[str, pd.DataFrame], drawn: dict[str, dict[str, Figure]]
) -> str:
    questions = asked(found)
    answers = {question.name: headline(found, question) for question in questions}
    titles = {"orders": "Observed orders", "phase-b-vanishes": "Where Phase B vanishes"}
    bands = sorted({axis for one in found.plain_axes for axis in repeated(found, one)})
    return render(
        "compare.study.show",
        "study.html.j2",
        study=found.plan.study,
        versions=found.plan.versions,
        varied=varied(found),
        answers=answers,
        questions=questions,
        outcomes=list(numbers["outcomes"].itertuples(index=False, name=None)),
        bands=bands,
        done=len(found.done),
        planned=len(found.plan),
        tables={titles[name]: (name, numbers[name].head(_LONGEST_TABLE), len(numbers[name]))
                for name in titles if not numbers[name].empty},
        figures={
            section: {name: inline_svg(figure, f"p{number}-{place}", name.replace("-", " "))
                      for place, (name, figure) in enumerate(figures.items())}
            for number, (section, figures) in enumerate(drawn.items())
        },
    )  # fmt: skip
