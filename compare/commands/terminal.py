"""What the command line prints and writes: lines and tables, progress beside them, files.

Lengths are printed in units of the vibrissa's length L, whatever the units of the case.
"""

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console, JustifyMethod
from rich.measure import Measurement
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn
from rich.table import Column
from rich.table import Table as RichTable
from rich.text import Text as RichText

from analytic.problem.files import write_whole
from compare.show.document import Block, Items, Table, Text, Verdict

if TYPE_CHECKING:
    from compare.show.page import Content

_LONGEST = 24  # characters that are never folded
_WIDEST = 1000  # characters of a table


def print_line(text: str) -> None:
    """Print a line as it is: no markup, no folding."""
    console().print(text, soft_wrap=True, markup=False)


def print_written(path: Path) -> None:
    print_line(f"wrote {path}")


def print_report(path: Path, more: str = "") -> None:
    print_written(path)
    print_line(f"Next: open it in a browser{more}.")


@contextmanager
def progress(what: str, total: int | None = None) -> Iterator[Callable[[], None]]:
    """Show a bar on a terminal, with the remaining time if it is known; nothing elsewhere."""
    console = Console(stderr=True, highlight=False)
    if not console.is_terminal:
        yield lambda: None
        return
    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    )  # fmt: skip
    with Progress(*columns, console=console, transient=True) as bar:
        task = bar.add_task(RichText(what).markup, total=total)
        yield lambda: bar.advance(task)


class _Output(Console):
    def on_broken_pipe(self) -> None:
        """Who read has gone, as `head` does: the work goes on, and its exit code is its own."""
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def console() -> Console:
    """Standard output, as it is now: tests and notebooks replace it."""
    return _Output(highlight=False)


def keep(path: Path, content: "Content") -> None:
    if not isinstance(content, str | bytes):
        from compare.show.page import as_file  # slow to load, and a text needs none of it

        content = as_file(content)
    print_written(write_whole(path, content))


def show(*blocks: Block) -> None:
    """Print what has words or numbers in it."""
    for block in blocks:
        match block:
            case Text():
                print_line(" ".join(filter(None, (block.strong, block.said))))
            case Items():
                _list(block.said)
            case Table():
                _print_table(_table(block))
            case Verdict():
                claim = RichText(block.claim, style="green" if block.good else "red")
                console().print(claim.append(f" {block.said}", style="default"), soft_wrap=True)
                if block.why:
                    print_line(block.why)
                _list([*block.failures, *block.remarks])


def _print_table(table: RichTable) -> None:
    """As narrow as it may be; a line that the terminal folds is better than one that is cut."""
    wide = console()

    def sizes() -> Measurement:
        return Measurement.get(wide, wide.options.update(max_width=_WIDEST), table)

    if sizes().minimum >= wide.width:
        table.padding = 0
    if sizes().minimum >= wide.width:
        wide.width = sizes().maximum
    wide.print(table)


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
