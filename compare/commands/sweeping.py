"""The sweeps of a job: solved, simulated, written, printed; in space the body found from them."""

from pathlib import Path
from typing import TypeAlias

import numpy as np

from analytic import InputError, Readings
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
from compare.commands.output import waiting, warn
from compare.commands.sweep_lines import print_sweep
from compare.read.job import AnyJob
from compare.show.scene import SweepScene

AnyReadings: TypeAlias = Readings | SpatialReadings


def solved(job: AnyJob, folder: Path, certified: bool) -> AnyReadings:
    with waiting("solving"):
        exact: AnyReadings = job.solve(certified)
        exact.write(folder / "analytic.parquet")
    return exact


def sweep_file(job: AnyJob) -> str:
    if job.model is not None:
        return "mujoco-own-model.parquet"
    return f"mujoco-{job.settings.beam}{'-in-motion' if job.motion else ''}.parquet"


def simulated(job: AnyJob, folder: Path) -> AnyReadings:
    """The sweep in MuJoCo, written; if it ends early, the stations that there are."""
    from compare.simulate.dispatch import simulate

    file = folder / sweep_file(job)

    def keep_part(part: AnyReadings) -> None:
        path = part.write(file.with_suffix(".partial.parquet"))
        warn(f"kept {len(part.table)} of {job.stations} stations in {path}")

    what = job.settings.beam if job.model is None else job.model.file.name
    with terminal.progress(f"MuJoCo {what}", job.stations) as advance:
        swept = simulate(
            job.case, job.settings, job.motion, job.model, advance=advance, keep=keep_part
        )
    swept.write(file)
    return swept


def printed(job: AnyJob, readings: AnyReadings, folder: Path, name: str | None = None) -> bool:
    """Print what a sweep found, and in space find the body from it; whether that could be."""
    print_sweep(readings)
    if name is not None:
        terminal.print_written(folder / name)
    return isinstance(readings, Readings) or find_body(
        readings, job.body, folder, 0.0, name is not None
    )


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
        points = reconstruct_space(readings, deviations([readings], noise))
    complaint = wrench_complaint(points)
    if complaint is not None:
        if points["contact_x"].isna().all():
            raise InputError("readings", "without a contact", "of such a vibrissa", complaint)
        terminal.print_line(f"readings: {complaint}")
    cloud = point_cloud(points)
    terminal.print_line(_reconstructed(cloud, body, readings.beam.length))
    if friction := readings.provenance.get("friction", 0.0):
        leant = np.degrees(np.arctan(friction))
        terminal.print_line(f"friction tilts the normals found by up to {leant:.3g} degrees")
    terminal.keep(folder / "points.csv", points)
    terminal.print_written(write_ply(cloud, folder / "points.ply"))
    if with_picture:
        with waiting("drawing"):
            from compare.show.figures.space import sweep_in_space

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


def deviations(sweeps: list[SpatialReadings], share: float) -> dict[str, float] | None:
    """A share of each component's largest magnitude in any sweep."""
    if share == 0:
        return None
    return {
        name: share * max(float(np.nanmax(np.abs(one.values(name)))) for one in sweeps)
        for name in (*FORCE, *MOMENT)
    }
