"""The parts of a document as a terminal shows them; pictures it does not."""

from collections.abc import Sequence

from rich import box
from rich.console import JustifyMethod
from rich.table import Column
from rich.table import Table as RichTable
from rich.text import Text as RichText

from compare.commands.terminal.console import console, print_line
from compare.show.document import Block, Items, Table, Text, Verdict

_LONGEST = 24  # characters that are never folded


def show(*blocks: Block) -> None:
    """Print what has words or numbers in it."""
    for block in blocks:
        match block:
            case Text():
                print_line(" ".join(filter(None, (block.strong, block.said))))
            case Items():
                _list(block.said)
            case Table():
                console().print(_table(block))
            case Verdict():
                _verdict(block)


def _verdict(found: Verdict) -> None:
    claim = RichText(found.claim, style="green" if found.good else "red")
    console().print(claim.append(f" {found.said}", style="default"), soft_wrap=True)
    if found.why:
        print_line(found.why)
    _list([*found.failures, *found.remarks])


def _list(lines: Sequence[str]) -> None:
    for line in lines:
        print_line(f"  {line}")


def _table(found: Table) -> RichTable:
    cells = list(zip(*found.rows, strict=True)) or [() for _ in found.head]
    heads = found.head or [""] * len(cells)
    table = RichTable(
        *(_column(*one, i in found.words) for i, one in enumerate(zip(heads, cells, strict=True))),
        title=RichText(found.caption) if found.caption else None,
        title_justify="left",
        box=box.SIMPLE_HEAD,
        padding=(0, 1, 0, 0),
        show_header=bool(found.head),
    )
    for number, row in enumerate(found.rows):
        ends = number + 1 in found.whole or number in found.whole
        style = "bold" if number in found.blamed else None
        table.add_row(*(RichText(text) for text in row), style=style, end_section=ends)
    return table


def _column(head: str, cells: Sequence[str], in_words: bool) -> Column:
    """A column: a narrow terminal folds words and heads, and cuts no number."""
    parts = [word for cell in cells for word in cell.split()] if in_words else [*cells]
    least = min(max(map(len, [*parts, *head.split()]), default=0), _LONGEST)
    justify: JustifyMethod = "left" if in_words else "right"
    return Column(RichText(head), min_width=least, justify=justify, overflow="fold")
