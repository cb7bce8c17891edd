"""Commands on what a disagreement is made of: ``budget``, ``findings``."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from compare.commands.given import require_folder
from compare.commands.options import (
    AGREES,
    DISAGREES,
    Beam,
    CaseName,
    Changes,
    InMotion,
    Obstacle,
    Out,
    Segments,
    Speed,
    Stations,
    Timestep,
)
from compare.commands.output import output_folder

if TYPE_CHECKING:
    from compare.read.case import Job


def budget(
    case: CaseName,
    out: Out = None,
    target: Annotated[
        float | None,
        typer.Option(
            metavar="RMS",
            help="Find the cheapest settings, or the fastest motion, with an rms of at most this.",
        ),
    ] = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
    motion: InMotion = False,
    speed: Speed = None,
    timestep: Timestep = None,
) -> int:
    """Measure what the disagreement is made of.

    In motion, if the case has a [motion] or [model] table or an option asks for it: what speed,
    damping, time step, contacts, solver and the model's own beam add to what is there at rest.
    """
    changes = Changes(
        stations, segments, beam, obstacle, motion=motion, speed=speed, timestep=timestep
    )
    job = changes.job(case)
    from compare.explain.advice import check_target

    if target is not None:
        check_target(target)
    if job.motion is not None:
        return _in_motion(job, changes.folder(out, job.case.name), target)
    from compare.simulate.workers import SWEEPERS, start_server

    start_server(SWEEPERS)  # it imports while we do
    with output_folder(changes.folder(out, job.case.name)) as folder:
        from analytic.problem.files import write_whole
        from compare.commands import terminal
        from compare.commands.measured_budgets import measured_budget
        from compare.show.report import budget_files
        from compare.simulate.target import follow_advice

        found, runs = measured_budget(job)
        contents = budget_files(found)
        terminal.print_budget(found, job.case.name)
        for name, content in contents.items():
            terminal.print_written(write_whole(folder / name, content))
        advice = None
        if target is not None:
            advice = follow_advice(job.case, found, runs, target)
            with_advice = budget_files(found, advice.to_dict())["budget.json"]
            write_whole(folder / "budget.json", with_advice)
            terminal.print_advice(advice)
        return AGREES if found.closes and (advice is None or advice.reached) else DISAGREES


def _in_motion(job: "Job", place: Path, target: float | None) -> int:
    with output_folder(place) as folder:
        from analytic.problem.files import write_whole
        from compare.commands import terminal
        from compare.commands.measured_budgets import fastest_motion, measured_motion_budget

        found, runs = measured_motion_budget(job)
        terminal.print_motion_budget(found, job.case.name)
        for name, readings in runs.items():
            readings.write(folder / f"{name}.parquet")
        content = found.to_dict()
        path = write_whole(folder / "motion-budget.json", json.dumps(content, indent=2))
        terminal.print_written(path)
        if target is not None:
            fastest = fastest_motion(job, runs, target)
            content["fastest"] = fastest.to_dict()
            write_whole(path, json.dumps(content, indent=2))
            terminal.print_fastest(fastest)
        return AGREES if found.closes else DISAGREES


def findings(
    folder: Annotated[
        Path, typer.Argument(metavar="DIR", help="Folder with the folders of runs in it.")
    ],
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder for the page.", show_default="DIR"),
    ] = None,
) -> int:
    """Write a page about all runs in a folder."""
    require_folder(folder, "make runs in it: vibrissa run CASE --out DIR/CASE")
    from compare.commands import terminal
    from compare.report import write_report

    with output_folder(out or folder) as place:
        terminal.print_written(write_report(folder, place).path)
    return AGREES
