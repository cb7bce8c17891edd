"""The report of a comparison in space: one offline HTML file, and the figures beside it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from analytic.problem.files import write_whole
from analytic.space import Body, reconstruct_space
from compare.show.colophon import colophon
from compare.show.figures.space import both_in_space, sweep_in_space
from compare.show.page import document, inline_svg, png, render
from compare.spatial.comparison import COMPONENTS, SpatialComparison
from compare.spatial.parts import Parts

_BULKY = ("events", "path")


def write_spatial_report(
    comparison: SpatialComparison, body: Body, folder: Path, parts: Parts | None = None
) -> Path:
    """Write ``comparison.json``, the figures and ``report.html`` into `folder`.

    Parameters
    ----------
    comparison : SpatialComparison
        What is reported.
    body : Body
        In the unit of length of the readings.
    folder : Path
        Made if it is not there.
    parts : Parts, optional
        Of the disagreement; then ``budget.json`` is written, too.

    Returns
    -------
    Path
        Of ``report.html``.
    """
    candidate = comparison.candidate
    scene = sweep_in_space(candidate, reconstruct_space(candidate), body)
    curves = both_in_space(comparison)
    contents: dict[str, str | bytes] = {
        "components.png": png(curves),
        "comparison.json": document(comparison.to_dict()),
    }
    if parts is not None:
        contents["budget.json"] = document(parts.to_dict())
    contents["report.html"] = render(
        "compare.show",
        "spatial.html.j2",
        found=comparison,
        components=COMPONENTS,
        length=comparison.reference.beam.length,
        parts=parts,
        events=comparison.events,
        recorded={
            one.source: _recorded(one.provenance) for one in (comparison.reference, candidate)
        },
        scene=inline_svg(scene, "scene", "The body, the vibrissa at some stations, the contacts"),
        curves=inline_svg(curves, "curves", "Six components of both models over the way"),
        colophon=colophon(),
    )
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(folder / name, content)
    return folder / "report.html"


def _recorded(provenance: Mapping[str, Any]) -> dict[str, str]:
    return {name: str(value) for name, value in provenance.items() if name not in _BULKY}
