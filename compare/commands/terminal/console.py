"""Where the command line prints: standard output, with progress beside it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    TextColumn,
    TimeRemainingColumn,
)
from rich.text import Text


def print_line(text: str) -> None:
    """Print a line as it is: no markup, no folding."""
    console().print(text, soft_wrap=True, markup=False)


def print_written(path: Path) -> None:
    """Print which file there is now."""
    print_line(f"wrote {path}")


@contextmanager
def progress(what: str, total: int) -> Iterator[Callable[[], None]]:
    """Show a bar with the remaining time on a terminal, nothing elsewhere."""
    console = Console(stderr=True, highlight=False)
    columns = (
        TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    )  # fmt: skip
    with Progress(
        *columns, console=console, disable=not console.is_terminal, transient=True
    ) as bar:
        task = bar.add_task(Text(what).markup, total=total)
        yield lambda: bar.advance(task)


def console() -> Console:
    """Standard output, as it is now: tests and notebooks replace it."""
    return Console(highlight=False)
