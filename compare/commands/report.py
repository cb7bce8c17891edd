"""The command ``report``: pages from what is stored of a run, of a study, or of many runs."""

from pathlib import Path
from typing import Annotated

import typer

from analytic.problem.errors import InputError
from compare.commands.options import AGREES, DISAGREES, out_folder
from compare.commands.output import page_folder, waiting, warn

_MAKE = "make one: vibrissa run CASE --out DIR, or vibrissa study FILE --out DIR"


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
    if not any(folder.glob("*.parquet")) and not any(folder.rglob("*.json")):
        raise InputError("DIR", folder, "the folder of a run, a study, or of runs", _MAKE)
    from compare.commands import terminal
    from compare.commands.pipeline import print_comparison
    from compare.report import write_report

    with page_folder(out or folder), waiting("reading"):
        found = write_report(folder, out, warn)
    if found.comparison is not None:
        print_comparison(found.comparison)
    terminal.print_report(found.path)
    return AGREES if found.comparison is None or found.comparison.agrees else DISAGREES
