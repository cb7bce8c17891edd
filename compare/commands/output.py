"""The folder that a command writes to, signs of life meanwhile, and signals that end it."""

import os
import signal
import sys
import tempfile
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from types import FrameType

import typer

from analytic.problem.errors import InputError
from analytic.problem.files import own_files

_SIGNALS = {"SIGINT": "interrupted", "SIGTERM": "ended by SIGTERM", "SIGHUP": "ended by SIGHUP"}
_LONGEST = 100  # characters of a name
_PAGES = ("report.html", "engines.html", "side-by-side.html", "peers.html")
_OWN_PAGE = "This report"  # the caption of the last table of each page


class Ended(KeyboardInterrupt):
    pass


@contextmanager
def output_folder(folder: Path) -> Iterator[Path]:
    """Make a folder, and see that it can be written to before any work is done.

    What was made and stays empty is removed again. No file of somebody else's is replaced.
    """
    made: list[Path] = []
    try:
        made = [one for one in (folder, *folder.parents) if not one.exists()]
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except (OSError, ValueError) as error:
        _remove_empty(made)
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError(
            "--out", folder, "a folder that can be written to", f"choose another ({reason})"
        ) from error
    try:
        with own_files():
            yield folder
    finally:
        _remove_empty(made)


@contextmanager
def page_folder(folder: Path) -> Iterator[Path]:
    """Make a folder that a page is written to; no page in it may be somebody else's."""
    for name in _PAGES:
        check_own(folder / name, _OWN_PAGE)
    with output_folder(folder):
        yield folder


def check_own(path: Path, mark: str) -> None:
    """Refuse to replace a file that nobody named, unless it has the mark of the command's own."""
    if path.is_file() and mark not in path.read_text(encoding="utf-8", errors="replace"):
        raise InputError("output", path, "free, or from an earlier run", "move it, or name another")


def warn(line: str) -> None:
    """Say something on standard error, after the command's name."""
    typer.echo(f"vibrissa: {line}", err=True)


def distinct_name(path: Path) -> str:
    """What results of a file are called: its name, and the folders on the way to it."""
    absolute, here = path.absolute(), Path.cwd()
    inside = absolute.is_relative_to(here)
    steps = absolute.relative_to(here if inside else absolute.anchor).with_suffix("").parts
    return "-".join(steps[1:] if steps[0] == "results" and len(steps) > 1 else steps)[-_LONGEST:]


def distinct_names(files: list[Path]) -> dict[str, Path]:
    """The files by what distinguishes them from each other."""
    common = os.path.commonpath([path.absolute().parent for path in files])
    named = {str(path.absolute().with_suffix("").relative_to(common)): path for path in files}
    if len(named) < len(files):  # one.csv and one.parquet
        return {str(path.absolute().relative_to(common)): path for path in files}
    return named


@contextmanager
def ended_by_signals() -> Iterator[None]:
    """Let SIGTERM and SIGHUP end the work as Ctrl-C does, so that what there is can be kept.

    Processes that were started for the work end at once. A signal that is ignored, as SIGHUP under
    ``nohup``, stays so; and outside the main thread, where Python allows no handlers, all do.
    Typer would turn an interrupt into an exit code without a word.
    """

    def end(number: int, _: FrameType | None) -> None:
        if "multiprocessing" in sys.modules:  # else nothing was started
            for child in sys.modules["multiprocessing"].active_children():
                child.terminate()
        raise Ended(_SIGNALS[signal.Signals(number).name])

    known = [getattr(signal, name) for name in _SIGNALS if hasattr(signal, name)]
    heard = [number for number in known if signal.getsignal(number) != signal.SIG_IGN]
    if threading.current_thread() is not threading.main_thread():
        heard = []
    before = {number: signal.signal(number, end) for number in heard}
    try:
        yield
    except KeyboardInterrupt as error:
        raise typer.Abort(str(error)) from error
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


def _remove_empty(folders: list[Path]) -> None:
    """Remove these folders, the innermost first, as far as nothing is in them."""
    with suppress(OSError):
        for folder in folders:
            folder.rmdir()


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
