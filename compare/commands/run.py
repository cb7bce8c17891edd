"""The commands ``run`` and ``view``: a case is swept, compared with its closed form, reported."""

from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands.asked import Asked
from compare.commands.kinds import ANY_CASE, IN_THE_PLANE, For, require_use
from compare.commands.options import (
    AGREES,
    AT_REST,
    COMPARED,
    DISAGREES,
    EXACT,
    IN_MUJOCO,
    SIMULATED,
    WITH_MUJOCO,
    Beam,
    CaseName,
    Changes,
    InFrame,
    InMotion,
    Obstacle,
    Out,
    Segments,
    Spatial,
    Speed,
    Stations,
    Timestep,
    flag,
    option,
)
from compare.commands.output import output_folder
from compare.commands.waiting import waiting
from compare.read.kinds import PLANE, SPACE

if TYPE_CHECKING:
    from analytic import Readings
    from compare.read.job import Job

_OURS = ("mujoco",)


def run(
    context: typer.Context,
    case: CaseName,
    out: Out = None,
    engine: Annotated[
        str | None,
        option(
            "What sweeps it beside its closed form: see `vibrissa list engines`; exact: only that.",
            "A,B,...",
            "the case's, or mujoco",
        ),
    ] = None,
    sweep_only: Annotated[
        bool,
        flag("--sweep-only", "Sweep in the engines alone, and compare nothing."),
        For(ANY_CASE, (SIMULATED,)),
    ] = False,
    budget: Annotated[
        bool,
        flag("--budget", "Split MuJoCo's disagreement into its parts too."),
        For(ANY_CASE, (IN_MUJOCO, COMPARED)),
    ] = False,
    target: Annotated[
        float | None,
        option("Find the cheapest settings, or the fastest motion, with at most this rms.", "RMS"),
        For(IN_THE_PLANE, (WITH_MUJOCO, "--budget")),
    ] = None,
    film: Annotated[
        bool, flag("--film", "Draw the sweep in motion too."), For(ANY_CASE, (WITH_MUJOCO,))
    ] = False,
    frames: Annotated[
        int,
        typer.Option(min=2, max=2000, help="Of the film."),
        For(ANY_CASE, (WITH_MUJOCO, "--film")),
    ] = 48,
    figures: Annotated[
        bool, flag("--figures", "Draw the paper's figures of it too."), For(IN_THE_PLANE, (EXACT,))
    ] = False,
    certified: Annotated[
        bool,
        flag("--certified", "Check the closed form's stations by integration from the clamp."),
        For(ANY_CASE, (EXACT,)),
    ] = False,
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
    spatial: Spatial = False,
    motion: InMotion = False,
    speed: Speed = None,
    timestep: Timestep = None,
    frame: Annotated[InFrame, For((SPACE,), (WITH_MUJOCO,))] = "world",
) -> int:
    """Sweep a case in both models, compare, and write the report.

    One is the closed form, the other MuJoCo, or other engines. In the plane or in space, at rest or
    in motion, with our vibrissa or a user's own model: as the case's file says. In space the body
    is also found from the clamp.
    """
    changes = Changes(stations, segments, beam, obstacle, spatial, motion, speed, timestep, engine)
    loaded = changes.load(case)
    kind = changes.kind(loaded)
    at_rest = [AT_REST] if loaded.kind == PLANE else []
    require_use(context, kind, *_done(loaded.engines, sweep_only), *at_rest)
    if kind != PLANE and loaded.engines not in ((), _OURS):
        raise InputError("engine", ", ".join(loaded.engines), "exact or mujoco", f"this is {kind}")
    if target is not None:
        from compare.explain.advice import check_target

        check_target(target)
    job = changes.made(loaded)
    asked = Asked(sweep_only, budget, target, frames if film else None, figures, certified, frame)
    from compare.read.job import Job

    with output_folder(changes.folder(out, job.case.name)) as folder:
        if not isinstance(job, Job):
            from compare.commands.space import run_in_space

            return run_in_space(job, folder, asked)
        if not job.engines:
            return _exact_alone(job, folder, asked)
        if sweep_only:
            return _engines_alone(job, folder)
        if job.engines != _OURS:
            from compare.commands.many import run_many

            return run_many(job, _solved(job, folder, asked), folder, budget)
        return _with_mujoco(job, folder, asked)


def _done(engines: tuple[str, ...], sweep_only: bool) -> list[str]:
    """What is done with a case, as options ask for it."""
    done = [EXACT] * (not sweep_only or not engines) + [SIMULATED] * bool(engines)
    if "mujoco" in engines:
        done.append(IN_MUJOCO)
    if engines and not sweep_only:
        done += [COMPARED] + [WITH_MUJOCO] * (engines == _OURS)
    return done


def _solved(job: "Job", folder: Path, asked: Asked) -> "Readings":
    with waiting("solving"):
        from analytic import solve_sweep

        exact = solve_sweep(job.case, asked.certified)
        exact.write(folder / "analytic.parquet")
    if asked.figures:
        from analytic import reconstruct
        from compare.commands.keep import keep
        from compare.show.figures.geometry import reconstruction
        from compare.show.figures.paper import paper_figures

        drawn = paper_figures(job.case, exact)
        if not job.case.beam.varies:
            drawn["shapes"] = reconstruction(exact, reconstruct(exact))
        for name, figure in drawn.items():
            keep(folder / f"{name}.png", figure)
    return exact


def _exact_alone(job: "Job", folder: Path, asked: Asked) -> int:
    exact = _solved(job, folder, asked)
    from compare.commands import terminal

    terminal.print_sweep(exact)
    terminal.print_written(folder / "analytic.parquet")
    return AGREES if exact.trusted.all() else DISAGREES


def _engines_alone(job: "Job", folder: Path) -> int:
    with waiting("loading"):
        from compare.commands import terminal
    if job.engines != _OURS:
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


def _with_mujoco(job: "Job", folder: Path, asked: Asked) -> int:
    if asked.budget and job.kind == PLANE:
        from compare.simulate.workers import SWEEPERS, start_server

        start_server(SWEEPERS)  # it imports while we do
    exact = _solved(job, folder, asked)
    with waiting("loading MuJoCo"):
        from compare.commands import budget as split
        from compare.commands import terminal
        from compare.commands.engines import simulated, sweep_file, swept_at_rest
        from compare.comparison import compare
        from compare.show.animation import write_animation
        from compare.show.report import write_report

    measured = split.measured(job, asked.target) if asked.budget else None
    if measured is None:
        candidate = simulated(job, folder)
    else:
        candidate = measured.base
        candidate.write(folder / sweep_file(job))
    found = None if measured is None else measured.at_rest
    comparison = compare(exact, candidate, job.tolerances)
    if job.uncertainties is not None:
        with waiting("validating"):
            comparison = comparison.validated(job.case, job.uncertainties, "candidate", found)
    film = asked.film(partial(write_animation, exact, candidate), folder)
    with waiting("drawing"):
        written = write_report(comparison, folder, found, film)
    if measured is not None:
        measured.write(folder)
    terminal.print_comparison(comparison)
    if job.kind != PLANE:
        terminal.print_sweep(candidate)
    if job.model is not None:
        from compare.simulate.inspection import faults_of

        for line in faults_of(job.model, job.case.beam):
            terminal.print_line(line)
    elif job.motion is not None:
        rest = swept_at_rest(job)
        rest.write(folder / "at-rest.parquet")
        terminal.print_at_rest(compare(exact, rest), compare(rest, candidate))
    terminal.print_written(written)
    reached = measured is None or measured.reached
    return AGREES if comparison.agrees and reached else DISAGREES


def view(
    context: typer.Context,
    case: Annotated[CaseName, For((PLANE,))],
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
) -> int:
    """Show the sweep in MuJoCo's interactive viewer."""
    changes = Changes(stations, segments, beam, obstacle)
    loaded = changes.load(case)
    require_use(context, loaded.kind, IN_MUJOCO, SIMULATED)
    from compare.read.job import Job

    job = changes.made(loaded)
    if isinstance(job, Job):
        from mujoco_models import view_sweep

        view_sweep(job.case, job.settings)
    return AGREES
