"""The command ``verify``: what others printed, and tables for others."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from analytic.problem.errors import InputError
from compare.commands.options import AGREES, DISAGREES, option, out_folder
from compare.commands.output import output_folder


def verify(
    out: Annotated[Path | None, out_folder("results/verify")] = None,
    tables: Annotated[
        Path | None, option("Write reference tables into this folder, and nothing else.", "DIR")
    ] = None,
    peers: Annotated[
        bool, option("Other projects' published cases too, in their engines that are installed.")
    ] = False,
) -> int:
    """Hold what is computed here against what others printed, measured or derived.

    The exit code is 1 if any number differs by more than its stated reason makes.
    """
    from compare.commands import terminal

    if tables is not None:
        if out is not None:
            raise InputError("--out", out, "not beside --tables", "give --tables its folder")
        if peers:
            raise InputError("--peers", True, "not beside --tables", "tables are ours alone")
        from compare.verify.tables import write_tables

        with output_folder(tables) as folder:
            for path in write_tables(folder):
                terminal.print_written(path)
        return AGREES
    with output_folder(out or Path("results/verify")) as folder:
        from pandas import DataFrame

        from compare.show.html import html
        from compare.verify import record
        from compare.verify.page import drawn, peer_blocks, summary, verdict, verified
        from compare.verify.peers import CASES

        rows, given = [], record.sources()
        with terminal.progress("numbers", sum(len(one["row"]) for one in given)) as advance:
            for row in record.verify(given):
                rows.append(row)
                advance()
        others = []
        if peers:
            with terminal.progress("peers", len(CASES)) as advance:
                for case in CASES:
                    others += case()
                    advance()
        found = verdict(rows)
        terminal.show(summary(rows), found, *(peer_blocks(others) if others else ()))
        terminal.keep(folder / "report.html", html(verified(rows, others)))
        terminal.keep(folder / "verify.png", drawn(rows))
        terminal.keep(folder / "verify.csv", DataFrame([asdict(row) for row in rows]))
        if others:
            terminal.keep(folder / "peers.csv", DataFrame([asdict(row) for row in others]))
    return AGREES if found.good else DISAGREES
