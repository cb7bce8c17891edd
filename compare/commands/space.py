"""What there is in space alone: the body found from the clamp, and the events of a sweep."""

from pathlib import Path
from typing import TYPE_CHECKING

from compare.commands.waiting import waiting

if TYPE_CHECKING:
    from analytic.space import Body, Cloud, SpatialReadings


def find_body(
    readings: "SpatialReadings",
    body: "Body | None",
    folder: Path,
    noise: float,
    with_picture: bool,
) -> bool:
    """Write the contacts found from the clamp; whether a vibrissa can have them.

    As a table, as a point cloud with normals and, if wanted, in a picture.
    """
    from analytic.space import point_cloud, reconstruct_space, wrench_complaint, write_ply
    from compare.commands import terminal
    from compare.commands.keep import keep
    from compare.show.figures.space import sweep_in_space
    from compare.show.scene import SweepScene

    with waiting("reconstructing"):
        points = reconstruct_space(readings, _deviations(readings, noise))
    complaint = wrench_complaint(points)
    if complaint is not None:
        terminal.print_line(f"readings: {complaint}")
    cloud = point_cloud(points)
    terminal.print_line(_reconstructed(cloud, body, readings.beam.length))
    keep(folder / "points.csv", points)
    terminal.print_written(write_ply(cloud, folder / "points.ply"))
    if with_picture:
        with waiting("drawing"):
            picture = sweep_in_space(SweepScene.of(readings, body))
        keep(folder / "space.png", picture)
    diverged = "status" in readings.table and bool((readings.table["status"] == "diverged").any())
    return complaint is None and not diverged


def sweep_line(readings: "SpatialReadings") -> str:
    """What a sweep found: stations, phases, events, the worst residual."""
    table, length = readings.table, readings.beam.length
    counts = table.loc[table["status"] == "ok", "phase"].value_counts()
    parts = [f"{int(readings.trusted.sum())} of {len(table)} stations ok"]
    parts += [
        f"{count} {status}"
        for status, count in table["status"].value_counts().items()
        if status != "ok"
    ]
    parts.append(", ".join(f"{count} {phase}" for phase, count in counts.items()))
    for event in readings.provenance["events"]:
        x, _, z = (value / length for value in event["foot"])
        if event["kind"] in ("touch", "release", "slip-off"):
            parts.append(f"{event['kind']} at foot ({x:.4f}, {z:.4f}) L")
    hops = sum(event["kind"] == "hop" for event in readings.provenance["events"])
    if hops:
        parts.append(f"{hops} hops over edges")
    worst = table["residual"].max()
    parts.append(f"residual at most {worst:.1e}")
    return f"{readings.source}: {'; '.join(parts)}"


def _reconstructed(cloud: "Cloud", body: "Body | None", length: float) -> str:
    from numpy import degrees, sqrt

    from analytic.space import misses

    if body is None:
        return f"{len(cloud.points)} contacts"
    found = misses(cloud, body, length)
    distances = found.distances / length
    return (
        f"{len(distances)} contacts; from the true body {sqrt((distances**2).mean()):.1e} L rms, "
        f"{distances.max():.1e} L at most; normals {degrees(found.angles.max()):.1e} degrees"
    )


def _deviations(readings: "SpatialReadings", share: float) -> dict[str, float] | None:
    import numpy as np

    from analytic.space.problem.readings import FORCE, MOMENT

    if share == 0:
        return None
    return {
        name: share * float(np.nanmax(np.abs(readings.values(name)))) for name in (*FORCE, *MOMENT)
    }
