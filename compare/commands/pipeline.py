"""From a case to its report, alike in the plane and in space, at rest and in motion.

Solve the case, simulate it, compare, write the report, print: a job says how each is done.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TypeAlias

from analytic import CLAMP_READINGS, InputError, Readings
from analytic.problem.files import remove_own
from analytic.space import Body
from compare.align.frames import Frame
from compare.commands import terminal
from compare.commands.output import waiting
from compare.commands.sweeping import AnyReadings, printed, simulated, sweep_file
from compare.comparison import Comparison, SpatialComparison, compare
from compare.explain.budget import Budget
from compare.explain.likely import has_budget
from compare.explain.parts import Parted
from compare.read.job import AnyJob, Job
from compare.read.kinds import PLANE
from compare.read.runs import EngineOutcome
from compare.sense.noise import scales
from compare.show.document import Film
from compare.show.report import summary_of, write_report
from compare.show.side_by_side import SideBySide, reasons, summary, write_side_by_side
from engines import Outcome, list_engines
from engines.apart import sweep_apart

AnyComparison: TypeAlias = Comparison | SpatialComparison


@dataclass(frozen=True)
class Asked:
    """What ``run`` is to do beside its sweeps."""

    sweep_only: bool = False
    budget: bool = False
    target: float | None = None
    frames: int | None = None  # of a film; None for no film
    certified: bool = False
    frame: Frame = "world"  # of the components in space


def carry_out(job: AnyJob, folder: Path, asked: Asked) -> bool:
    """Do what is asked for, write it into a folder and print it; whether all agree."""
    if asked.budget and job.kind == PLANE and job.engines == ("mujoco",):
        from compare.simulate.workers import SWEEPERS, start_server

        start_server(SWEEPERS)  # it imports while we do
    exact: AnyReadings | None = None
    if not (asked.sweep_only and job.engines):
        with waiting("solving"):
            exact = job.solve(asked.certified)
            exact.write(folder / "analytic.parquet")
    if isinstance(job, Job) and job.engines not in ((), ("mujoco",)):
        return _swept_by_engines(job, exact, folder, asked.budget)
    if exact is None:
        return printed(job, simulated(job, folder), folder, sweep_file(job))
    if job.engines:
        return _compared_with_mujoco(job, exact, folder, asked)
    possible = printed(job, exact, folder, "analytic.parquet")
    return possible and (job.body is not None or bool(exact.trusted.all()))


def _compared_with_mujoco(job: AnyJob, exact: AnyReadings, folder: Path, asked: Asked) -> bool:
    if isinstance(exact, Readings):
        scales(exact)  # without a contact nothing can be compared
    with waiting("loading MuJoCo"):
        from compare.commands.budget import Measured, measured

    split = measured(job, asked.target) if asked.budget else Measured(simulated(job, folder))
    split.base.write(folder / sweep_file(job))
    found = compare(exact, split.base, job.tolerances, frame=asked.frame)
    if isinstance(job, Job) and isinstance(found, Comparison) and job.uncertainties:
        with waiting("validating"):
            numerics = split.budget if isinstance(split.budget, Budget) else None
            found = found.validated(job.case, job.uncertainties, "candidate", numerics)
    film = _filmed(found, folder, job.body, asked.frames)
    written = reported(found, folder, split.budget, film, job.body)
    split.write(folder)
    possible = job.kind == PLANE or printed(job, split.base, folder)
    if isinstance(job, Job) and job.model is not None:
        from compare.simulate.inspection import Inspection, measured_beam

        for fault in Inspection(measured_beam(job.model), job.case.beam).faults:
            terminal.print_line(str(fault))
    elif isinstance(job, Job) and job.motion is not None and isinstance(found, Comparison):
        _print_beside_rest(job, found, folder)
    more = "; --budget adds what the disagreement is made of"
    more *= not asked.budget and has_budget(exact, split.base)
    terminal.print_report(written, more)
    return found.agrees and possible and split.reached


def _filmed(
    found: AnyComparison, folder: Path, body: Body | None, frames: int | None
) -> Film | None:
    """The film, if there is to be one; an older one would be of other sweeps."""
    from compare.show.animation import plane, space

    if frames is None:
        remove_own(folder / "animation.gif")
        return None
    with terminal.progress("frames", frames) as advance:
        if isinstance(found, Comparison):
            plane.write_animation(found.reference, found.candidate, folder, frames, advance)
        elif body is not None:
            both = found.reference, found.candidate
            space.write_space_animation(*both, folder, body, frames, advance)
    return Film.of(folder)


def reported(
    comparison: AnyComparison,
    folder: Path,
    budget: Parted | None = None,
    film: Film | None = None,
    body: Body | None = None,
) -> Path:
    with waiting("drawing"):
        written = write_report(comparison, folder, budget, film, body)
    terminal.show(*summary_of(comparison))
    return written


def _print_beside_rest(job: Job, comparison: Comparison, folder: Path) -> None:
    """Print what of a disagreement in motion is there at rest, and what the motion adds."""
    if job.case.friction or job.case.others:
        return  # at rest many states are possible, or MuJoCo takes one object only
    from compare.simulate.dispatch import at_rest
    from mujoco_models import simulate_sweep

    settings = at_rest(job.settings, job.motion)
    with terminal.progress("at rest", job.stations) as advance:
        rest = simulate_sweep(job.case, settings, advance)
    rest.write(folder / "at-rest.parquet")
    resting = f"at rest, with contacts of {settings.contact_stiffness:.1e} EI/L^3"
    size, unit = rest.running_unit
    for what, found in (
        (resting, compare(comparison.reference, rest)),
        ("what the motion adds to that", compare(rest, comparison.candidate)),
    ):
        shift = found.snap_off.difference
        sizes = (f"{name} {found.disagreement[name].rms:.1e}" for name in CLAMP_READINGS)
        late = "" if shift is None else f"; snap-off {shift / size:+.1e} {unit}"
        terminal.print_line(f"{what}: {', '.join(sizes)}{late}")


def _swept_by_engines(job: Job, exact: AnyReadings | None, folder: Path, with_budget: bool) -> bool:
    outcomes = _swept(job, folder)
    sweeps = {one.engine: one.readings for one in outcomes if one.readings is not None}
    if not isinstance(exact, Readings):
        terminal.show(*reasons(_rows(outcomes)))
        return all(printed(job, x, folder, f"{name}.parquet") for name, x in sweeps.items())
    budget: Budget | None = None
    if with_budget and "mujoco" in sweeps:
        from compare.commands.budget import budget_of

        budget, _ = budget_of(job)
    found = SideBySide.of(exact, sweeps, _rows(outcomes), budget, job.case.name)
    return several_reported(found, folder, "engines")


def several_reported(found: SideBySide, folder: Path, called: str) -> bool:
    """Print and write how far all are apart; whether all agree."""
    terminal.show(*summary(found))
    if found.split is not None:
        terminal.print_line(found.split.sentence)
    for path in write_side_by_side(found, folder, called):
        terminal.print_written(path)
    return found.agree


def _swept(job: Job, folder: Path) -> Sequence[Outcome]:
    """The sweeps of a job's engines, each written to ``ENGINE.parquet``.

    One after the other: times are compared, and a machine with few cores would lend them unequally.
    """
    found = []
    with terminal.progress("engines", len(job.engines)) as advance:
        for name in job.engines:
            found.append(sweep_apart(name, job.case, job.settings, job.timeout))
            if found[-1].readings is not None:
                found[-1].readings.write(folder / f"{name}.parquet")
            advance()
    if all(one.readings is None for one in found):
        trouble = f"{found[0].engine}: {found[0].trouble}"
        raise InputError("engine", ", ".join(job.engines), "one that sweeps the case", trouble)
    return found


def _rows(outcomes: Sequence[Outcome]) -> list[EngineOutcome]:
    known = {found.name: found for found in list_engines()}
    each = [(known[one.engine], one.trouble) for one in outcomes]
    return [EngineOutcome(x.name, x.role, x.version or "none", x.tuned, why) for x, why in each]
