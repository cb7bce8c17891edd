"""The command ``space``: a sweep past a body in space, and the body from its clamp."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from compare.commands.options import (
    AGREES,
    DISAGREES,
    Columns,
    InFrame,
    Segments,
    out_folder,
)
from compare.commands.output import distinct_name, output_folder
from compare.commands.waiting import waiting

if TYPE_CHECKING:
    from analytic.problem.arrays import Floats
    from analytic.space import Body, Cloud, SpatialCase, SpatialReadings
    from compare.align.frames import Frame
    from compare.comparison_in_space import SpatialComparison
    from compare.explain.split_space import Parts
    from compare.read.space import SpaceJob
    from compare.show.report import Film
    from mujoco_models import SpatialSettings

_FRAMES = 48  # of the animation, as in the plane


def space(
    case: Annotated[
        str, typer.Argument(metavar="CASE", help="A TOML file with [body] and [path].")
    ],
    out: Annotated[Path | None, out_folder("results/CASE")] = None,
    readings: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Take these readings in place of the closed form's: nine columns, foot_x to "
            "moment_z.",
            show_default=False,
        ),
    ] = None,
    noise: Annotated[
        float,
        typer.Option(min=0, max=1, help="Noise of each component over its largest magnitude."),
    ] = 0.0,
    certified: Annotated[
        bool, typer.Option("--certified", help="Check each station by integration from the clamp.")
    ] = False,
    engine: Annotated[
        str | None,
        typer.Option(
            metavar="mujoco",
            help="Sweep in this engine too, compare, and reconstruct from its readings.",
            show_default=False,
        ),
    ] = None,
    segments: Segments = None,
    with_budget: Annotated[
        bool, typer.Option("--budget", help="Split the engine's disagreement into parts too.")
    ] = False,
    frame: InFrame = "world",
    column: Columns = None,
) -> int:
    """Sweep past a body in space in closed form, and find the body from the clamp.

    Writes the readings, the contacts found as a table and as a point cloud with normals, and a
    picture; with an engine also the comparison, an animation and a report. `vibrissa compare` takes
    such a case and the readings of any other simulator.
    """
    from compare.read.space import load_space_job

    job = load_space_job(case)
    found = job.case
    _check_engine(engine, readings, segments, with_budget)
    agrees = True
    with output_folder(out or Path("results") / found.name) as folder:
        from analytic.problem.files import write_whole
        from analytic.space import (
            point_cloud,
            reconstruct_space,
            solve_space,
            wrench_complaint,
            write_ply,
        )
        from compare.commands import terminal
        from compare.show.figures.space import sweep_in_space
        from compare.show.page import save_figure
        from compare.show.scene import SweepScene

        if readings is None:
            with waiting("solving"):
                swept = solve_space(found, certified)
            terminal.print_line(_solved(swept))
            terminal.print_written(swept.write(folder / "analytic.parquet"))
            if engine is not None:
                if segments is not None:
                    job = job._replace(settings=replace(job.settings, segments=segments))
                compared = _compared(job, swept, folder, with_budget, frame)
                swept, agrees = compared.candidate, compared.agrees
        else:
            from compare.read.space_readings import read_space

            swept = read_space(readings, found.beam, found.path.tangent, column or (), frame)
        with waiting("reconstructing"):
            points = reconstruct_space(swept, _deviations(swept, noise))
        complaint = wrench_complaint(points)
        if complaint is not None:
            terminal.print_line(f"readings: {complaint}")
        cloud = point_cloud(points)
        terminal.print_line(_reconstructed(cloud, found))
        terminal.print_written(write_whole(folder / "points.csv", points.to_csv(index=False)))
        terminal.print_written(write_ply(cloud, folder / "points.ply"))
        if engine is None:  # else the report has drawn it
            with waiting("drawing"):
                picture = sweep_in_space(SweepScene.of(swept, found.body))
                written = save_figure(picture, folder / "space.png")
            terminal.print_written(written)
    wrong = complaint is not None or not agrees
    if "status" in swept.table:
        wrong |= bool((swept.table["status"] == "diverged").any())
    return DISAGREES if wrong else AGREES


def _check_engine(
    engine: str | None, readings: Path | None, segments: int | None, with_budget: bool
) -> None:
    from analytic import InputError

    if engine is not None and engine != "mujoco":
        raise InputError("--engine", repr(engine), "mujoco in space", "the others are planar")
    if engine is not None and readings is not None:
        raise InputError("--readings", str(readings), "not beside --engine", "leave one out")
    if engine is None and (segments is not None or with_budget):
        option = "--budget" if with_budget else "--segments"
        raise InputError(option, "given", "with --engine mujoco only", "add --engine mujoco")


def _compared(
    job: "SpaceJob",
    exact: "SpatialReadings",
    folder: Path,
    with_budget: bool,
    frame: "Frame",
) -> "SpatialComparison":
    """MuJoCo's sweep, the comparison, its parts if asked for, the animation and the report."""
    from compare.commands import terminal
    from compare.comparison_in_space import compare_space
    from compare.explain.split_space import split_space
    from compare.show.animation.space import write_space_animation
    from compare.show.report import Film
    from mujoco_models import simulate_space

    case, file = job.case, folder / f"mujoco-{job.settings.beam}.parquet"

    def sweep(chosen: "SpatialSettings") -> "SpatialReadings":
        with terminal.progress("stations", case.path.stations) as advance:
            return simulate_space(case, chosen, advance, keep)

    def keep(part: "SpatialReadings") -> None:
        terminal.print_written(part.write(file))

    candidate = sweep(job.settings)
    terminal.print_line(_solved(candidate))
    terminal.print_written(candidate.write(file))
    comparison = compare_space(exact, candidate, job.tolerances, frame=frame)
    parts = split_space(exact, candidate, job.settings, sweep) if with_budget else None
    with terminal.progress("frames", _FRAMES) as advance:
        write_space_animation(exact, candidate, folder, case.body, _FRAMES, advance)
    write_report(comparison, case.body, folder, parts, Film.of(folder))
    return comparison


def compare_in_space(
    reference: str,
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
    from compare.read.space import load_space_job
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
        from compare.show.report import Film

        body = None
        if reference.endswith(".toml"):
            job = load_space_job(reference)
            body, limits = job.case.body, limits or job.tolerances
            exact, called = solve_space(job.case), job.case.name
        else:
            exact, called = SpatialReadings.read(reference), distinct_name(Path(reference))
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
    from compare.show.spatial import write_spatial_report

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


def _reconstructed(cloud: "Cloud", case: "SpatialCase") -> str:
    from numpy import degrees, sqrt

    from analytic.space import misses

    found = misses(cloud, case.body, case.beam.length)
    distances = found.distances / case.beam.length
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
