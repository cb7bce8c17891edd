"""The findings: ``python -m docs.figures.findings RUNS DIR`` writes ``DIR/README.md``.

The page of a folder of runs (`vibrissa report`) in Markdown, and what only our own runs are asked:
which method finds the contact on which readings.
"""

import io
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from PIL import Image as Pixels

from analytic import InputError
from analytic.problem.files import write_whole
from compare.show.document import Block, Document, Image, Section, Text
from compare.show.runs import runs_document
from docs.figures.markdown import markdown
from docs.figures.methods_record import MethodsRecord, method_sentences, read_methods

_MARK = "<!-- Written by `make results`: edits would be lost. -->\n"
_COLOURS = 48  # that a picture keeps, which makes it a third as large


def write_findings(folder: Path, out: Path) -> list[Path]:
    """Write the page, and its pictures beside it."""
    document, pictures = _beside(findings(folder))
    contents = {name: _smaller(file) for name, file in pictures.items()}
    for one in read_methods(folder):
        contents[f"methods-on-{one.case}.csv"] = _table(one)
    out.mkdir(parents=True, exist_ok=True)
    page = write_whole(out / "README.md", (_MARK + markdown(document)).encode(errors="replace"))
    return [page, *(write_whole(out / name, content) for name, content in contents.items())]


def findings(folder: Path) -> Document:
    """What the runs in the folders of `folder` come to."""
    found = runs_document(folder)
    *runs, made = found.sections
    return replace(found, sections=[*runs, *_methods(read_methods(folder)), made])


def _methods(records: list[MethodsRecord]) -> Iterator[Section]:
    if not records:
        return
    blocks: list[Block] = [
        Text(
            "Each method takes the vibrissa for straight, its clamp for rigid and the object for "
            "frictionless. exact: so it is; curved: natural curvature -0.2/L; tapered: a tip of "
            "0.8 of the radius; soft-clamp: a clamp of stiffness 10 EI/L; friction: 0.2; mujoco: "
            "readings of MuJoCo. All numbers are beside each picture, as a table (.csv)."
        )
    ]
    for i, one in enumerate(records):
        shows = f"What each method survives on readings of the case {one.case}"
        blocks += [
            *([] if i else [Text(method_sentences(one), strong=f"{one.case}.")]),
            Image(one.folder / "methods.png", shows, one.case),
        ]
    yield Section("methods", "Methods to find the contact", blocks)


def _table(one: MethodsRecord) -> bytes:
    return one.table.to_csv(index=False, float_format="%.3g").encode()


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
        replace(section, blocks=[placed(block) for block in section.blocks if not _one_more(block)])
        for section in document.sections
    ]
    return replace(document, sections=sections), pictures


def _one_more(block: Block) -> bool:
    """Whether it is the budget of another beam than the chain, which looks alike."""
    return isinstance(block, Image) and block.file.stem == "budget" and "chain" not in block.shows


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
