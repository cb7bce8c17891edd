"""Commands that sweep a case: ``run``, ``analytic``, ``simulate``, ``view``, ``animate``.

And ``report``, which does what ``run`` does after its sweeps.
"""

from pathlib import Path
from typing import Annotated

import typer

from compare.commands.given import require_folder
from compare.commands.options import (
    AGREES,
    DISAGREES,
    Beam,
    CaseName,
    Changes,
    Engines,
    InMotion,
    Obstacle,
    Out,
    Segments,
    Spatial,
    Speed,
    Stations,
    Timestep,
)
from compare.commands.output import output_folder
from compare.commands.reported import print_report
from compare.commands.waiting import waiting

_FRAMES = 48  # of a report's animation: smooth enough, and under 2 MB


def run(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    with_budget: Annotated[
        bool, typer.Option("--budget", help="Split the disagreement into its parts too.")
    ] = False,
    obstacle: Obstacle = None,
    spatial: Spatial = False,
    motion: InMotion = False,
    speed: Speed = None,
    timestep: Timestep = None,
    engine: Engines = None,
) -> int:
    """Sweep in both models, compare, and write the report.

    In motion, if the case has a [motion] table or an option asks for it; the same model is then
    also swept at rest, to see what the motion adds. With other engines than MuJoCo, one report
    compares all of them.
    """
    changes = Changes(stations, segments, beam, obstacle, spatial, motion, speed, timestep, engine)
    job = changes.job_at_rest(case, "--budget") if with_budget else changes.job(case)
    with output_folder(changes.folder(out, job.case.name)) as folder:
        if job.engines != ("mujoco",):
            from compare.commands.many import run_many

            return run_many(job, folder, with_budget)
        with waiting("solving"):
            from analytic import solve_sweep

            exact = solve_sweep(job.case)
            exact.write(folder / "analytic.parquet")
        with waiting("loading MuJoCo"):
            from compare.commands import terminal
            from compare.commands.engines import at_rest, simulated, sweep_file
            from compare.comparison import compare
            from compare.show.animation import write_animation
            from compare.show.report import Film, write_report

        found = None
        if with_budget:
            from compare.commands.measured_budgets import measured_budget

            found, runs = measured_budget(job)
            candidate = runs["base"]
            candidate.write(folder / sweep_file(job))
        else:
            candidate = simulated(job, folder)
        comparison = compare(exact, candidate, job.tolerances)
        if job.uncertainties is not None:
            with waiting("validating"):
                comparison = comparison.validated(job.case, job.uncertainties, "candidate", found)
        rest = at_rest(job) if job.motion and job.model is None else None
        if found is not None:
            terminal.print_budget(found, job.case.name)
        with terminal.progress("frames", _FRAMES) as advance:
            write_animation(exact, candidate, folder, _FRAMES, advance)
        with waiting("drawing"):
            written = write_report(comparison, folder, found, Film.of(folder))
        terminal.print_comparison(comparison)
        if rest is not None:
            rest.write(folder / "at-rest.parquet")
            terminal.print_sweep(candidate)
            terminal.print_at_rest(compare(exact, rest), compare(rest, candidate))
        if job.model is not None:
            from compare.simulate.inspection import faults_of

            terminal.print_sweep(candidate)
            for line in faults_of(job.model, job.case.beam):
                terminal.print_line(line)
        terminal.print_written(written)
        return AGREES if comparison.agrees else DISAGREES


def report(
    folder: Annotated[
        Path,
        typer.Argument(metavar="DIR", help="Folder of a run or a study, or with folders of runs."),
    ],
) -> int:
    """Write the page of a run, of a study, or of many runs, from what is stored of them.

    Also where there is none yet, after `analytic` and `simulate` of a case with one --out.
    """
    require_folder(folder, "make one: vibrissa run CASE --out DIR")
    with output_folder(folder), waiting("reading"):
        from compare.report import write_report

        written = write_report(folder)
    return print_report(written)


def analytic(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    certified: Annotated[
        bool, typer.Option("--certified", help="Check each station by integration from the clamp.")
    ] = False,
    figures: Annotated[
        bool,
        typer.Option(
            "--figures",
            help="Draw the vibrissa along its sweep, and the paper's figures.",
        ),
    ] = False,
) -> int:
    """Sweep in closed form."""
    changes = Changes(stations)
    job = changes.job(case)
    with output_folder(changes.folder(out, job.case.name)) as folder:
        with waiting("solving"):
            from analytic import solve_sweep
            from compare.commands import terminal

            readings = solve_sweep(job.case, certified)
        terminal.print_sweep(readings)
        terminal.print_written(readings.write(folder / "analytic.parquet"))
        if figures:
            from analytic import reconstruct
            from compare.show.figures.geometry import reconstruction
            from compare.show.figures.paper import paper_figures
            from compare.show.page import save_figure

            drawn = paper_figures(job.case, readings)
            if not job.case.beam.varies:
                drawn["shapes"] = reconstruction(readings, reconstruct(readings))
            for name, figure in drawn.items():
                terminal.print_written(save_figure(figure, folder / f"{name}.png"))
        return AGREES if readings.trusted.all() else DISAGREES


def simulate(
    case: CaseName,
    out: Out = None,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
    spatial: Spatial = False,
    motion: InMotion = False,
    speed: Speed = None,
    timestep: Timestep = None,
    engine: Engines = None,
) -> int:
    """Sweep in MuJoCo, at rest at every station or in motion; or at rest in other engines."""
    changes = Changes(stations, segments, beam, obstacle, spatial, motion, speed, timestep, engine)
    job = changes.job(case)
    with output_folder(changes.folder(out, job.case.name)) as folder:
        with waiting("loading"):
            from compare.commands import terminal

        if job.engines != ("mujoco",):
            from compare.commands.many import swept

            for one in swept(job, folder):
                if one.readings is not None:
                    terminal.print_sweep(one.readings)
                    terminal.print_written(folder / f"{one.engine}.parquet")
            return AGREES
        from compare.commands.engines import simulated, sweep_file

        terminal.print_sweep(simulated(job, folder))
        terminal.print_written(folder / sweep_file(job))
        return AGREES


def view(
    case: CaseName,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
) -> int:
    """Show the sweep in MuJoCo's interactive viewer."""
    job = Changes(stations, segments, beam, obstacle).job_at_rest(case, "view")
    from mujoco_models import view_sweep

    view_sweep(job.case, job.settings)
    return AGREES


def animate(
    case: CaseName,
    out: Out = None,
    frames: Annotated[int, typer.Option(min=2, max=2000, help="Frames of the animation.")] = 60,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
) -> int:
    """Sweep in both models, and draw it in motion."""
    changes = Changes(stations, segments, beam, obstacle)
    job = changes.job(case)
    with output_folder(changes.folder(out, job.case.name)) as folder:
        with waiting("solving"):
            from analytic import solve_sweep

            exact = solve_sweep(job.case)
            exact.write(folder / "analytic.parquet")
        with waiting("loading MuJoCo"):
            from compare.commands import terminal
            from compare.commands.engines import simulated
            from compare.show.animation import write_animation

        candidate = simulated(job, folder)
        with terminal.progress("frames", frames) as advance:
            for path in write_animation(exact, candidate, folder, frames, advance):
                terminal.print_written(path)
        return AGREES


def cases() -> int:
    """List the named cases."""
    import numpy as np

    from analytic.problem.named import NAMED_TABLES, named_case, named_contour
    from analytic.problem.support import beyond_the_paper

    for name in NAMED_TABLES:
        profile = named_contour(name)
        lowest = profile.at(profile.parameter(np.array([0.0])))
        place = f"lowest at x = {lowest.xi[0]:g} L, y = {lowest.eta[0]:.4g} L"
        case = named_case(name)
        beyond = beyond_the_paper(case.beam, case.clamp_stiffness, case.friction)
        parts = [place, *(f"{what} {value:g}" for what, value in beyond.items())]
        typer.echo(f"{name:18}{profile.label:40}{'; '.join(parts)}")
    return AGREES


def engines() -> int:
    """List the engines that can sweep a case, and whether they are installed."""
    from engines import list_engines

    for found in list_engines():
        role = "" if found.engine is None else found.engine.role
        there = found.trouble or found.version or ""
        typer.echo(f"{found.name:12}{role:14}{there}")
    return AGREES
