"""What commands are given, looked at before any work is done, and for what their options hold.

An option that would be ignored is bad input.
"""

import sys
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, get_type_hints

import typer

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file
from compare.read.kinds import MODEL, MOTION, PLANE, SPACE

IN_THE_PLANE = (PLANE, MOTION, MODEL)
ANY_CASE = (*IN_THE_PLANE, SPACE)
A_RIG = "a file that no engine wrote"


@dataclass(frozen=True)
class For:
    """What an option holds for: any of these kinds, and beside all of what else is named."""

    kinds: tuple[str, ...]
    beside: tuple[str, ...] = ()

    def lacks(self, kind: str, others: Collection[str]) -> str | None:
        """What would be allowed, if the option would be ignored."""
        if kind not in self.kinds:
            return f"left out but for {' or '.join(self.kinds)}"
        missing = [one for one in self.beside if one not in others]
        return f"beside {missing[0]}" if missing else None


def require_use(context: typer.Context, kind: str, *others: str) -> None:
    """Refuse options that would be ignored: of what kind it is, and what else is asked for."""
    hints = get_type_hints(context.command.callback, include_extras=True)
    given = {one.name: one for one in context.command.params if one.name and _given(context, one)}
    asked = {*others, *(one.opts[0] for one in given.values())}
    for name, parameter in given.items():
        uses = [use for use in getattr(hints[name], "__metadata__", ()) if isinstance(use, For)]
        lacks = [use.lacks(kind, asked) for use in uses]
        if lacks and all(lacks):
            is_option = parameter.param_type_name == "option"
            raise InputError(
                parameter.opts[0] if is_option else name.upper(),
                _shown(context.params[name]),
                str(lacks[-1]),
                f"this is {kind}",
            )


def _given(context: typer.Context, parameter: Any) -> bool:  # noqa: ANN401  # typer's own
    source = context.get_parameter_source(parameter.name)
    return source is not None and source.name == "COMMANDLINE"


def _shown(value: object) -> str:
    return "given" if isinstance(value, bool) else str(value)


def require_readings(files: Iterable[Path]) -> None:
    for file in files:
        regular_file(file, "readings file", sys.maxsize)


def no_rigs(files: Iterable[Path]) -> bool:
    """Whether this project wrote all of these files of readings."""
    from analytic.problem.readings_file import is_ours

    return all(is_ours(file) for file in files)


def from_rigs(files: Collection[Path]) -> bool:
    """Whether a rig's file is among these, or passes of one: then a direction says something."""
    return not no_rigs(files) or are_passes(files)


def pass_files(files: Iterable[Path]) -> list[Path]:
    """The files of readings; of a folder that ``rig`` wrote those of its passes."""
    found = []
    for file in files:
        if not file.is_dir():
            found.append(file)
            continue
        if not (file / "passes.json").is_file():
            remedy = "make one: vibrissa rig FILE... --rig RIG.toml --out DIR"
            raise InputError("FILE", file, "a file, or a folder that `rig` wrote", remedy)
        from compare.read.run_folder import PassesRecord, read_stored

        record = read_stored(file / "passes.json", PassesRecord)
        found += [file / f"{one['name']}.parquet" for one in record.passes]
    require_readings(found)
    return found


def are_passes(files: Iterable[Path]) -> bool:
    """Whether ``rig`` wrote all of these files of readings."""
    from analytic import Readings

    return no_rigs(files) and all("pass" in Readings.read(file).provenance for file in files)
