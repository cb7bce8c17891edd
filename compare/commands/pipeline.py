"""From a case to its report, alike in the plane and in space, at rest and in motion.

Solve the case, simulate it, compare, write the report, print: a job says how each is done.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

from analytic import Readings
from compare.commands import terminal
from compare.commands.keep import keep
from compare.commands.output import warn
from compare.commands.space import find_body, sweep_line
from compare.commands.waiting import waiting
from compare.read.job import AnyJob, Job
from compare.read.kinds import PLANE
from compare.show.document import Film

if TYPE_CHECKING:
    from analytic.problem.arrays import Floats
    from analytic.space import Body
    from compare.align.frames import Frame

AnyReadings: TypeAlias = Any
"""`Readings`, or `SpatialReadings` of a case in space."""
AnyComparison: TypeAlias = Any
"""`Comparison`, or `SpatialComparison` of such readings."""

AnyBudget: TypeAlias = Any
"""`Budget`, `Parts` of a disagreement in space, or None."""

_ANALYTIC = "analytic.parquet"


@dataclass(frozen=True)
class Asked:
    """What ``run`` is to do beside its sweeps."""

    sweep_only: bool = False
    budget: bool = False
    target: float | None = None
    frames: int | None = None  # of a film; None for no film
    figures: bool = False
    certified: bool = False
    frame: "Frame" = "world"  # of the components in space


def carry_out(job: AnyJob, folder: Path, asked: Asked) -> bool:
    """Do what is asked for, write it into a folder and print it; whether all agree."""
    if isinstance(job, Job) and job.engines not in ((), ("mujoco",)):
        from compare.commands.many import swept_by_engine

        return swept_by_engine(job, folder, asked)
    if asked.sweep_only and job.engines:
        return printed(job, simulated(job, folder), folder, sweep_file(job))
    if asked.budget and job.kind == PLANE:
        from compare.simulate.workers import SWEEPERS, start_server

        start_server(SWEEPERS)  # it imports while we do
    exact = solved(job, folder, asked)
    if job.engines:
        return _compared_with_mujoco(job, exact, folder, asked)
    possible = printed(job, exact, folder, _ANALYTIC)
    return possible and (job.body is not None or bool(exact.trusted.all()))


def _compared_with_mujoco(job: AnyJob, exact: AnyReadings, folder: Path, asked: Asked) -> bool:
    with waiting("loading MuJoCo"):
        from compare.commands.budget import measured
        from compare.comparison import compare

    split = measured(job, asked.target) if asked.budget else None
    candidate = simulated(job, folder) if split is None else split.base
    candidate.write(folder / sweep_file(job))
    comparison: AnyComparison = compare(exact, candidate, job.tolerances, frame=asked.frame)
    budget = None if split is None else split.on_page
    if job.uncertainties is not None:
        with waiting("validating"):
            comparison = comparison.validated(job.case, job.uncertainties, "candidate", budget)
    film = _filmed(job, exact, candidate, folder, asked.frames)
    written = reported(comparison, folder, budget, film, job.body)
    if split is not None:
        split.write(folder)
    possible = job.kind == PLANE or printed(job, candidate, folder)
    if job.model is not None:
        from compare.simulate.inspection import faults_of

        for line in faults_of(job.model, job.case.beam):
            terminal.print_line(line)
    elif isinstance(job, Job) and job.motion is not None:
        _print_beside_rest(job, exact, candidate, folder)
    terminal.print_written(written)
    return bool(comparison.agrees and possible and (split is None or split.reached))


def solved(job: AnyJob, folder: Path, asked: Asked) -> AnyReadings:
    """The closed form's sweep, and the paper's figures of it if asked for."""
    with waiting("solving"):
        exact: AnyReadings = job.solve(asked.certified)
        exact.write(folder / _ANALYTIC)
    if asked.figures and isinstance(job, Job):
        from analytic import reconstruct
        from compare.show.figures.geometry import reconstruction
        from compare.show.figures.paper import paper_figures

        drawn = paper_figures(job.case, exact)
        if not job.case.beam.varies:
            drawn["shapes"] = reconstruction(exact, reconstruct(exact))
        for name, figure in drawn.items():
            keep(folder / f"{name}.png", figure)
    return exact


def sweep_file(job: AnyJob) -> str:
    """What the file of a sweep in MuJoCo is called."""
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


def _filmed(
    job: AnyJob, exact: AnyReadings, candidate: AnyReadings, folder: Path, frames: int | None
) -> Film | None:
    """The film, if there is to be one; an older one would be of other sweeps."""
    from compare.show.animation import space, write_animation

    if frames is None:
        (folder / "animation.gif").unlink(missing_ok=True)
        return None
    with terminal.progress("frames", frames) as advance:
        if job.body is None:
            write_animation(exact, candidate, folder, frames, advance)
        else:
            space.write_space_animation(exact, candidate, folder, job.body, frames, advance)
    return Film.of(folder)


def reported(
    comparison: AnyComparison,
    folder: Path,
    budget: AnyBudget = None,
    film: Film | None = None,
    body: "Body | Floats | None" = None,
) -> Path:
    """Write the report, and print the verdict."""
    from compare.show import report

    in_space = not isinstance(comparison.reference, Readings)
    with waiting("drawing"):
        if in_space:
            written = report.write_spatial_report(comparison, body, folder, budget, film)
        else:
            written = report.write_report(comparison, folder, budget, film)
    print_comparison(comparison, budget)
    return written


def print_comparison(comparison: AnyComparison, budget: AnyBudget) -> None:
    """Print the verdict, and what it rests on."""
    if isinstance(comparison.reference, Readings):
        terminal.print_comparison(comparison)
    else:
        terminal.print_spatial_comparison(comparison, budget)


def printed(job: AnyJob, readings: AnyReadings, folder: Path, name: str | None = None) -> bool:
    """Print what a sweep found, and in space find the body from it; whether that could be."""
    if job.body is None:
        terminal.print_sweep(readings)
    else:
        terminal.print_line(sweep_line(readings))
    if name is not None:
        terminal.print_written(folder / name)
    return job.body is None or find_body(readings, job.body, folder, 0.0, name is not None)


def _print_beside_rest(job: Job, exact: Readings, moved: Readings, folder: Path) -> None:
    """Print what of a disagreement in motion is there at rest."""
    from compare.comparison import compare
    from compare.simulate.dispatch import at_rest, simulate

    with terminal.progress("at rest", job.stations) as advance:
        rest = simulate(job.case, at_rest(job.settings, job.motion), advance=advance)
    rest.write(folder / "at-rest.parquet")
    terminal.print_at_rest(compare(exact, rest), compare(rest, moved))
