"""The command ``calibrate``: what a vibrissa is, from a sweep past an object that is known."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands import options as opt
from compare.commands.output import check_own, distinct_name, output_folder, waiting

if TYPE_CHECKING:
    from analytic import Case, Readings

KNOWN = "a sweep past a known object"


def calibrate(
    context: typer.Context,
    files: Annotated[
        list[Path],
        typer.Argument(
            metavar="FILE...",
            help="Passes past a known object, Parquet or CSV, or a folder that `rig` wrote.",
        ),
    ],
    case: opt.CaseName,
    fit: Annotated[
        str,
        opt.option(
            "What is unknown: flexural_rigidity, length, clamp_stiffness, clamp_angle, "
            "natural_curvature, tip_radius, friction, offset (of foot_x), lag (of the readings "
            "behind it).",
            "A,B,...",
        ),
    ] = "flexural_rigidity",
    out: Annotated[Path | None, opt.out_folder("results/FILE-calibrated")] = None,
    column: opt.Columns = None,
    direction: Annotated[opt.Way, opt.For((KNOWN,), (opt.A_RIG,))] = None,
    noise: Annotated[
        str,
        opt.option(
            "Of the clamp readings over their largest magnitude, as 0.01; auto: what they show.",
            "NUMBER|auto",
        ),
    ] = "auto",
) -> bool:
    """Find what is unknown of a vibrissa, past a known object.

    The case has the object, and all that is known of vibrissa, clamp and friction. Several passes
    are pooled. What is found becomes a case, too, DIR/case.toml. Exit code 1: the fit leaves more
    than the noise, or passes do not say the same.
    """
    level = opt.number_or_auto("--noise", noise)
    first, files = files[0], opt.pass_files(files)
    opt.require_use(context, KNOWN, *([opt.A_RIG] if opt.from_rigs(files) or column else []))
    from analytic import calibrate as calibrate_case
    from analytic import relative_noise
    from analytic.from_clamp.calibration.calibrate import doubt_of_case
    from analytic.from_clamp.calibration.unknowns import LAG
    from compare.commands import terminal
    from compare.commands.sweeping import RigFiles, note_rows
    from compare.read.case import case_tables, load_job
    from compare.sense.record import without_dropouts
    from compare.show.case_file import CASE_MARK, calibrated_case
    from compare.show.fits import calibration_document, calibration_summary
    from compare.show.passes import lag_remembered

    known = load_job(case).case
    rig = RigFiles(column or (), None, direction, "world")
    passes = [without_dropouts(one) for one in rig.read_all(files, known.beam)]
    with waiting("fitting"):
        sizes = None if level == "auto" else relative_noise(passes, level)
        found = calibrate_case(passes, known, opt.words(fit), sizes)
    with output_folder(out or Path("results") / f"{distinct_name(first)}-calibrated") as folder:
        check_own(folder / "case.toml", CASE_MARK)
        for one in passes:
            note_rows(one)
        if LAG not in found.found and (said := lag_remembered(passes)) is not None:
            terminal.print_line(f"{said}: fit lag too, or correct the case")
        terminal.show(*calibration_summary(found))
        for line in [] if found.explains else _one_more(passes, known, [*found.found], sizes):
            terminal.print_line(line)
        if not found.explains and (why := doubt_of_case(passes[0], known)) is not None:
            terminal.print_line(str(why))
        terminal.keep(folder / "calibration.json", calibration_document(found))
        text = calibrated_case(*case_tables(case), found, known.beam)
        terminal.keep(folder / "case.toml", text)
        off, shift = found.found.get("offset"), ""
        if off is not None and not off.lowest <= 0 <= off.highest:
            shift = f" --offset {off.value:.4g}"
        made = folder / "case.toml"
        both = len({one.runs_right for one in passes}) > 1
        way = f" --direction {direction or 'left'}" if both or direction else ""
        place = " --offset auto" if LAG in found.found else shift  # one way, a lag is an offset
        seen = f"--beam {made}{place} --noise {noise}{way}"
        terminal.print_line(f"Next: vibrissa compare {made} {first} {seen}")
        if found.explains:
            of = f"vibrissa reconstruct FILE... --beam {made}{shift}"
            terminal.print_line(f"  of unknown objects with this vibrissa: {of}")
    return found.explains


def _one_more(
    passes: "list[Readings]", known: "Case", names: list[str], noise: Mapping[str, float] | None
) -> Iterator[str]:
    """The unknowns of which each, fitted too, leaves no more than the noise."""
    from analytic import calibrate as calibrate_case
    from analytic.from_clamp.calibration.unknowns import UNKNOWNS

    for name in sorted(UNKNOWNS.keys() - names):
        try:
            with waiting(f"fitting {name} too"):
                found = calibrate_case(passes, known, [*names, name], noise)
        except InputError:
            continue
        if found.explains:
            also = ",".join([*names, name])
            yield f"fitted too, {name} {found.found[name]} explains the readings: --fit {also}"
