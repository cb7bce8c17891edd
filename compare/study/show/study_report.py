"""The report of a study: tables, figures and one offline page, from what is stored alone."""

from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

from analytic import InputError
from analytic.problem.files import write_whole
from compare.show.page import inline_svg, png, render
from compare.study.keep.reading import read_plan, read_rows
from compare.study.keep.store import Tell
from compare.study.show import pictures, tables
from compare.study.show.tables import StudyResults


def write_report(folder: Path, tell: Tell) -> Path:
    """Write ``report.html``, ``report/*.png`` and ``report/*.csv`` into the folder of a study.

    Returns
    -------
    Path
        Of ``report.html``.

    Raises
    ------
    InputError
        If there is no study in `folder`, or none of its runs is done.
    """
    rows = read_rows(folder, tell)
    plan = read_plan(folder)
    found = StudyResults.of(plan, rows)
    if found.done.empty:
        raise InputError(
            "DIR", folder, "a study with a run that is done", "see the reasons in DIR/runs"
        )
    drawn = {
        name: figure
        for draw in (pictures.axis_curves, pictures.heat_maps, pictures.error_against_time)
        for name, figure in draw(found)
    }
    metrics = [column for columns in pictures.panels(found).values() for column in columns]
    numbers = {
        "outcomes": tables.outcomes(found),
        "orders": tables.orders(found),
        "phase-b-vanishes": tables.vanishing(found),
        "curves": tables.curves(found, metrics),
    }
    (folder / "report").mkdir(exist_ok=True)
    for name, figure in drawn.items():
        write_whole(folder / "report" / f"{name}.png", png(figure))
    for name, table in numbers.items():
        if not table.empty:
            write_whole(folder / "report" / f"{name}.csv", table.to_csv(index=False).encode())
    write_whole(folder / "report.html", _page(found, numbers, drawn).encode())
    return folder / "report.html"


def _page(found: StudyResults, numbers: dict[str, pd.DataFrame], drawn: dict[str, Figure]) -> str:
    titles = {
        "outcomes": "What became of the runs",
        "orders": "Observed orders",
        "phase-b-vanishes": "Where Phase B vanishes",
    }
    return render(
        "compare.study.show",
        "study.html.j2",
        study=found.plan.study,
        versions=found.plan.versions,
        done=len(found.done),
        planned=len(found.plan),
        tables={titles[name]: numbers[name] for name in titles if not numbers[name].empty},
        figures={name: inline_svg(figure, name, name) for name, figure in drawn.items()},
    )
