"""The page of whatever a folder holds: a run, a study, or many runs."""

import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

from analytic.problem.files import as_path
from compare.comparison import Comparison, SpatialComparison, compare
from compare.read.run_folder import read_run
from compare.show.document import Film
from compare.show.page import write_all
from compare.show.report import write_report as write_page
from compare.show.runs import runs_document
from compare.study.show.study_report import write_report as write_study_report


@dataclass(frozen=True)
class Report:
    """A page that was written.

    Attributes
    ----------
    path : Path
        The page.
    comparison : Comparison or SpatialComparison or None
        What it is about, if that is a run.
    """

    path: Path
    comparison: Comparison | SpatialComparison | None = None


def write_report(
    folder: str | Path, out: str | Path | None = None, warn: Callable[[str], None] = warnings.warn
) -> Report:
    """Write the page of a run, a study, or a folder with runs in it, from what is stored there.

    A run may be two sweeps that nobody compared yet, and a study may be under way.

    Parameters
    ----------
    folder : str or Path
        What ``vibrissa run`` or ``vibrissa study`` has made, or a folder of such folders.
    out : str or Path, optional
        Where the page and its files are put, by default `folder`.
    warn : callable
        Called with each line on what of a study cannot be read.

    Returns
    -------
    Report
        Its page is ``report.html``.

    Raises
    ------
    InputError
        If the folder holds none of these, or a file in it is damaged.
    """
    folder = as_path(folder, "folder")
    place = folder if out is None else as_path(out, "out")
    if (folder / "study.json").exists():
        return Report(write_study_report(folder, warn, place))
    if not any(folder.glob("*.parquet")):
        return Report(write_all(place, {"report.html": runs_document(folder)})[-1])
    stored, film = read_run(folder), Film.of(folder)
    found = compare(stored.reference, stored.candidate, stored.tolerances, frame=stored.frame)
    if isinstance(found, Comparison):
        found = replace(found, validation=stored.validation)
    return Report(write_page(found, place, stored.budget, film, stored.body), found)
