"""Commands on files of readings: ``compare``, ``reconstruct``, ``side-by-side``."""

import os
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from analytic.problem.errors import InputError
from compare.commands.given import require_readings
from compare.commands.options import (
    AGREES,
    DISAGREES,
    BeamFile,
    Columns,
    InFrame,
    Way,
    number_or_auto,
    out_folder,
)
from compare.commands.output import distinct_name, output_folder
from compare.commands.waiting import waiting
from compare.read.suffixes import TABLES

if TYPE_CHECKING:
    from analytic import Readings
    from compare.read.case import Job


def compare(
    reference: Annotated[
        str, typer.Argument(help="A case, for its closed form, or a file of readings.")
    ],
    candidate: Annotated[Path, typer.Argument(help="Readings to compare with them.")],
    out: Annotated[Path | None, out_folder("results/REFERENCE-CANDIDATE")] = None,
    column: Columns = None,
    beam: BeamFile = None,
    reference_column: Annotated[
        list[str] | None,
        typer.Option(metavar="NAME=COLUMN[:UNIT]", help="As --column, for the reference."),
    ] = None,
    reference_beam: Annotated[
        Path | None, typer.Option(metavar="FILE", help="As --beam, for the reference.")
    ] = None,
    offset: Annotated[
        str,
        typer.Option(
            metavar="NUMBER|auto",
            help="By how much the candidate's foot_x exceeds the reference's; auto: estimate it.",
        ),
    ] = "0",
    noise: Annotated[
        str,
        typer.Option(
            metavar="NUMBER|auto",
            help="Noise of the clamp readings over their largest magnitude, as 0.01, by which the "
            "limits are widened; auto: estimate it.",
        ),
    ] = "0",
    direction: Way = None,
    tolerances: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="TOML file whose [tolerances] table has the limits."),
    ] = None,
    uncertainty: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE",
            help="Case file whose [uncertainty] table holds for a reference that is a file.",
        ),
    ] = None,
    budget: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="budget.json of that reference, for its numerics."),
    ] = None,
    frame: InFrame = "world",
) -> int:
    """Compare a file of readings, of an engine or a rig, with another or with a case's closed form.

    The limits are those of --tolerances, else the case's. Sweeps in space are compared if the
    reference is one: a case file with [body], or readings of `vibrissa space`.
    """
    if _in_space(reference):
        given = {
            "--offset": offset != "0",
            "--beam": beam,
            "--reference-column": reference_column,
            "--reference-beam": reference_beam,
            "--direction": direction,
            "--uncertainty": uncertainty,
            "--budget": budget,
        }
        for option in (name for name, value in given.items() if value):
            raise InputError(option, "given", "for sweeps in the plane only", "leave it out")
        require_readings([candidate])
        from compare.commands.space import compare_in_space

        return compare_in_space(
            reference, candidate, out, column, frame, tolerances, number_or_auto("--noise", noise)
        )
    if frame != "world":
        raise InputError("--frame", frame, "for sweeps in space only", "leave it out")
    given_offset, given_noise = (
        number_or_auto("--offset", offset),
        number_or_auto("--noise", noise),
    )
    with waiting("comparing"):
        from compare.judge.tolerances import Tolerances
        from compare.read.limits import read_tolerances

        limits = None if tolerances is None else read_tolerances(tolerances, Tolerances)
        job = _job(reference)
        if job is not None and (reference_column or reference_beam):
            raise InputError(
                "reference",
                repr(reference),
                "a file, beside --reference-...",
                "leave the option out",
            )
        require_readings([candidate] if job is not None else [Path(reference), candidate])
        from analytic import solve_sweep
        from compare.comparison import compare as compare_readings
        from compare.explain.budget import Budget
        from compare.read.assumed import ASSUMED
        from compare.read.rig import read_measured
        from compare.read.run_folder import read_stored

        if job is None:
            path = Path(reference)
            expected = read_measured(path, reference_beam, reference_column or (), None, direction)
        else:
            expected = solve_sweep(job.case)
            limits = limits or job.tolerances
        known = None if ASSUMED in expected.provenance else expected.beam
        measured = read_measured(candidate, beam, column or (), known, direction)
        comparison = compare_readings(
            expected, measured, limits, offset=given_offset, noise=given_noise
        )
        known_job = _uncertain(job, uncertainty)
        if known_job is not None and known_job.uncertainties is not None:
            numerics = None if budget is None else read_stored(budget, Budget)
            comparison = comparison.validated(
                known_job.case, known_job.uncertainties, budget=numerics
            )
        elif budget is not None:
            raise InputError(
                "--budget", budget, "beside uncertainties", "add --uncertainty CASE.toml"
            )
        called = distinct_name(Path(reference)) if job is None else job.case.name
        default = Path("results") / f"{called}-{distinct_name(candidate)}"
        with output_folder(out or default) as folder:
            from compare.show.report import write_report

            report = write_report(comparison, folder)
    from compare.commands import terminal

    terminal.note_rows(expected)
    terminal.note_rows(measured)
    terminal.print_comparison(comparison)
    terminal.print_written(report)
    return AGREES if comparison.agrees else DISAGREES


def reconstruct(
    file: Annotated[Path, typer.Argument(help="Readings, Parquet or CSV.")],
    out: Annotated[Path | None, out_folder("results/FILE-reconstructed")] = None,
    beam: BeamFile = None,
    column: Columns = None,
    direction: Way = None,
    noise: Annotated[
        float | None,
        typer.Option(
            metavar="NUMBER",
            help="Noise of the clamp readings over their largest magnitude, as 0.01.",
        ),
    ] = None,
    offset: Annotated[
        float,
        typer.Option(
            metavar="NUMBER",
            help="By how much foot_x is too large, as `compare --offset auto` finds it; in the "
            "vibrissa's unit of length, metres beside units.",
        ),
    ] = 0.0,
    friction: Annotated[
        str | None,
        typer.Option(
            metavar="NUMBER|auto",
            help="Friction coefficient of the sweep; auto: estimate it from Phase B.",
            show_default="the file's, or that of --beam",
        ),
    ] = None,
    method: Annotated[
        str,
        typer.Option(metavar="A,B,...", help="Which methods; `vibrissa methods` compares them."),
    ] = "elastica",
) -> int:
    """Find the object from the clamp readings alone."""
    require_readings([file])
    import numpy as np

    from analytic import CLAMP_READINGS, relative_noise, require_beam
    from analytic import reconstruct as reconstruct_contour
    from analytic.from_clamp.reconstruct import doubt
    from compare.align.offset import checked_offset, without_offset
    from compare.commands import terminal
    from compare.read.rig import read_measured
    from compare.sense.record import without_dropouts

    readings = without_dropouts(read_measured(file, beam, column or (), direction=direction))
    if offset:
        readings = without_offset(readings, checked_offset(offset))
    known = {
        name: np.where(readings.trusted, readings.values(name), np.nan) for name in CLAMP_READINGS
    }
    readings = replace(readings, table=readings.table.assign(**known))
    level = None if noise is None else relative_noise(readings, noise)
    if friction is not None:
        readings = _rubbing(readings, number_or_auto("--friction", friction), level)
    methods = [name.strip() for name in method.split(",")]
    contacts = {name: reconstruct_contour(readings, level, method=name) for name in methods}
    if "elastica" in contacts:
        require_beam(contacts["elastica"], readings)
    with output_folder(out or Path("results") / f"{distinct_name(file)}-reconstructed") as folder:
        from analytic.problem.files import write_whole
        from compare.show.figures.geometry import reconstruction
        from compare.show.page import save_figure

        terminal.note_rows(readings)
        for name, found in contacts.items():
            points = found.assign(foot_x=readings.values("foot_x"))
            end = "" if name == "elastica" else f"-{name}"
            path = write_whole(folder / f"points{end}.csv", points.to_csv(index=False))
            terminal.print_reconstruction(readings, found, name)
            if name == "elastica" and (why := doubt(found, readings)) is not None:
                terminal.print_line(why)
            terminal.print_written(path)
            with waiting("drawing"):
                picture = reconstruction(readings, found)
                drawn = save_figure(picture, folder / f"reconstruction{end}.png")
            terminal.print_written(drawn)
    return AGREES


def _rubbing(
    readings: "Readings", friction: float | Literal["auto"], noise: Mapping[str, float] | None
) -> "Readings":
    from analytic import estimate_friction
    from analytic.problem.support import check_support
    from compare.commands import terminal

    if friction == "auto":
        found = estimate_friction(readings, noise)
        terminal.print_line(
            f"friction coefficient {found.coefficient:.4f} +- {found.uncertainty:.1g}, "
            f"from {found.stations} stations of Phase B"
        )
        friction = found.coefficient
    check_support(readings.support[0], friction, readings.beam, signed=True)
    return readings.with_friction(friction)


def side_by_side(
    reference: Annotated[
        str, typer.Argument(help="A case, for its closed form, or a file of readings.")
    ],
    files: Annotated[list[Path], typer.Argument(help="Readings to compare with it.")],
    out: Annotated[Path | None, out_folder("results/side-by-side")] = None,
    column: Columns = None,
    beam: BeamFile = None,
    direction: Way = None,
) -> int:
    """Compare many files of readings with one reference.

    --column, --beam and --direction hold for the files of rigs, not for those of engines.
    """
    if len({path.absolute() for path in files}) < len(files):
        raise InputError(
            "FILE", ", ".join(map(str, files)), "each file once", "leave the second one out"
        )
    job = _job(reference)
    require_readings(files if job is not None else [Path(reference), *files])
    from analytic import Beam, Readings, solve_sweep
    from analytic.problem.readings_file import is_ours
    from compare.commands import terminal
    from compare.read.assumed import ASSUMED
    from compare.read.rig import read_measured
    from compare.show.side_by_side import side_by_side as compare_all

    def read(path: Path, otherwise: Beam | None = None) -> Readings:
        if is_ours(path):
            return Readings.read(path)
        return read_measured(path, beam, column or (), otherwise, direction)

    exact = read(Path(reference)) if job is None else solve_sweep(job.case)
    known = None if ASSUMED in exact.provenance else exact.beam
    candidates = {name: read(path, known) for name, path in _short(files).items()}
    with waiting("comparing"):
        found = compare_all(exact, candidates)
    with output_folder(out or Path("results") / "side-by-side") as folder:
        from analytic.problem.files import write_whole
        from compare.show.page import document, save_figure
        from compare.show.side_by_side import picture

        path = write_whole(folder / "side-by-side.json", document(found.to_dict()))
        for readings in (exact, *candidates.values()):
            terminal.note_rows(readings)
        terminal.print_side_by_side(found)
        terminal.print_written(path)
        terminal.print_written(save_figure(picture(found), folder / "side-by-side.png"))
    return AGREES if all(one.agrees for one in found.against.values()) else DISAGREES


def _in_space(reference: str) -> bool:
    """Whether a reference is a case or a sweep in space."""
    path = Path(reference)
    if path.suffix.lower() in TABLES:
        require_readings([path])
        from compare.read.space_readings import is_spatial

        return is_spatial(path)
    if not reference.endswith(".toml"):
        return False
    from compare.read.toml import TomlFile

    return "body" in TomlFile.read(path, "case file").tables


def _job(reference: str) -> "Job | None":
    """The case of that name; None if it is a file of readings."""
    if Path(reference).suffix.lower() in TABLES:
        return None
    from compare.read.case import load_job

    return load_job(reference)


def _uncertain(job: "Job | None", file: Path | None) -> "Job | None":
    """The case whose inputs are uncertain: the reference itself, or that of a reference file."""
    if file is None:
        return job
    from compare.read.case import load_job

    if job is not None:
        raise InputError(
            "--uncertainty", file, "for a reference that is a file", "state it in the case itself"
        )
    found = load_job(str(file))
    if found.uncertainties is None:
        raise InputError("--uncertainty", file, "a case file with [uncertainty]", "add the table")
    return found


def _short(files: list[Path]) -> dict[str, Path]:
    """The files by what distinguishes them from each other."""
    common = os.path.commonpath([path.absolute().parent for path in files])
    named = {str(path.absolute().with_suffix("").relative_to(common)): path for path in files}
    if len(named) < len(files):  # one.csv and one.parquet
        return {str(path.absolute().relative_to(common)): path for path in files}
    return named
