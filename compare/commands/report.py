"""The command ``report``: pages from what is stored of a run, of a study, or of many runs."""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands.options import AGREES, DISAGREES, out_folder
from compare.commands.output import output_folder
from compare.commands.waiting import waiting

_MAKE = "make one: vibrissa run CASE --out DIR, or vibrissa study FILE --out DIR"
_PLAN = "study.json"  # is in the folder of a study


def report(
    folder: Annotated[
        Path,
        typer.Argument(metavar="DIR", help="Folder of a run or a study, or with folders of runs."),
    ],
    out: Annotated[Path | None, out_folder("DIR")] = None,
) -> int:
    """Write the page of a run, of a study, or of many runs.

    A run may be in the plane or in space, or be two sweeps with one --out that nobody compared yet;
    a study may be under way. The exit code of a run is that of its comparison.
    """
    if not folder.is_dir():
        raise InputError("DIR", folder, "a folder that is there", _MAKE)
    place = out or folder
    if (folder / _PLAN).exists():
        return _of_a_study(folder, place)
    if any(folder.glob("*.parquet")):
        return _of_a_run(folder, place)
    if not any(folder.glob("*/*.json")):
        raise InputError("DIR", folder, "the folder of a run, a study, or of runs", _MAKE)
    from compare.commands import terminal
    from compare.show.findings import write_findings

    with output_folder(place):
        for path in write_findings(folder, place):
            terminal.print_written(path)
    return AGREES


def _of_a_run(folder: Path, place: Path) -> int:
    from compare.read.sweep_files import sweep_files

    reference, candidate = sweep_files(folder)
    from compare.read.run_folder import read_run
    from compare.read.space_readings import is_spatial

    if is_spatial(reference):
        from compare.commands.space_folder import report_in_space

        return report_in_space(folder, reference, candidate, place)
    stored = read_run(folder)
    with output_folder(place):
        from compare.commands import terminal
        from compare.comparison import compare
        from compare.show.report import Film, write_report

        with waiting("comparing"):
            comparison = compare(stored.reference, stored.candidate, stored.tolerances)
            comparison = replace(comparison, validation=stored.validation)
            written = write_report(comparison, place, stored.budget, Film.of(folder))
        terminal.print_comparison(comparison)
        terminal.print_written(written)
    return AGREES if comparison.agrees else DISAGREES


def _of_a_study(folder: Path, place: Path) -> int:
    from compare.commands.study import warn
    from compare.commands.terminal import print_written
    from compare.study.show.study_report import write_report

    with output_folder(place):
        print_written(write_report(folder, warn, place))
    return AGREES
