"""What there is in space alone: the body found from the clamp."""

from pathlib import Path

import numpy as np

from analytic.space import (
    Body,
    Cloud,
    SpatialReadings,
    misses,
    point_cloud,
    reconstruct_space,
    wrench_complaint,
    write_ply,
)
from analytic.space.problem.readings import FORCE, MOMENT
from compare.commands import terminal
from compare.commands.output import waiting
from compare.show.figures.space import sweep_in_space
from compare.show.scene import SweepScene


def find_body(
    readings: SpatialReadings,
    body: Body | None,
    folder: Path,
    noise: float,
    with_picture: bool,
) -> bool:
    """Write the contacts found from the clamp; whether a vibrissa can have them.

    As a table, as a point cloud with normals and, if wanted, in a picture.
    """
    with waiting("reconstructing"):
        points = reconstruct_space(readings, _deviations(readings, noise))
    complaint = wrench_complaint(points)
    if complaint is not None:
        terminal.print_line(f"readings: {complaint}")
    cloud = point_cloud(points)
    terminal.print_line(_reconstructed(cloud, body, readings.beam.length))
    terminal.keep(folder / "points.csv", points)
    terminal.print_written(write_ply(cloud, folder / "points.ply"))
    if with_picture:
        with waiting("drawing"):
            picture = sweep_in_space(SweepScene.of(readings, body))
        terminal.keep(folder / "space.png", picture)
    diverged = "status" in readings.table and bool((readings.table["status"] == "diverged").any())
    return complaint is None and not diverged


def _reconstructed(cloud: Cloud, body: Body | None, length: float) -> str:

    if body is None:
        return f"{len(cloud.points)} contacts"
    found = misses(cloud, body, length)
    distances = found.distances / length
    rms = np.sqrt((distances**2).mean())
    return (
        f"{len(distances)} contacts; from the true body {rms:.1e} L rms, "
        f"{distances.max():.1e} L at most; normals {np.degrees(found.angles.max()):.1e} degrees"
    )


def _deviations(readings: SpatialReadings, share: float) -> dict[str, float] | None:

    if share == 0:
        return None
    return {
        name: share * float(np.nanmax(np.abs(readings.values(name)))) for name in (*FORCE, *MOMENT)
    }
