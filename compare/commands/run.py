"""The commands ``run`` and ``view``: a case is swept, compared with its closed form, reported."""

from typing import Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands import options as opt
from compare.commands.output import page_folder, waiting
from compare.read.job import Job
from compare.read.kinds import PLANE, SPACE

_OURS = ("mujoco",)


def run(
    context: typer.Context,
    case: opt.CaseName,
    out: opt.Out = None,
    engine: Annotated[
        str | None,
        opt.option(
            "What sweeps it beside its closed form: see `vibrissa list engines`; exact: only that.",
            "A,B,...",
            "the case's, or mujoco",
        ),
    ] = None,
    sweep_only: Annotated[
        bool,
        opt.flag("--sweep-only", "Sweep in the engines alone, and compare nothing."),
        opt.For(opt.ANY_CASE, (opt.SIMULATED,)),
    ] = False,
    budget: Annotated[
        bool,
        opt.flag("--budget", "Split MuJoCo's disagreement into its parts too."),
        opt.For(opt.ANY_CASE, (opt.IN_MUJOCO, opt.COMPARED)),
    ] = False,
    target: Annotated[
        float | None,
        opt.option(
            "Find the coarsest settings, or the fastest motion, with at most this rms.", "RMS"
        ),
        opt.For(opt.IN_THE_PLANE, (opt.WITH_MUJOCO, "--budget")),
    ] = None,
    film: Annotated[
        bool,
        opt.flag("--film", "Draw the sweep in motion too."),
        opt.For(opt.ANY_CASE, (opt.WITH_MUJOCO,)),
    ] = False,
    frames: Annotated[
        int,
        typer.Option(min=2, max=2000, help="Of the film."),
        opt.For(opt.ANY_CASE, (opt.WITH_MUJOCO, "--film")),
    ] = 48,
    certified: Annotated[
        bool,
        opt.flag("--certified", "Check the closed form's stations by integration from the clamp."),
        opt.For(opt.ANY_CASE, (opt.EXACT,)),
    ] = False,
    stations: opt.Stations = None,
    segments: opt.Segments = None,
    beam: opt.Beam = None,
    obstacle: opt.Obstacle = None,
    spatial: opt.Spatial = False,
    motion: opt.InMotion = False,
    speed: opt.Speed = None,
    timestep: opt.Timestep = None,
    frame: Annotated[opt.InFrame, opt.For((SPACE,), (opt.WITH_MUJOCO,))] = "world",
) -> bool:
    """Sweep a case in both models, compare, and write the report.

    One is the closed form, the other MuJoCo, or other engines. In the plane or in space, at rest or
    in motion, with our vibrissa or a user's own model: as the case's file says. In space the body
    is also found from the clamp.
    """
    changes = opt.Changes(
        stations, segments, beam, obstacle, spatial, motion, speed, timestep, engine
    )
    loaded = changes.load(case)
    kind = changes.kind(loaded)
    at_rest = [opt.AT_REST] if loaded.kind == PLANE else []
    opt.require_use(context, kind, *_done(loaded.engines, sweep_only), *at_rest)
    if kind != PLANE and loaded.engines not in ((), _OURS):
        raise InputError("engine", ", ".join(loaded.engines), "exact or mujoco", f"this is {kind}")
    if target is not None:
        opt.require_fraction("--target", target, "1e-3")
    job = changes.made(loaded)
    with page_folder(changes.folder(out, job.case.name)) as folder:
        with waiting("loading"):
            from compare.commands.pipeline import Asked, carry_out

        length = frames if film else None
        asked = Asked(sweep_only, budget, target, length, certified, frame)
        return carry_out(job, folder, asked)


def _done(engines: tuple[str, ...], sweep_only: bool) -> list[str]:
    """What is done with a case, as options ask for it."""
    done = [opt.EXACT] * (not sweep_only or not engines) + [opt.SIMULATED] * bool(engines)
    if "mujoco" in engines:
        done.append(opt.IN_MUJOCO)
    if engines and not sweep_only:
        done += [opt.COMPARED] + [opt.WITH_MUJOCO] * (engines == _OURS)
    return done


def view(
    context: typer.Context,
    case: Annotated[opt.CaseName, opt.For((PLANE,))],
    stations: opt.Stations = None,
    segments: opt.Segments = None,
    beam: opt.Beam = None,
    obstacle: opt.Obstacle = None,
) -> bool:
    """Show the sweep in MuJoCo's interactive viewer."""
    changes = opt.Changes(stations, segments, beam, obstacle)
    loaded = changes.load(case)
    opt.require_use(context, loaded.kind, opt.IN_MUJOCO, opt.SIMULATED)
    job = changes.made(loaded)
    if isinstance(job, Job):
        from mujoco_models import view_sweep

        view_sweep(job.case, job.settings)
    return True
