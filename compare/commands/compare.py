"""The command ``compare``: files of readings against another or against a case's closed form."""

import sys
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file
from compare.commands import options as opt
from compare.commands.output import distinct_name, waiting
from compare.read.case import load_case
from compare.read.job import AnyJob
from compare.read.kinds import SPACE, TABLES

ONE, SEVERAL = "two sweeps in the plane", "several candidates in the plane"
_STORED = "a reference that is a file"


def compare(
    context: typer.Context,
    reference: Annotated[
        str, typer.Argument(help="A case, for its closed form, or a file of readings.")
    ],
    candidates: Annotated[
        list[Path],
        typer.Argument(
            metavar="CANDIDATE...",
            help="Readings to compare with it, or a folder that `rig` wrote.",
        ),
    ],
    out: Annotated[
        Path | None, opt.out_folder("results/REFERENCE-CANDIDATE, of several results/side-by-side")
    ] = None,
    column: Annotated[opt.Columns, opt.For((ONE, SPACE)), opt.For((SEVERAL,), (opt.A_RIG,))] = None,
    beam: Annotated[opt.BeamFile, opt.For((ONE,)), opt.For((SEVERAL,), (opt.A_RIG,))] = None,
    reference_column: Annotated[
        list[str] | None,
        opt.option("As --column, for the reference.", "NAME=COLUMN[:UNIT]"),
        opt.For((ONE,), (_STORED,)),
    ] = None,
    reference_beam: Annotated[
        Path | None,
        opt.option("As --beam, for the reference.", "FILE"),
        opt.For((ONE,), (_STORED,)),
    ] = None,
    offset: Annotated[
        str,
        opt.option(
            "Of the candidate's foot_x from the reference's; auto: estimate it.", "NUMBER|auto"
        ),
        opt.For((ONE,)),
    ] = "0",
    noise: Annotated[
        str,
        opt.option(
            "Of the clamp readings over their largest magnitude, as 0.01: the limits are widened "
            "by it; auto: estimate it.",
            "NUMBER|auto",
        ),
        opt.For((ONE, SPACE)),
    ] = "0",
    direction: Annotated[opt.Way, opt.For((ONE, SEVERAL), (opt.A_RIG,))] = None,
    tolerances: Annotated[
        Path | None,
        opt.option("TOML file whose [tolerances] are the limits.", "FILE"),
        opt.For((ONE, SPACE)),
    ] = None,
    uncertainty: Annotated[
        Path | None,
        opt.option("Case file whose [uncertainty] holds for a reference that is a file.", "FILE"),
        opt.For((ONE,), (_STORED,)),
    ] = None,
    budget: Annotated[
        Path | None,
        opt.option("budget.json of that reference, for its numerics.", "FILE"),
        opt.For((ONE,)),
    ] = None,
    frame: Annotated[opt.InFrame, opt.For((SPACE,))] = "world",
) -> bool:
    """Compare readings with others or with a closed form.

    The limits are those of --tolerances, else the case's. The sweeps are in space if the reference
    is: a case file with [body], or readings of such a case. Several files, of engines or rigs, are
    compared with the reference and with each other; there --column, --beam and --direction hold for
    those of rigs. Passes that `rig` wrote are compared as one: their mean, with their scatter.
    """
    job = None if Path(reference).suffix.lower() in TABLES else load_case(reference)
    stored = [regular_file(reference, "readings file", sys.maxsize)] if job is None else []
    first, candidates = candidates[0], opt.pass_files(candidates)
    passes = len(candidates) > 1 and opt.are_passes(candidates)
    kind = _kind(job, stored, candidates[:1] if passes else candidates)
    raw = kind == ONE and bool(column or reference_column)  # then our files are read as a rig's
    rigs = raw or passes or not opt.no_rigs([*stored, *candidates])
    opt.require_use(context, kind, *([_STORED] if stored else []), *([opt.A_RIG] if rigs else []))
    numbers = opt.number_or_auto("--offset", offset), opt.number_or_auto("--noise", noise)
    with waiting("comparing"):
        from compare.commands import comparing

        rig = comparing.RigFiles(column or (), beam, direction, frame)
        if kind == SEVERAL:
            place = out or Path("results") / "side-by-side"
            return comparing.side_by_side(job, Path(reference), candidates, rig, place)
        if job is not None:
            job = comparing.turned(job, candidates if passes else [], rig)
        other = replace(rig, columns=reference_column or (), beam=reference_beam)
        expected = comparing.expected(job, Path(reference), kind == SPACE, other)
        repeated = comparing.mean_of(candidates, expected, rig) if passes else None
        measured = repeated.mean if repeated else comparing.measured(candidates[0], expected, rig)
        found = comparing.compared(expected, measured, job, tolerances, numbers, frame)
        if budget is not None or uncertainty is not None or job is not None:
            found = comparing.validated(found, job, uncertainty, budget)
    called = distinct_name(Path(reference)) if job is None else job.case.name
    default = Path("results") / f"{called}-{distinct_name(first)}"
    body = None if job is None else job.body
    return comparing.keep_comparison(found, out or default, body, repeated)


def _kind(job: AnyJob | None, stored: list[Path], candidates: list[Path]) -> str:
    in_space = job is not None and job.kind == SPACE
    if stored:
        from compare.read.space_readings import is_spatial

        in_space = is_spatial(stored[0])
    if in_space and len(candidates) > 1:
        given = ", ".join(map(str, candidates))
        raise InputError("CANDIDATE", given, "one file in space", "compare one by one")
    return SPACE if in_space else ONE if len(candidates) == 1 else SEVERAL
