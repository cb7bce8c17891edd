"""What ``compare`` does with its files: one candidate is judged, several are set side by side."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

from analytic import Beam, InputError, Readings, Sweep
from analytic.problem.readings_file import is_ours
from analytic.space import Body, SpatialReadings
from compare.align.frames import Frame
from compare.commands import terminal
from compare.commands.output import distinct_names, page_folder
from compare.commands.pipeline import AnyComparison, reported, several_reported
from compare.commands.sweeping import AnyReadings, note_rows
from compare.commands.sweeping import RigFiles as RigFiles
from compare.comparison import Comparison, compare
from compare.explain.budget import Budget
from compare.judge.tolerances import SpatialTolerances, Tolerances
from compare.measure.repeats import Repeats, repeats
from compare.read.assumed import vibrissa_of
from compare.read.case import load_job
from compare.read.job import AnyJob, Job
from compare.read.limits import read_tolerances
from compare.read.run_folder import read_stored
from compare.read.space_readings import read_space
from compare.show.passes import repeats_summary
from compare.show.side_by_side import SideBySide


def expected(job: AnyJob | None, file: Path, in_space: bool, rig: RigFiles) -> AnyReadings:
    """The reference: the closed form of a case, or what a file holds."""
    if job is None:
        return SpatialReadings.read(file) if in_space else rig.read(file)
    exact: AnyReadings = job.solve()
    return exact


def measured(file: Path, reference: AnyReadings, rig: RigFiles) -> AnyReadings:
    """The candidate; what it does not say of its vibrissa is as in the reference."""
    if isinstance(reference, SpatialReadings):
        return read_space(file, reference.beam, reference.tangent, rig.columns, rig.frame)
    return rig.read(file, vibrissa_of(reference))


def mean_of(files: Sequence[Path], reference: AnyReadings, rig: RigFiles) -> Repeats:
    """Passes that went as the reference did, with their mean."""
    if isinstance(reference, SpatialReadings):
        raise InputError("CANDIDATE", "passes", "one file in space", "compare one by one")
    passes = rig.read_all(files, vibrissa_of(reference))
    check_one_way(passes)
    if len(passes) < 2:
        raise InputError("passes to the side", 1, "2 or more", "name the file of the pass alone")
    return repeats(passes)


def check_one_way(passes: Sequence[Readings]) -> None:
    """Refuse passes in both directions: no sweep is both."""
    if len({one.provenance["direction"] for one in passes}) > 1:
        given, remedy = "to the left and to the right", "--direction left, then --direction right"
        raise InputError("passes", given, "to one side", remedy)


def turned(job: AnyJob, files: Sequence[Path], rig: RigFiles) -> AnyJob:
    """The case swept as the passes were; or as is asked for, if there are none."""
    if not isinstance(job, Job) or not isinstance(job.case.sweep, Sweep):
        return job
    way = rig.direction
    if way is None and files:
        passes = [Readings.read(file) for file in files]
        check_one_way(passes)
        # Loads of the other direction are those of reversed rows, of a stage that counts back or of
        # wrong signs: the case's own direction shows which.
        if passes[0].bends_left == passes[0].runs_right:
            way = passes[0].provenance["direction"]
    sweep = job.case.sweep
    if way in (None, sweep.direction):
        return job
    back = replace(sweep, start=sweep.stop, stop=sweep.start, direction=way)
    return replace(job, case=replace(job.case, sweep=back))


def compared(
    reference: AnyReadings,
    candidate: AnyReadings,
    job: AnyJob | None,
    limits: Path | None,
    numbers: tuple[float | Literal["auto"], float | Literal["auto"]],
    frame: Frame,
) -> AnyComparison:
    """The comparison, by the limits of a file, else by the case's."""
    tolerances: Any = None if job is None else job.tolerances
    if limits is not None:
        in_space = isinstance(reference, SpatialReadings)
        kind: Any = SpatialTolerances if in_space else Tolerances
        tolerances = read_tolerances(limits, kind)
    offset, noise = numbers
    return compare(reference, candidate, tolerances, offset=offset, noise=noise, frame=frame)


def validated(
    found: AnyComparison, job: AnyJob | None, uncertainty: Path | None, budget: Path | None
) -> AnyComparison:
    """The comparison, held against what is uncertain of the case or of that of another file."""
    uncertain = job
    if uncertainty is not None:
        uncertain = load_job(uncertainty)
        if uncertain.uncertainties is None:
            allowed = "a case file with [uncertainty]"
            raise InputError("--uncertainty", uncertainty, allowed, "add the table")
    if isinstance(uncertain, Job) and isinstance(found, Comparison) and uncertain.uncertainties:
        numerics = None if budget is None else read_stored(budget, Budget)
        return found.validated(uncertain.case, uncertain.uncertainties, budget=numerics)
    if budget is not None:
        raise InputError("--budget", budget, "beside uncertainties", "add --uncertainty CASE.toml")
    return found


def keep_comparison(
    found: AnyComparison, out: Path, body: Body | None, passes: Repeats | None
) -> bool:
    """Write the report and print it; whether the sweeps agree."""
    with page_folder(out) as folder:
        written = reported(found, folder, body=body)
    for readings in (found.reference, found.candidate):
        if isinstance(readings, Readings):
            note_rows(readings)
    if passes is not None:
        terminal.show(*repeats_summary(passes))
    more = ""
    if isinstance(found, Comparison) and found.validation is None:
        more = "; [uncertainty] in the case says whether the disagreement means anything"
    terminal.print_report(written, more)
    return found.agrees


def side_by_side(
    job: AnyJob | None, reference: Path, files: list[Path], rig: RigFiles, out: Path
) -> bool:
    """Set files of readings against one reference and each other; whether all agree."""
    if len({path.absolute() for path in files}) < len(files):
        given = ", ".join(map(str, files))
        raise InputError("CANDIDATE", given, "each file once", "leave the second one out")
    plain = replace(rig, columns=(), beam=None)  # of ours nothing is to be said

    def read(path: Path, otherwise: Beam | None = None) -> Readings:
        return (plain if is_ours(path) else rig).read(path, otherwise)

    exact = job.solve() if isinstance(job, Job) else read(reference)
    known = vibrissa_of(exact)
    sweeps = {name: read(path, known) for name, path in distinct_names(files).items()}
    found = SideBySide.of(exact, sweeps, case=exact.provenance.get("case") or "Sweeps")
    with page_folder(out) as folder:
        for readings in (found.reference, *(one.candidate for one in found.against.values())):
            note_rows(readings)
        return several_reported(found, folder, "side-by-side")
