"""The page and its pictures."""

import io
import re
from collections.abc import Sequence
from itertools import groupby
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
from markupsafe import Markup
from PIL import Image

from analytic import CLAMP_READINGS, PHASES, InputError, Readings
from analytic.problem.files import write_whole
from compare.explain.budget import UNRESOLVED
from compare.sense.accuracy import phase_table
from compare.sense.transitions import TRANSITIONS
from compare.show.findings.engines import EnginesRecord, read_engines, split_overview
from compare.show.findings.methods import MethodsRecord, method_sentences, read_methods
from compare.show.findings.records import RunRecord, read_records
from compare.show.findings.sentences import overview, sentences
from compare.show.page import render

_MARK = "<!-- Written by `vibrissa report`"
_PICTURE = re.compile(r"\]\(((?:budget|methods-on)-[^()/\\\s]+\.png)\)$", re.MULTILINE)
_COLOURS = 48  # that a picture keeps, which makes it a third as large


def write_findings(folder: Path, out: Path) -> list[Path]:
    """Write ``README.md`` and its pictures into `out`, from the runs in the folders of `folder`.

    What an earlier call has written there is replaced, its pictures of runs that are gone are
    removed, and nothing else is touched.
    """
    own = _written_before(out)
    runs = read_records(folder)
    pictures = {
        f"budget-{run.folder.name}.png": run.folder / "budget.png"
        for run in runs
        if run.budget is not None
    }
    methods, engines = read_methods(folder), read_engines(folder)
    if not runs and not engines:
        raise InputError(
            "DIR",
            folder,
            "a folder with runs in it",
            "make one: vibrissa run CASE --budget --out DIR/CASE",
        )
    pictures |= {f"methods-on-{one.case}.png": one.folder / "methods.png" for one in methods}
    for name in pictures:
        if name not in own and (out / name).exists():
            raise _of_another(out / name)
    judged = phase_table(_recorded(runs)).to_dict("records") if runs else []
    contents = {
        "README.md": page(runs, judged, methods, engines).encode(errors="replace"),
        **{name: _smaller(file) for name, file in pictures.items()},
    }
    out.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(out / name, content)
    for name in own - set(contents):
        (out / name).unlink(missing_ok=True)
    return [out / name for name in contents]


def page(
    runs: list[RunRecord],
    judged: list[dict[Any, Any]],
    methods: Sequence[MethodsRecord] = (),
    engines: Sequence[EnginesRecord] = (),
) -> str:
    """The findings as a page."""
    return render(
        "compare.show",
        "findings.md.j2",
        runs=runs,
        cases={case: list(group) for case, group in groupby(runs, key=lambda run: run.case)},
        judged=judged,
        readings=CLAMP_READINGS,
        phases=PHASES,
        mark=Markup(_MARK),
        worst=_worst_transition,
        unresolved=UNRESOLVED,
        overview=overview(runs) if runs else "",
        sentences=sentences,
        methods=methods,
        method_sentences=method_sentences,
        engines=engines,
        split_overview=split_overview(list(engines)) if engines else "",
    )


def _written_before(out: Path) -> set[str]:
    """Names of the files in `out` that an earlier call has written: its page names its pictures."""
    page = out / "README.md"
    try:
        text = page.read_text(encoding="utf-8")
    except FileNotFoundError:
        return set()
    except (OSError, ValueError):
        raise _of_another(page) from None
    if not text.startswith(_MARK):
        raise _of_another(page)
    return {"README.md", *map(unquote, _PICTURE.findall(text))}


def _of_another(file: Path) -> InputError:
    return InputError(
        "--out", file, "a folder without files of that name, or with earlier findings",
        "move the file, or choose another folder with --out",
    )  # fmt: skip


def _recorded(runs: list[RunRecord]) -> dict[str, list[Readings]]:
    """By case, the readings of its first run that has left them."""
    found: dict[str, list[Readings]] = {}
    for run in runs:
        name = f"mujoco-{run.beam}.parquet"
        if run.case in found or name not in {file.name for file in run.folder.iterdir()}:
            continue
        readings = Readings.read(run.folder / name)
        if "phase" in readings.table:
            found[run.case] = [readings]
    return found


def _worst_transition(row: dict[str, Any]) -> float:
    """How many stations the worst transition of a row of the phase table lies off."""
    return float(np.nanmax([row[name] for name in TRANSITIONS]))


def _smaller(picture: Path) -> bytes:
    try:
        with Image.open(picture) as image:
            few = image.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    except (OSError, ValueError, Image.DecompressionBombError) as error:
        raise InputError(
            f"picture {picture}",
            "missing or damaged",
            "as a run with --budget writes it",
            "run it again, or remove its folder",
        ) from error
    buffer = io.BytesIO()
    few.save(buffer, "PNG", optimize=True)
    return buffer.getvalue()
