"""From a case to its report, alike in the plane and in space, at rest and in motion.

Solve the case, simulate it, compare, write the report, print: a job says how each is done.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol, TypeAlias, TypeVar

from analytic import CLAMP_READINGS, Readings, reconstruct
from analytic.space import SpatialReadings
from compare.commands import terminal
from compare.commands.output import warn
from compare.commands.space import find_body
from compare.commands.sweep_lines import print_sweep
from compare.commands.waiting import waiting
from compare.comparison import Comparison, SpatialComparison, compare
from compare.explain.budget import Budget
from compare.explain.split_space import Parts
from compare.read.job import AnyJob, Job
from compare.read.kinds import PLANE
from compare.show import report
from compare.show.document import Film, Text
from compare.show.plane_page import plane_summary
from compare.show.spatial_page import spatial_summary

if TYPE_CHECKING:
    from analytic.problem.arrays import Floats
    from analytic.space import Body
    from compare.align.frames import Frame

AnyReadings: TypeAlias = Readings | SpatialReadings
AnyComparison: TypeAlias = Comparison | SpatialComparison
Sweep = TypeVar("Sweep", bound=Readings | SpatialReadings, covariant=True)

_ANALYTIC = "analytic.parquet"


class Solvable(Protocol[Sweep]):
    """A job, of which only the closed form counts."""

    def solve(self, certified: bool = False) -> Sweep:
        """The closed form."""


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
    exact: AnyReadings = solved(job, folder, asked.certified)
    if asked.figures and isinstance(job, Job) and isinstance(exact, Readings):
        draw_paper_figures(job, exact, folder)
    if job.engines:
        return _compared_with_mujoco(job, exact, folder, asked)
    possible = printed(job, exact, folder, _ANALYTIC)
    return possible and (job.body is not None or bool(exact.trusted.all()))


def _compared_with_mujoco(job: AnyJob, exact: AnyReadings, folder: Path, asked: Asked) -> bool:
    with waiting("loading MuJoCo"):
        from compare.commands.budget import Measured, measured

    split = measured(job, asked.target) if asked.budget else Measured(simulated(job, folder))
    candidate = split.base
    candidate.write(folder / sweep_file(job))
    comparison = compare(exact, candidate, job.tolerances, frame=asked.frame)
    if isinstance(comparison, Comparison) and isinstance(job, Job) and job.uncertainties:
        with waiting("validating"):
            comparison = comparison.validated(
                job.case, job.uncertainties, "candidate", split.budget
            )
    film = _filmed(comparison, folder, job.body, asked.frames)
    written = reported(comparison, folder, split.budget, split.parts, film, job.body)
    split.write(folder)
    possible = job.kind == PLANE or printed(job, candidate, folder)
    if isinstance(job, Job) and job.model is not None:
        from compare.simulate.inspection import faults_of

        for line in faults_of(job.model, job.case.beam):
            terminal.print_line(line)
    elif isinstance(job, Job) and job.motion is not None and isinstance(comparison, Comparison):
        _print_beside_rest(job, comparison, folder)
    terminal.print_written(written)
    return comparison.agrees and possible and split.reached


def solved(job: Solvable[Sweep], folder: Path, certified: bool) -> Sweep:
    """The closed form's sweep, written."""
    with waiting("solving"):
        exact = job.solve(certified)
        exact.write(folder / _ANALYTIC)
    return exact


def draw_paper_figures(job: Job, exact: Readings, folder: Path) -> None:
    """Write the paper's figures of a sweep."""
    from compare.show.figures.geometry import reconstruction
    from compare.show.figures.paper import paper_figures

    drawn = paper_figures(job.case, exact)
    if not job.case.beam.varies:
        drawn["shapes"] = reconstruction(exact, reconstruct(exact))
    for name, figure in drawn.items():
        terminal.keep(folder / f"{name}.png", figure)


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
    comparison: AnyComparison, folder: Path, body: "Body | None", frames: int | None
) -> Film | None:
    """The film, if there is to be one; an older one would be of other sweeps."""
    from compare.show.animation import space, write_animation

    if frames is None:
        (folder / "animation.gif").unlink(missing_ok=True)
        return None
    with terminal.progress("frames", frames) as advance:
        if isinstance(comparison, Comparison):
            write_animation(comparison.reference, comparison.candidate, folder, frames, advance)
        elif body is not None:
            space.write_space_animation(
                comparison.reference, comparison.candidate, folder, body, frames, advance
            )
    return Film.of(folder)


def reported(
    comparison: AnyComparison,
    folder: Path,
    budget: Budget | None = None,
    parts: Parts | None = None,
    film: Film | None = None,
    body: "Body | Floats | None" = None,
) -> Path:
    """Write the report, and print the verdict."""
    with waiting("drawing"):
        if isinstance(comparison, Comparison):
            written = report.write_report(comparison, folder, budget, film)
        else:
            written = report.write_spatial_report(comparison, body, folder, parts, film)
    print_comparison(comparison, parts)
    return written


def print_comparison(comparison: AnyComparison, parts: Parts | None) -> None:
    """Print the verdict, and what it rests on."""
    if isinstance(comparison, Comparison):
        terminal.show(*plane_summary(comparison))
    else:
        terminal.show(*spatial_summary(comparison, parts))


def printed(job: AnyJob, readings: AnyReadings, folder: Path, name: str | None = None) -> bool:
    """Print what a sweep found, and in space find the body from it; whether that could be."""
    print_sweep(readings)
    if name is not None:
        terminal.print_written(folder / name)
    return isinstance(readings, Readings) or find_body(
        readings, job.body, folder, 0.0, name is not None
    )


def _print_beside_rest(job: Job, comparison: Comparison, folder: Path) -> None:
    """Print what of a disagreement in motion is there at rest, and what the motion adds."""
    from compare.simulate.dispatch import at_rest
    from mujoco_models import simulate_sweep

    settings = at_rest(job.settings, job.motion)
    with terminal.progress("at rest", job.stations) as advance:
        rest = simulate_sweep(job.case, settings, advance)
    rest.write(folder / "at-rest.parquet")
    for what, found in (
        (f"at rest, with contacts of {settings.contact_stiffness:.1e} EI/L^3",
         compare(comparison.reference, rest)),
        ("what the motion adds to that", compare(rest, comparison.candidate)),
    ):  # fmt: skip
        shift = found.snap_off.difference
        sizes = (f"{name} {found.disagreement[name].rms:.1e}" for name in CLAMP_READINGS)
        late = "" if shift is None else f"; snap-off {shift / job.case.beam.length:+.1e} L"
        terminal.show(Text(f"{what}: {', '.join(sizes)}{late}"))
