"""The report of a comparison in space: one offline HTML file, and the figures beside it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from analytic.problem.arrays import Floats
from analytic.problem.files import write_whole
from analytic.space import Body
from compare.align.frames import COMPONENTS
from compare.comparison_in_space import SpatialComparison
from compare.explain.split_space import Parts
from compare.show.colophon import colophon
from compare.show.figures.space import (
    both_in_space,
    contacts_in_space,
    parts_in_space,
    sweep_in_space,
)
from compare.show.page import document, embedded, inline_svg, png, render
from compare.show.report import Film
from compare.show.scene import SweepScene
from compare.show.solid import solid_ply
from compare.show.turning import turning

_BULKY = ("events", "path")
_SHOWN = {
    "space": "The body, the vibrissa at some stations, the contacts, and the readings",
    "components": "Six components of both sweeps over the way of the foot, and their differences",
    "contacts": "When both sweeps touch, in which phase, and how far their contacts are apart",
    "parts": "What the disagreement is made of, a bar a part",
}
"""What pictures show, for those who cannot see them."""


def write_spatial_report(
    comparison: SpatialComparison,
    body: Body | Floats | None,
    folder: Path,
    parts: Parts | None = None,
    film: Film | None = None,
) -> Path:
    """Write ``comparison.json``, the figures, what they show of the body, and ``report.html``."""
    candidate = comparison.candidate
    scene = SweepScene.of(candidate, body)
    drawn = {
        "space": sweep_in_space(scene),
        "components": both_in_space(comparison),
        "contacts": contacts_in_space(comparison),
    }
    if parts is not None:
        drawn["parts"] = parts_in_space(parts)
    contents: dict[str, str | bytes] = {f"{name}.png": png(one) for name, one in drawn.items()}
    if len(scene.faces):
        contents["body.ply"] = solid_ply(scene.faces * candidate.beam.length)
    contents["comparison.json"] = document(comparison.to_dict())
    if parts is not None:
        contents["budget.json"] = document(parts.to_dict())
    contents["report.html"] = render(
        "compare.show",
        "spatial.html.j2",
        found=comparison,
        components=COMPONENTS,
        length=comparison.reference.beam.length,
        parts=parts,
        recorded={
            one.source: _recorded(one.provenance) for one in (comparison.reference, candidate)
        },
        turning=turning(scene),
        pictures={name: inline_svg(one, name, _SHOWN[name]) for name, one in drawn.items()},
        film=None if film is None else {"gif": embedded(film.gif), "still": embedded(film.still)},
        colophon=colophon(),
    )
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(folder / name, content)
    return folder / "report.html"


def _recorded(provenance: Mapping[str, Any]) -> dict[str, str]:
    return {name: str(value) for name, value in provenance.items() if name not in _BULKY}
