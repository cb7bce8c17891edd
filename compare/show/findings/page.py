"""The page and its pictures."""

import io
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from analytic import CLAMP_READINGS, PHASES, Readings
from analytic.problem.files import write_whole
from compare.explain.budget import UNRESOLVED
from compare.sense.accuracy import phase_table
from compare.sense.transitions import TRANSITIONS
from compare.show.findings.records import RunRecord, read_records
from compare.show.findings.sentences import overview, sentences
from compare.show.page import render

_COLOURS = 48  # that a picture keeps, which makes it a third as large


def write_findings(folder: Path, out: Path) -> list[Path]:
    """Write ``README.md`` and its pictures into `out`, from the runs in the folders of `folder`.

    Pictures in `out` of runs that are no longer there are removed.

    Returns
    -------
    list of Path
        The page, and the pictures.

    Raises
    ------
    InputError
        If there is no run, or what one has left cannot be read.
    """
    runs = read_records(folder)
    judged = phase_table(_recorded(runs)).to_dict("records")
    pictures = {
        f"budget-{run.folder.name}.png": _smaller(run.folder / "budget.png")
        for run in runs
        if run.budget is not None
    }
    contents = {"README.md": page(runs, judged).encode(), **pictures}
    out.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(out / name, content)
    for stale in out.glob("budget-*.png"):
        if stale.name not in contents:
            stale.unlink()
    return [out / name for name in contents]


def page(runs: list[RunRecord], judged: list[dict[Any, Any]]) -> str:
    """The findings in Markdown."""
    return render(
        "compare.show",
        "findings.md.j2",
        runs=runs,
        cases={case: list(group) for case, group in groupby(runs, key=lambda run: run.case)},
        judged=judged,
        readings=CLAMP_READINGS,
        phases=PHASES,
        worst=_worst_transition,
        unresolved=UNRESOLVED,
        overview=overview(runs),
        sentences=sentences,
    )


def _recorded(runs: list[RunRecord]) -> dict[str, list[Readings]]:
    """By case, the readings of its first run that has left them."""
    found: dict[str, list[Readings]] = {}
    for run in runs:
        file = run.folder / f"mujoco-{run.beam}.parquet"
        if run.case not in found and file.exists():
            found[run.case] = [Readings.read(file)]
    return found


def _worst_transition(row: dict[str, Any]) -> float:
    """How many stations the worst transition of a row of the phase table lies off."""
    return float(np.nanmax([row[name] for name in TRANSITIONS]))


def _smaller(picture: Path) -> bytes:
    with Image.open(picture) as image:
        few = image.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    buffer = io.BytesIO()
    few.save(buffer, "PNG", optimize=True)
    return buffer.getvalue()
