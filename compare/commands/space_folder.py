"""``report`` of a sweep in space: made anew from what `vibrissa run` has left in a folder."""

from pathlib import Path
from typing import TYPE_CHECKING

from compare.commands.options import AGREES, DISAGREES
from compare.commands.output import output_folder
from compare.commands.waiting import waiting

if TYPE_CHECKING:
    from analytic.problem.arrays import Floats
    from compare.align.frames import Frame
    from compare.explain.split_space import Parts


def report_in_space(folder: Path, reference: Path, candidate: Path, place: Path) -> int:
    """Write the report of both sweeps again, and print the verdict."""
    with waiting("comparing"):
        from analytic.space import SpatialReadings
        from compare.commands.space import write_report
        from compare.comparison_in_space import compare_space
        from compare.judge.spatial import SpatialTolerances
        from compare.read.run_folder import read_limits
        from compare.show.report import Film

        judged = folder / "comparison.json"
        comparison = compare_space(
            SpatialReadings.read(reference),
            SpatialReadings.read(candidate),
            read_limits(judged, SpatialTolerances),
            frame=_frame(judged),
        )
        parts, body = _parts(folder / "budget.json"), _body(folder / "body.ply")
    with output_folder(place):
        write_report(comparison, body, place, parts, Film.of(folder))
    return AGREES if comparison.agrees else DISAGREES


def _frame(file: Path) -> "Frame":
    """That the components were compared in."""
    from compare.read.run_folder import damaged, read_json

    if not file.exists():
        return "world"
    content = read_json(file)
    found = content.get("frame") if isinstance(content, dict) else None
    if found not in ("world", "clamp"):
        raise damaged(file, ValueError("frame is neither world nor clamp"))
    return "clamp" if found == "clamp" else "world"


def _parts(file: Path) -> "Parts | None":
    from pydantic import TypeAdapter

    from compare.explain.split_space import Parts
    from compare.read.run_folder import damaged, read_json

    if not file.exists():
        return None
    try:
        return TypeAdapter(Parts).validate_python(read_json(file))
    except ValueError as error:
        raise damaged(file, error) from error


def _body(file: Path) -> "Floats | None":
    """What the run's pictures showed of the body, shape (triangles, 3, 3)."""
    import numpy as np

    from compare.read.run_folder import damaged

    if not file.exists():
        return None
    from trimesh import load_mesh

    try:
        found = load_mesh(file, process=False)
        faces = np.asarray(found.vertices, dtype=float)[found.faces]
    except Exception as error:  # a parser of foreign bytes may raise anything
        raise damaged(file, error) from error
    if faces.shape[1:] != (3, 3) or not np.isfinite(faces).all():
        raise damaged(file, ValueError("no triangles"))
    return faces
