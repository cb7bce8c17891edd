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
from compare.show.document import Block, Document, Image, Text, sections
from compare.show.runs import runs_document
from docs.figures.markdown import MARK, markdown
from docs.figures.methods_record import MethodsRecord, method_sentences, read_methods

_COLOURS = 48  # that a picture keeps, which makes it a third as large


def write_findings(folder: Path, out: Path) -> list[Path]:
    """Write the page, and its pictures beside it."""
    document, pictures = _beside(findings(folder))
    contents = {name: _smaller(file) for name, file in pictures.items()}
    for one in read_methods(folder):
        contents[f"methods-on-{one.case}.csv"] = _table(one)
    out.mkdir(parents=True, exist_ok=True)
    page = write_whole(out / "README.md", (MARK + markdown(document)).encode(errors="replace"))
    return [page, *(write_whole(out / name, content) for name, content in contents.items())]


def findings(folder: Path) -> Document:
    """What the runs in the folders of `folder` come to."""
    found = runs_document(folder)
    runs, *more = [one for one in found.sections if not one.name.startswith("case-")]
    budgets = [block for one in found.sections for block in one.blocks if _of_the_chain(block)]
    added = sections(
        ("budget", "Budget", budgets[:1]),  # others look alike
        ("methods", "Methods to find the contact", _methods(read_methods(folder))),
    )
    return replace(found, sections=[runs, *added, *more])


def _methods(records: list[MethodsRecord]) -> Iterator[Block]:
    for i, one in enumerate(records):
        if not i:
            yield Text(
                "Each method takes the vibrissa for straight, its clamp for rigid and the object "
                "for frictionless; here are readings of others, too. All numbers are beside each "
                "picture, as a table."
            )
            yield Text(method_sentences(one), strong=f"{one.case}.")
        shows = f"What each method survives on readings of the case {one.case}"
        yield Image(one.folder / "methods.png", shows, one.case)


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

    parts = [
        replace(one, blocks=[placed(block) for block in one.blocks]) for one in document.sections
    ]
    return replace(document, sections=parts), pictures


def _of_the_chain(block: Block) -> bool:
    """Whether it is the picture of a chain's budget."""
    return isinstance(block, Image) and "chain" in block.shows


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
