"""The command ``compare``: files of readings against another or against a case's closed form."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from analytic.problem.errors import InputError
from compare.commands.given import A_RIG, no_rigs, require_readings
from compare.commands.kinds import For, require_use
from compare.commands.options import (
    AGREES,
    DISAGREES,
    BeamFile,
    Columns,
    InFrame,
    Way,
    number_or_auto,
    option,
    out_folder,
)
from compare.commands.output import distinct_name, distinct_names, output_folder
from compare.commands.waiting import waiting
from compare.read.kinds import SPACE, TABLES

if TYPE_CHECKING:
    from analytic import Beam
    from compare.explain.budget import Budget
    from compare.read.job import AnyJob, Job

ONE, SEVERAL = "two sweeps in the plane", "several candidates in the plane"
_STORED = "a reference that is a file"


def compare(
    context: typer.Context,
    reference: Annotated[
        str, typer.Argument(help="A case, for its closed form, or a file of readings.")
    ],
    candidates: Annotated[
        list[Path], typer.Argument(metavar="CANDIDATE...", help="Readings to compare with it.")
    ],
    out: Annotated[
        Path | None, out_folder("results/REFERENCE-CANDIDATE, of several results/side-by-side")
    ] = None,
    column: Annotated[Columns, For((ONE, SPACE)), For((SEVERAL,), (A_RIG,))] = None,
    beam: Annotated[BeamFile, For((ONE,)), For((SEVERAL,), (A_RIG,))] = None,
    reference_column: Annotated[
        list[str] | None,
        option("As --column, for the reference.", "NAME=COLUMN[:UNIT]"),
        For((ONE,), (_STORED,)),
    ] = None,
    reference_beam: Annotated[
        Path | None, option("As --beam, for the reference.", "FILE"), For((ONE,), (_STORED,))
    ] = None,
    offset: Annotated[
        str,
        option("Of the candidate's foot_x from the reference's; auto: estimate it.", "NUMBER|auto"),
        For((ONE,)),
    ] = "0",
    noise: Annotated[
        str,
        option(
            "Of the clamp readings over their largest magnitude, as 0.01: the limits are widened "
            "by it; auto: estimate it.",
            "NUMBER|auto",
        ),
        For((ONE, SPACE)),
    ] = "0",
    direction: Annotated[Way, For((ONE, SEVERAL), (A_RIG,))] = None,
    tolerances: Annotated[
        Path | None,
        option("TOML file whose [tolerances] are the limits.", "FILE"),
        For((ONE, SPACE)),
    ] = None,
    uncertainty: Annotated[
        Path | None,
        option("Case file whose [uncertainty] holds for a reference that is a file.", "FILE"),
        For((ONE,), (_STORED,)),
    ] = None,
    budget: Annotated[
        Path | None,
        option("budget.json of that reference, for its numerics.", "FILE"),
        For((ONE,)),
    ] = None,
    frame: Annotated[InFrame, For((SPACE,))] = "world",
) -> int:
    """Compare readings with others or with a closed form.

    The limits are those of --tolerances, else the case's. The sweeps are in space if the reference
    is: a case file with [body], or readings of such a case. Several files, of engines or rigs, are
    compared with the reference and with each other; there --column, --beam and --direction hold for
    those of rigs.
    """
    job = _job(reference)
    stored = [] if job is not None else [Path(reference)]
    kind = _kind(job, stored, candidates)
    require_readings([*stored, *candidates])
    raw = kind == ONE and bool(column or reference_column)  # then our files are read as a rig's
    rigs = raw or not no_rigs([*stored, *candidates])
    require_use(context, kind, *([_STORED] if stored else []), *([A_RIG] if rigs else []))
    if kind == SEVERAL:
        return _several(reference, job, candidates, out, column, beam, direction)
    given_offset = number_or_auto("--offset", offset)
    given_noise = number_or_auto("--noise", noise)
    with waiting("comparing"):
        from compare.commands import terminal
        from compare.commands.pipeline import AnyComparison, AnyReadings, reported
        from compare.comparison import compare as compare_readings
        from compare.judge.spatial import SpatialTolerances
        from compare.judge.tolerances import Tolerances
        from compare.read.assumed import vibrissa_of
        from compare.read.limits import read_tolerances
        from compare.read.rig import read_measured

        limits: Any = None if job is None else job.tolerances
        if tolerances is not None:
            in_space: Any = SpatialTolerances
            limits = read_tolerances(tolerances, in_space if kind == SPACE else Tolerances)
        expected: AnyReadings
        measured: AnyReadings
        if kind == SPACE:
            from analytic.space import SpatialReadings
            from compare.read.space_readings import read_space

            expected = job.solve() if job else SpatialReadings.read(Path(reference))
            held = expected.beam, expected.tangent
            measured = read_space(candidates[0], *held, column or (), frame)
        else:
            expected = (
                job.solve()
                if job
                else read_measured(
                    Path(reference), reference_beam, reference_column or (), None, direction
                )
            )
            known = vibrissa_of(expected)
            measured = read_measured(candidates[0], beam, column or (), known, direction)
        comparison: AnyComparison = compare_readings(
            expected, measured, limits, offset=given_offset, noise=given_noise, frame=frame
        )
        uncertain = job if uncertainty is None else _uncertain(uncertainty)
        if uncertain is not None and uncertain.uncertainties is not None:
            numerics = None if budget is None else _budget(budget)
            comparison = comparison.validated(
                uncertain.case, uncertain.uncertainties, budget=numerics
            )
        elif budget is not None:
            raise InputError(
                "--budget", budget, "beside uncertainties", "add --uncertainty CASE.toml"
            )
    called = distinct_name(Path(reference)) if job is None else job.case.name
    default = Path("results") / f"{called}-{distinct_name(candidates[0])}"
    with output_folder(out or default) as folder:
        written = reported(comparison, folder, body=None if job is None else job.body)
    if kind == SPACE:
        from analytic.space import reconstruct_space, wrench_complaint

        complaint = wrench_complaint(reconstruct_space(measured))
        if complaint is not None:
            terminal.print_line(f"{measured.source}: {complaint}")
    else:
        terminal.note_rows(expected)
        terminal.note_rows(measured)
    terminal.print_written(written)
    return AGREES if comparison.agrees else DISAGREES


def _several(
    reference: str,
    job: "AnyJob | None",
    files: list[Path],
    out: Path | None,
    column: list[str] | None,
    beam: Path | None,
    direction: Way,
) -> int:
    """Compare many files of readings with one reference and with each other."""
    if len({path.absolute() for path in files}) < len(files):
        raise InputError(
            "CANDIDATE", ", ".join(map(str, files)), "each file once", "leave the second one out"
        )
    from analytic import Readings
    from analytic.problem.readings_file import is_ours
    from compare.commands import terminal
    from compare.read.assumed import vibrissa_of
    from compare.read.rig import read_measured
    from compare.show.side_by_side import side_by_side

    def read(path: Path, otherwise: "Beam | None" = None) -> Readings:
        if is_ours(path):
            return Readings.read(path)
        return read_measured(path, beam, column or (), otherwise, direction)

    exact: Any = read(Path(reference)) if job is None else job.solve()
    known = vibrissa_of(exact)
    candidates = {name: read(path, known) for name, path in distinct_names(files).items()}
    with waiting("comparing"):
        found = side_by_side(exact, candidates)
    with output_folder(out or Path("results") / "side-by-side") as folder:
        from compare.commands.keep import keep
        from compare.show.side_by_side import picture

        for readings in (exact, *candidates.values()):
            terminal.note_rows(readings)
        terminal.print_side_by_side(found)
        keep(folder / "side-by-side.json", found.to_dict())
        keep(folder / "side-by-side.png", picture(found))
    return AGREES if all(one.agrees for one in found.against.values()) else DISAGREES


def _job(reference: str) -> "AnyJob | None":
    """The case of that name; None if it is a file of readings."""
    if Path(reference).suffix.lower() in TABLES:
        return None
    from compare.read.case import load_case

    return load_case(reference)


def _kind(job: "AnyJob | None", stored: list[Path], candidates: list[Path]) -> str:
    """Whether the sweeps are in space, and of how many candidates."""
    in_space = job is not None and job.kind == SPACE
    if stored:
        require_readings(stored)
        from compare.read.space_readings import is_spatial

        in_space = is_spatial(stored[0])
    if in_space and len(candidates) > 1:
        raise InputError(
            "CANDIDATE", ", ".join(map(str, candidates)), "one file in space", "compare one by one"
        )
    return SPACE if in_space else ONE if len(candidates) == 1 else SEVERAL


def _uncertain(file: Path) -> "Job":
    """The case whose inputs are uncertain, of a reference that is a file."""
    from compare.read.case import load_job

    found = load_job(file)
    if found.uncertainties is None:
        raise InputError("--uncertainty", file, "a case file with [uncertainty]", "add the table")
    return found


def _budget(file: Path) -> "Budget":
    from compare.explain.budget import Budget
    from compare.read.run_folder import read_stored

    return read_stored(file, Budget)
