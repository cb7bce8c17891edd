"""The commands' names: in groups, as the help shows them, and what became of older ones."""

from typing import Any

from typer.core import TyperGroup

from analytic.problem.errors import InputError

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
            raise InputError(
                "command", args[0], "one of `vibrissa --help`", f"use {_GONE[args[0]]}"
            )
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
