"""What the commands do in space: ``run``, ``compare`` and ``reconstruct``."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from compare.commands.options import AGREES, DISAGREES
from compare.commands.output import distinct_name, output_folder
from compare.commands.waiting import waiting

if TYPE_CHECKING:
    from analytic.problem.arrays import Floats
    from analytic.space import Body, Cloud, SpatialReadings
    from compare.align.frames import Frame
    from compare.commands.asked import Asked
    from compare.comparison_in_space import SpatialComparison
    from compare.explain.split_space import Parts
    from compare.read.job import SpaceJob
    from compare.show.document import Film
    from mujoco_models import SpatialSettings


def run_in_space(job: "SpaceJob", folder: Path, asked: "Asked") -> int:
    """Sweep past a body, compare, and find the body from the clamp.

    Writes the readings, the contacts found as a table and as a point cloud with normals, and a
    picture; with MuJoCo also the comparison and a report.
    """
    agrees = True
    if asked.sweep_only:
        swept = _mujoco(job, folder)
    else:
        swept = _exact(job, folder, asked)
        if job.engines:
            comparison = _compared(job, swept, folder, asked)
            swept, agrees = comparison.candidate, comparison.agrees
    drawn = bool(job.engines) and not asked.sweep_only  # by the report
    explained = _points(swept, job.case.body, folder, 0.0, not drawn)
    diverged = bool((swept.table["status"] == "diverged").any())
    return AGREES if agrees and explained and not diverged else DISAGREES


def reconstruct_in_space(
    file: Path,
    known: "SpaceJob | None",
    folder: Path,
    noise: float,
    columns: list[str],
    frame: "Frame",
) -> int:
    """Find the body from a file of readings; the case has the vibrissa, if the file has not."""
    from compare.read.space_readings import read_space

    if known is None:
        readings = read_space(file, columns=columns, frame=frame)
    else:
        case = known.case
        readings = read_space(file, case.beam, case.path.tangent, columns, frame)
    with output_folder(folder):
        body = None if known is None else known.case.body
        explained = _points(readings, body, folder, noise, True)
    diverged = "status" in readings.table and (readings.table["status"] == "diverged").any()
    return AGREES if explained and not diverged else DISAGREES


def _exact(job: "SpaceJob", folder: Path, asked: "Asked") -> "SpatialReadings":
    from analytic.space import solve_space
    from compare.commands import terminal

    with waiting("solving"):
        exact = solve_space(job.case, asked.certified)
    terminal.print_line(_solved(exact))
    terminal.print_written(exact.write(folder / "analytic.parquet"))
    return exact


def _mujoco(job: "SpaceJob", folder: Path) -> "SpatialReadings":
    from compare.commands import terminal

    candidate = _simulated(job, job.settings, folder)
    terminal.print_line(_solved(candidate))
    terminal.print_written(candidate.write(folder / f"mujoco-{job.settings.beam}.parquet"))
    return candidate


def _simulated(job: "SpaceJob", settings: "SpatialSettings", folder: Path) -> "SpatialReadings":
    """MuJoCo's sweep; if it ends early, the stations that there are go into `folder`."""
    from compare.commands import terminal
    from compare.simulate.dispatch import simulate

    def keep(part: "SpatialReadings") -> None:
        terminal.print_written(part.write(folder / f"mujoco-{job.settings.beam}.parquet"))

    with terminal.progress("stations", job.case.path.stations) as advance:
        return simulate(job.case, settings, advance=advance, keep=keep)


def _compared(
    job: "SpaceJob", exact: "SpatialReadings", folder: Path, asked: "Asked"
) -> "SpatialComparison":
    """MuJoCo's sweep, the comparison, its parts and a film if asked for, and the report."""
    from compare.comparison_in_space import compare_space
    from compare.explain.split_space import split_space
    from compare.show.animation.space import write_space_animation

    candidate = _mujoco(job, folder)
    comparison = compare_space(exact, candidate, job.tolerances, frame=asked.frame)
    parts = None
    if asked.budget:
        parts = split_space(
            exact, candidate, job.settings, lambda chosen: _simulated(job, chosen, folder)
        )

    def draw(place: Path, frames: int, advance: Callable[[], None]) -> object:
        return write_space_animation(exact, candidate, place, job.case.body, frames, advance)

    film = asked.film(draw, folder)
    write_report(comparison, job.case.body, folder, parts, film)
    return comparison


def _points(
    readings: "SpatialReadings",
    body: "Body | None",
    folder: Path,
    noise: float,
    with_picture: bool,
) -> bool:
    """Write the contacts found from the clamp; whether a vibrissa can have such readings."""
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
    return complaint is None


def compare_in_space(
    reference: "SpaceJob | Path",
    candidate: Path,
    out: Path | None,
    column: list[str] | None,
    frame: Literal["world", "clamp"],
    tolerances: Path | None,
    noise: float | Literal["auto"],
) -> int:
    """Compare a file of readings in space with another or with a case's closed form."""
    from compare.commands import terminal
    from compare.judge.spatial import SpatialTolerances
    from compare.read.limits import read_tolerances
    from compare.read.space_readings import read_space

    limits = None if tolerances is None else read_tolerances(tolerances, SpatialTolerances)
    with waiting("comparing"):
        from analytic.space import (
            SpatialReadings,
            reconstruct_space,
            solve_space,
            wrench_complaint,
        )
        from compare.comparison_in_space import compare_space
        from compare.show.document import Film

        body = None
        if isinstance(reference, Path):
            exact, called = SpatialReadings.read(reference), distinct_name(reference)
        else:
            body, limits = reference.case.body, limits or reference.tolerances
            exact, called = solve_space(reference.case), reference.case.name
        measured = read_space(candidate, exact.beam, exact.tangent, column or (), frame)
        comparison = compare_space(exact, measured, limits, noise=noise, frame=frame)
    default = Path("results") / f"{called}-{distinct_name(candidate)}"
    with output_folder(out or default) as folder:
        film = Film.of(folder) if candidate.parent.resolve() == folder.resolve() else None
        write_report(comparison, body, folder, film=film)
        complaint = wrench_complaint(reconstruct_space(measured))
    if complaint is not None:
        terminal.print_line(f"{measured.source}: {complaint}")
    return AGREES if comparison.agrees else DISAGREES


def write_report(
    comparison: "SpatialComparison",
    body: "Body | Floats | None",
    folder: Path,
    parts: "Parts | None" = None,
    film: "Film | None" = None,
) -> None:
    """Write the report and print the verdict."""
    from compare.commands import terminal
    from compare.show.report import write_spatial_report

    with waiting("drawing"):
        written = write_spatial_report(comparison, body, folder, parts, film)
    terminal.print_spatial_comparison(comparison, parts)
    terminal.print_written(written)


def _solved(readings: "SpatialReadings") -> str:
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
