"""The report of a comparison: one offline HTML file, and the figures beside it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from analytic.problem.arrays import Floats
from analytic.problem.files import write_whole
from analytic.space import Body
from compare.comparison import Comparison, SpatialComparison
from compare.explain.budget import Budget
from compare.explain.split_space import Parts
from compare.show.document import Film
from compare.show.figures.budget_bars import picture
from compare.show.figures.readings import readings
from compare.show.html import html
from compare.show.page import as_json, png
from compare.show.plane_page import plane_document
from compare.show.scene import SweepScene, solid_ply
from compare.show.spatial_page import spatial_document


def write_report(
    comparison: Comparison | SpatialComparison,
    folder: Path,
    budget: Budget | None = None,
    film: Film | None = None,
    parts: Parts | None = None,
    body: Body | Floats | None = None,
) -> Path:
    """Write ``comparison.json``, ``report.html`` and the figures of a comparison into `folder`.

    All is drawn before the first file is written, each appears whole, ``report.html`` last. The
    body, and the parts of a disagreement beside it, are of sweeps in space.
    """
    contents: dict[str, str | bytes] = {}
    if isinstance(comparison, SpatialComparison):
        scene = SweepScene.of(comparison.candidate, body)
        if len(scene.faces):
            contents["body.ply"] = solid_ply(scene.faces * comparison.candidate.beam.length)
        if parts is not None:
            contents["budget.json"] = as_json(parts.to_dict())
        document = spatial_document(comparison, scene, parts, film)
    else:
        contents["readings.png"] = png(readings(comparison))
        if comparison.validation is not None:
            contents["validation.csv"] = comparison.validation.table.to_csv(index=False)
        if budget is not None:
            contents |= budget_files(budget)
        document = plane_document(comparison, budget, film)
    for drawn in document.pictures():
        if len(drawn.figures) == 1:
            contents |= {f"{drawn.name}.png": png(one) for one in drawn.figures.values()}
    contents["comparison.json"] = as_json(comparison.to_dict())
    contents["report.html"] = html(document)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(folder / name, content)
    return folder / "report.html"


def budget_files(found: Budget, advice: Mapping[str, Any] | None = None) -> dict[str, str | bytes]:
    """What is written of a budget."""
    content = found.to_dict() if advice is None else {**found.to_dict(), "advice": advice}
    return {"budget.json": as_json(content), "budget.png": png(picture(found), 100)}
