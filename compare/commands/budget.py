"""Commands on what a disagreement is made of: ``budget``, ``findings``."""

from pathlib import Path
from typing import Annotated

import typer

from compare.commands.options import (
    AGREES,
    DISAGREES,
    Beam,
    CaseName,
    Changes,
    Obstacle,
    Out,
    Segments,
    Stations,
)
from compare.commands.output import output_folder


def budget(
    case: CaseName,
    out: Out = None,
    target: Annotated[
        float | None,
        typer.Option(
            metavar="RMS", help="Find the cheapest settings with an rms of at most this, as 1e-3."
        ),
    ] = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
) -> int:
    """Measure what the disagreement is made of."""
    changes = Changes(stations, segments, beam, obstacle)
    job = changes.job_at_rest(case, "budget")
    from compare.explain.advice import check_target

    if target is not None:
        check_target(target)
    with output_folder(changes.folder(out, job.case.name)) as folder:
        from analytic.problem.files import write_whole
        from compare.commands import terminal
        from compare.commands.engines import measured_budget
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
    from compare.commands import terminal
    from compare.show.findings import write_findings

    with output_folder(out or folder) as place:
        for path in write_findings(folder, place):
            terminal.print_written(path)
    return AGREES
