"""The report of a comparison: one offline HTML file, and the figures beside it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from analytic.problem.files import write_whole
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.show.comparison_page import comparison_document
from compare.show.document import Film as Film
from compare.show.figures.budget_bars import panels, picture
from compare.show.figures.geometry import geometry
from compare.show.figures.order_plot import convergence_picture
from compare.show.figures.phases import phase_criterion
from compare.show.figures.readings import at_snap_off, reading_panels, readings
from compare.show.figures.validation import validation_picture
from compare.show.html import html
from compare.show.page import document as as_json
from compare.show.page import png

FIGURES = {"geometry": geometry, "readings": readings, "phases": phase_criterion}
"""Pictures that are also written as files of their own."""


def write_report(
    comparison: Comparison,
    folder: Path,
    budget: Budget | None = None,
    film: Film | None = None,
) -> Path:
    """Write ``comparison.json``, the figures and ``report.html`` into `folder`.

    Everything is drawn before the first file is written, each file appears whole, and
    ``report.html`` last.
    """
    drawn = {name: draw(comparison) for name, draw in FIGURES.items()}
    contents: dict[str, str | bytes] = {
        f"{name}.png": png(figure) for name, figure in drawn.items()
    }
    contents["comparison.json"] = as_json(comparison.to_dict())
    if comparison.validation is not None:
        drawn["validation"] = validation_picture(comparison, comparison.validation)
        contents["validation.png"] = png(drawn["validation"])
        contents["validation.csv"] = comparison.validation.table.to_csv(index=False)
    if budget is not None:
        contents |= budget_files(budget)
    pictures = page_pictures(comparison, drawn, budget)
    contents["report.html"] = html(comparison_document(comparison, pictures, budget, film))
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(folder / name, content)
    return folder / "report.html"


def budget_files(found: Budget, advice: Mapping[str, Any] | None = None) -> dict[str, str | bytes]:
    """What is written of a budget."""
    content = found.to_dict() if advice is None else {**found.to_dict(), "advice": advice}
    return {"budget.json": as_json(content), "budget.png": png(picture(found), 100)}


def page_pictures(
    comparison: Comparison, drawn: Mapping[str, Figure], budget: Budget | None
) -> dict[str, dict[str, Figure]]:
    """The page's figures by their section, and by what they show."""
    titles = "{} of both models over the foot position, and their difference"
    pictures = {
        "geometry": {
            "The object and the vibrissa at stations of both sweeps": drawn["geometry"],
        },
        "readings": {
            titles.format(name): figure for name, figure in reading_panels(comparison).items()
        },
        "phases": {
            "Phase B's criterion and the contact's arc length over the foot position": drawn[
                "phases"
            ],
        },
        "snap-off": {
            f"{name} of both models around the snap-off, and their difference": figure
            for name, figure in at_snap_off(comparison).items()
        },
    }
    if "validation" in drawn:
        shows = "E = S - D and twice its standard uncertainty over the foot position"
        pictures["validation"] = {shows: drawn["validation"]}
    if budget is not None:
        bars = "Bars: the parts of {}'s disagreement; the table below has the numbers"
        pictures["budget"] = {bars.format(name): figure for name, figure in panels(budget).items()}
        if budget.convergence:
            shows = "Disagreement against the number of segments, both logarithmic"
            pictures["convergence"] = {shows: convergence_picture(budget.convergence)}
    return pictures
