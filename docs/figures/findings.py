"""The findings: ``python -m docs.figures.findings RUNS DIR`` writes ``DIR/README.md``.

The page of a folder of runs (`vibrissa report`) in Markdown, and what only our own runs are asked:
how well phases are judged from noisy readings, and which method finds the contact on which.
"""

import io
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image as Pixels

from analytic import PHASES, InputError, Readings
from analytic.problem.files import write_whole
from compare.read.runs import read_runs
from compare.sense.transitions import TRANSITIONS
from compare.show.document import Block, Document, Image, Section, Table, Text
from compare.show.numbers import percent
from compare.show.runs import runs_document
from docs.figures.markdown import markdown
from docs.figures.methods_record import MethodsRecord, method_sentences, read_methods
from docs.figures.phase_accuracy import phase_table

_MARK = "<!-- Written by `make results`: edits would be lost. -->\n"
_COLOURS = 48  # that a picture keeps, which makes it a third as large


def write_findings(folder: Path, out: Path) -> list[Path]:
    """Write the page, and its pictures beside it."""
    document, pictures = _beside(findings(folder))
    contents = {name: _smaller(file) for name, file in pictures.items()}
    out.mkdir(parents=True, exist_ok=True)
    page = write_whole(out / "README.md", (_MARK + markdown(document)).encode(errors="replace"))
    return [page, *(write_whole(out / name, content) for name, content in contents.items())]


def findings(folder: Path) -> Document:
    """What the runs in the folders of `folder` come to."""
    found = runs_document(folder)
    *runs, made = found.sections
    more = [*_judged(folder), *_methods(read_methods(folder))]
    return replace(found, sections=[*runs, *more, made])


def _judged(folder: Path) -> Iterator[Section]:
    """Phases judged from noisy readings, of the first run of each case that has left its own."""
    recorded: dict[str, list[Readings]] = {}
    for run in read_runs(folder):
        file = run.folder / f"mujoco-{run.beam}.parquet"
        if run.case not in recorded and file in run.folder.iterdir():
            readings = Readings.read(file)
            if "phase" in readings.table:
                recorded[run.case] = [readings]
    if not recorded:
        return
    rows = [
        (
            row["case"],
            f"{100 * row['noise']:g} %",
            *(" / ".join(str(row[f"{true}_as_{judged}"]) for judged in PHASES) for true in PHASES),
            percent(row["right"]),
            f"{np.nanmax([row[name] for name in TRANSITIONS]):.1f}",
            str(row["missed"]),
        )
        for row in phase_table(recorded).to_dict("records")
    ]
    caption = (
        "Stations of each case's first beam above, by contact truth and by the phase (free / A / "
        "B) judged from noisy clamp readings, summed over ten seeds of Gaussian noise in each "
        "reading's largest magnitude. Transitions: how many stations the worst one lies off the "
        "truth, and how many were missed."
    )
    judged = "judged free / A / B"
    head = (
        "case", "noise", f"free {judged}", f"A {judged}", f"B {judged}", "right", "transitions",
        "missed",
    )  # fmt: skip
    yield Section("judged", "Phases judged from the clamp", [Table(caption, head, rows)])


def _methods(records: list[MethodsRecord]) -> Iterator[Section]:
    if not records:
        return
    blocks: list[Block] = [
        Text(
            "Each method gets the same readings and takes the vibrissa for straight, its clamp for "
            "rigid and the object for frictionless. exact: so it is; curved: natural curvature "
            "-0.2/L; tapered: a tip of 0.8 of the radius; soft-clamp: a clamp of stiffness 10 "
            "EI/L; friction: 0.2; mujoco: readings of MuJoCo. Median error of the contact over L, "
            "without noise, by phase; in brackets the share that has an answer, where it is less "
            "than 90 %."
        )
    ]
    for one in records:
        least, *noisy = one.levels
        first = one.readings[0]
        columns = [(readings, least) for readings in one.readings]
        columns += [(first, level) for level in noisy]
        rows = [
            (method, one.needs(method), *(one.cell(method, *column) for column in columns))
            for method in one.methods
        ]
        noises = (f"{first}, {100 * level:g} % noise" for level in noisy)
        head = ("method", "needs", *one.readings, *noises)
        shows = f"What each method survives on readings of the case {one.case}"
        blocks += [
            Text(method_sentences(one), strong=f"{one.case}."),
            Table("", head, rows, words=range(len(head))),
            Image(one.folder / "methods.png", shows, one.case),
        ]
    yield Section("methods", "Methods to find the contact", blocks)


def _beside(document: Document) -> tuple[Document, dict[str, Path]]:
    """The document with its pictures beside it, and where each of them is now."""
    pictures: dict[str, Path] = {}

    def placed(block: Block) -> Block:
        if not isinstance(block, Image):
            return block
        kind, of = block.file.stem, block.file.parent.name
        name = f"{kind}-on-{block.caption}" if kind == "methods" else f"{kind}-{of}"
        pictures[f"{name}.png"] = block.file
        return replace(block, file=Path(f"{name}.png"))

    sections = [
        replace(section, blocks=[placed(block) for block in section.blocks])
        for section in document.sections
    ]
    return replace(document, sections=sections), pictures


def _smaller(picture: Path) -> bytes:
    try:
        with Pixels.open(picture) as image:
            few = image.convert("RGB").quantize(_COLOURS, dither=Pixels.Dither.NONE)
    except (OSError, ValueError, Pixels.DecompressionBombError) as error:
        raise InputError(
            f"picture {picture}",
            "missing or damaged",
            "as a run with --budget writes it",
            "run it again, or remove its folder",
        ) from error
    buffer = io.BytesIO()
    few.save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


if __name__ == "__main__":
    write_findings(Path(sys.argv[1]), Path(sys.argv[2]))
