"""The report of a comparison: one offline HTML file, and the figures beside it."""

from collections.abc import Iterator
from pathlib import Path

from analytic.numerics.arrays import Floats
from analytic.space import Body
from compare.comparison import Comparison, SpatialComparison
from compare.explain.budget import Budget
from compare.explain.parts import Parted
from compare.show.budgets import picture
from compare.show.comparison_page import apart_table
from compare.show.document import Block, Film, Text, tiles_line
from compare.show.figures.readings import readings
from compare.show.page import Content, png, write_all
from compare.show.plane_page import plane_document, plane_tiles, plane_verdict
from compare.show.scene import SweepScene, solid_ply
from compare.show.spatial_page import spatial_document, spatial_tiles, spatial_verdict
from compare.show.verdict import validation_lines


def write_report(
    comparison: Comparison | SpatialComparison,
    folder: Path,
    budget: Parted | None = None,
    film: Film | None = None,
    body: Body | Floats | None = None,
) -> Path:
    """Write ``comparison.json``, ``report.html`` and the figures of a comparison into `folder`.

    All is drawn before the first file is written, each appears whole, ``report.html`` last. The
    body is of sweeps in space.
    """
    contents: dict[str, Content] = {}
    if budget is not None:
        contents = {"budget.json": budget.to_dict(), "budget.png": png(picture(budget), 100)}
    if isinstance(comparison, SpatialComparison):
        scene = SweepScene.of(comparison.candidate, body)
        if len(scene.faces):
            contents["body.ply"] = solid_ply(scene.faces * comparison.candidate.beam.length)
        document = spatial_document(comparison, scene, budget, film)
    else:
        contents["readings.png"] = readings(comparison)
        if comparison.validation is not None:
            contents["validation.csv"] = comparison.validation.table
        planar = budget if isinstance(budget, Budget) else None
        document = plane_document(comparison, planar, film)
    for drawn in document.pictures():
        if len(drawn.figures) == 1:
            contents |= {f"{drawn.name}.png": one for one in drawn.figures.values()}
    contents |= {"comparison.json": comparison.to_dict(), "report.html": document}
    return write_all(folder, contents)[-1]


def summary_of(found: Comparison | SpatialComparison) -> Iterator[Block]:
    """The verdict and what it rests on, in short."""
    if isinstance(found, Comparison):
        yield plane_verdict(found)
        yield from map(Text, validation_lines(found))
        yield tiles_line(plane_tiles(found))
    else:
        yield spatial_verdict(found)
        yield tiles_line(spatial_tiles(found))
    yield from apart_table(found)
