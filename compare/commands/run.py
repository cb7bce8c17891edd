"""The commands ``run`` and ``view``: a case is swept, compared with its closed form, reported."""

from typing import Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands.options import (
    ANY_CASE,
    AT_REST,
    COMPARED,
    EXACT,
    IN_MUJOCO,
    IN_THE_PLANE,
    SIMULATED,
    WITH_MUJOCO,
    Beam,
    CaseName,
    Changes,
    For,
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
    require_fraction,
    require_use,
)
from compare.commands.output import page_folder, waiting
from compare.read.kinds import PLANE, SPACE

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
        option("Find the coarsest settings, or the fastest motion, with at most this rms.", "RMS"),
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
) -> bool:
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
        require_fraction("--target", target, "1e-3")
    job = changes.made(loaded)
    with page_folder(changes.folder(out, job.case.name)) as folder:
        with waiting("loading"):
            from compare.commands.pipeline import Asked, carry_out

        length = frames if film else None
        asked = Asked(sweep_only, budget, target, length, certified, frame)
        return carry_out(job, folder, asked)


def _done(engines: tuple[str, ...], sweep_only: bool) -> list[str]:
    """What is done with a case, as options ask for it."""
    done = [EXACT] * (not sweep_only or not engines) + [SIMULATED] * bool(engines)
    if "mujoco" in engines:
        done.append(IN_MUJOCO)
    if engines and not sweep_only:
        done += [COMPARED] + [WITH_MUJOCO] * (engines == _OURS)
    return done


def view(
    context: typer.Context,
    case: Annotated[CaseName, For((PLANE,))],
    stations: Stations = None,
    segments: Segments = None,
    beam: Beam = None,
    obstacle: Obstacle = None,
) -> bool:
    """Show the sweep in MuJoCo's interactive viewer."""
    changes = Changes(stations, segments, beam, obstacle)
    loaded = changes.load(case)
    require_use(context, loaded.kind, IN_MUJOCO, SIMULATED)
    from compare.read.job import Job

    job = changes.made(loaded)
    if isinstance(job, Job):
        from mujoco_models import view_sweep

        view_sweep(job.case, job.settings)
    return True
