"""The command ``vibrissa``: its commands, and what becomes of their errors."""

import os
import sys
from collections.abc import Callable
from functools import wraps
from io import TextIOWrapper
from traceback import format_exc
from typing import Annotated, Any

import typer
from typer.core import TyperGroup
from typer.exceptions import TyperException

from analytic.problem.errors import InputError, near
from compare.commands.calibrate import calibrate
from compare.commands.compare import compare
from compare.commands.export import export
from compare.commands.inspect import inspect
from compare.commands.listing import list_what_there_is
from compare.commands.output import ended_by_signals, warn
from compare.commands.reconstruct import reconstruct
from compare.commands.rig import rig
from compare.commands.run import run, view
from compare.commands.study import report, study
from compare.commands.verify import verify
from compare.read.complaints import in_our_words

_GONE = {
    "analytic": "vibrissa run CASE --engine exact",
    "simulate": "vibrissa run CASE --sweep-only",
    "space": "vibrissa run CASE, for readings vibrissa reconstruct FILE --beam CASE",
    "animate": "vibrissa run CASE --film",
    "budget": "vibrissa run CASE --budget",
    "side-by-side": "vibrissa compare REFERENCE CANDIDATE...",
    "methods": "vibrissa study methods-noise, or python -m docs.figures.methods CASE DIR",
    "float32": "vibrissa inspect CASE --float32",
    "study-report": "vibrissa report DIR",
    "findings": "vibrissa report DIR",
    "cases": "vibrissa list cases",
    "engines": "vibrissa list engines",
}


class Group(TyperGroup):
    """Commands in named groups; a name that is gone says the new one."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:  # noqa: ANN401  # typer's own
        if args[0] in _GONE:
            instead = f"use {_GONE[args[0]]}"
            raise InputError("command", args[0], "one of `vibrissa --help`", instead)
        return super().resolve_command(ctx, args)

    def format_commands(self, ctx: Any, formatter: Any) -> None:  # noqa: ANN401
        """Write each group with its commands, in the order in which they were added."""
        panels: dict[str, list[tuple[str, str]]] = {}
        width = formatter.width - 6 - max(map(len, self.commands))
        for name, command in self.commands.items():
            panel: str = getattr(command, "rich_help_panel", "")
            panels.setdefault(panel, []).append((name, command.get_short_help_str(width)))
        for panel, rows in panels.items():
            with formatter.section(panel):
                formatter.write_dl(rows, col_max=width)


AGREES, DISAGREES, BAD_INPUT = 0, 1, 2
_LONGEST = 800  # characters of an error

app = typer.Typer(
    cls=Group,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # markup would swallow the brackets of [beam] and [tolerances]
)

COMMANDS: dict[str, tuple[Callable[..., bool], ...]] = {
    "Sweep and compare": (run, compare, view),
    "What the clamp says": (reconstruct, calibrate, rig),
    "Models": (inspect, export),
    "Many": (study, report),
    "Trust": (verify,),
    "What there is": (list_what_there_is,),
}
_NAMES = {list_what_there_is: "list"}


def _with_exit_code(command: Callable[..., bool]) -> Callable[..., int]:
    @ended_by_signals()
    @wraps(command)
    def ended(*given: Any, **named: Any) -> int:  # noqa: ANN401  # whatever the command takes
        return AGREES if command(*given, **named) else DISAGREES

    return ended


for group, commands in COMMANDS.items():
    for command in commands:
        name = _NAMES.get(command, command.__name__)
        app.command(name, rich_help_panel=group)(_with_exit_code(command))


def _show_version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        packages = ("vibrissa-testbed", "mujoco", "numpy", "scipy")
        typer.echo(", ".join(f"{name} {version(name)}" for name in packages))
        raise typer.Exit


@app.callback()
def vibrissa(
    show_version: Annotated[
        bool,
        typer.Option(
            "--version", is_eager=True, callback=_show_version, help="Show the versions, and exit."
        ),
    ] = False,
) -> None:
    """A vibrissa swept past a convex object: the exact elastica against MuJoCo.

    Exit codes: 0 agrees, 1 ran and disagrees, 2 bad input.
    """


def main() -> None:
    """Run the command line; whatever goes wrong is reported in one line."""
    os.environ["MPLBACKEND"] = "agg"  # pictures are files; the user's backend may not even exist
    os.environ.setdefault("MUJOCO_GL", "off")  # none of them is MuJoCo's, which looks for OpenGL
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):  # what its encoding lacks is written as an escape
            stream.reconfigure(errors="backslashreplace")
    sys.exit(_run())


def _run() -> int:
    try:
        for word in sys.argv[1:]:
            _require_utf8(word)
        if not sys.argv[1:]:
            app(["--help"], standalone_mode=False)
            return BAD_INPUT
        return app(standalone_mode=False) or AGREES
    except (InputError, TyperException, OSError, ArithmeticError, MemoryError) as error:
        return _refuse(_in_words(error))
    except (typer.Abort, KeyboardInterrupt) as error:
        return _refuse(str(error) or "interrupted")
    except Exception as error:
        if os.environ.get("VIBRISSA_TRACEBACK"):
            typer.echo(format_exc(), err=True)
        said, remedy = f"internal error, {type(error).__name__}: {error}", "VIBRISSA_TRACEBACK=1"
        return _refuse(f"{said}; please report it with what {remedy} shows")


def _in_words(error: Exception) -> str:
    match error:
        case InputError():
            return str(error)
        case TyperException():
            said = in_our_words(error.format_message().rstrip("."))
            given, _, known = said.partition(" is not one of ")  # words in single quotes
            remedy = near(given.split("'")[-2], known.split("'")[1::2], "") if known else ""
            if said.startswith("Missing argument"):
                of: Any = getattr(error, "ctx", None)  # every error of an argument has one
                words = [x.metavar for x in of.command.params if x.param_type_name == "argument"]
                remedy = f"write vibrissa {of.info_name} {' '.join(words)}"
            return f"{said}; {remedy or 'see `vibrissa --help`'}"
        case OSError():
            place = "a file" if error.filename is None else error.filename
            return f"{place}: {error.strerror or error}; choose another folder with --out"
        case MemoryError():
            return f"out of memory ({error}); take fewer segments or contour points"
        case ZeroDivisionError() | OverflowError() | FloatingPointError():
            beyond = f"a number beyond double precision ({error})"
            return f"{beyond}; check the units and sizes of the case"
    return str(error)


def _require_utf8(word: str) -> None:
    try:
        word.encode()
    except UnicodeEncodeError as error:
        allowed = f"text in the encoding of the terminal, {sys.getfilesystemencoding()}"
        remedy = "rename the file or folder, or set LC_ALL=C.UTF-8"
        raise InputError("argument", ascii(word), allowed, remedy) from error


def _refuse(message: str) -> int:
    line = " ".join(message.split())
    if len(line) > _LONGEST:  # what was given is quoted, however long it is
        line = f"{line[: _LONGEST // 2]} ... {line[-_LONGEST // 2 :]}"
    warn(line)
    return BAD_INPUT
