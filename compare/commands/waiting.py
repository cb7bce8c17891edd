"""A sign of life while a command loads and computes, before anything else of it is loaded."""

from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def waiting(what: str) -> Iterator[None]:
    """Show on a terminal what is being done, nothing elsewhere, and nothing when it is done."""
    from rich.console import Console  # slow to load, and not every command waits
    from rich.text import Text

    console = Console(stderr=True, highlight=False)
    if not console.is_terminal:
        yield
        return
    with console.status(Text(f"{what} ...")):
        yield
