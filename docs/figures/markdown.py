"""A document as Markdown, its pictures beside it."""

import re
from collections.abc import Iterator
from urllib.parse import quote

from compare.show.document import (
    Beside,
    Block,
    Document,
    Image,
    Items,
    Table,
    Text,
    Verdict,
)

MARK = "<!-- Written by `make results`: edits would be lost. -->\n"
_MARKS = re.compile(r"[\\`*~$\[\]]|#(?!\d+;)|(?<!\w)_|_(?!\w)")


def markdown(document: Document) -> str:
    """The document as a page."""
    parts = [f"# {plain(document.title)}", plain(document.lead), *_lines(document.verdict)]
    if document.tiles:
        rows = [(one.name, one.value, one.note) for one in document.tiles]
        parts += _lines(Table("", (), rows, words=(0, 2)))
    for section in document.sections:
        parts.append(f"## {plain(section.title)}")
        parts += [part for block in section.blocks for part in _lines(block)]
    return "\n\n".join(filter(None, parts)) + "\n"


def plain(text: object) -> str:
    """Text without what Markdown or HTML would make of it."""
    line = " ".join(str(text).split())
    line = re.sub(r"[&<>|]", lambda mark: f"&#{ord(mark[0])};", line)
    return _MARKS.sub(r"\\\g<0>", line)


def _lines(block: Block) -> Iterator[str]:
    """A block's paragraphs; what only a page in HTML can show has none."""
    match block:
        case Text():
            yield " ".join(filter(None, (_bold(block.strong), plain(block.said))))
        case Items():
            yield "\n".join(f"- {plain(line)}" for line in block.said)
        case Table():
            yield plain(block.caption)
            yield _table(block)
        case Verdict():
            yield f"{_bold(block.claim)} {plain(block.said)}".rstrip()
            yield plain(block.why)
            yield from _lines(Items([*block.failures, *block.remarks]))
        case Image():
            yield f"![{plain(block.shows)}]({quote(block.file.name)})\n*{plain(block.caption)}*"
        case Beside():
            for one in block.blocks:
                yield from _lines(one)


def _bold(text: str) -> str:
    return f"**{plain(text)}**" if text else ""


def _table(table: Table) -> str:
    head = table.head or [""] * len(table.rows[0])
    rule = ["---" if i in table.words else "--:" for i in range(len(head))]
    rows = [[plain(name) for name in head], rule, *([plain(x) for x in row] for row in table.rows)]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)
