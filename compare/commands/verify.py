"""The command ``verify``: what others printed, beside what is computed here."""

from dataclasses import asdict
from pathlib import Path
from typing import Annotated

from compare.commands.options import flag, out_folder
from compare.commands.output import page_folder


def verify(
    peers: Annotated[
        bool, flag("--peers", "Other projects' own test cases, by their engines where installed.")
    ] = False,
    out: Annotated[Path | None, out_folder("results/verify")] = None,
) -> bool:
    """Hold our numbers against those that others printed.

    The exit code is 1 if any number differs by more than its stated reason makes.
    """
    with page_folder(out or Path("results/verify")) as folder:
        return (_peers if peers else _sources)(folder)


def _sources(folder: Path) -> bool:
    from pandas import DataFrame

    from compare.commands import terminal
    from compare.verify import record
    from compare.verify.record import drawn, summary, verdict, verified

    rows, given = [], record.sources()
    with terminal.progress("numbers", sum(len(one["row"]) for one in given)) as advance:
        for row in record.verify(given):
            rows.append(row)
            advance()
    found = verdict(rows)
    terminal.show(summary(rows), found)
    terminal.keep(folder / "report.html", verified(rows))
    terminal.keep(folder / "verify.png", drawn(rows))
    terminal.keep(folder / "verify.csv", DataFrame([asdict(row) for row in rows]))
    return found.good


def _peers(folder: Path) -> bool:
    from pandas import DataFrame

    from compare.commands import terminal
    from compare.verify.peers import CASES, page, summary

    rows = [row for case in CASES for row in case()]
    terminal.show(*summary(rows))
    terminal.keep(folder / "peers.html", page(rows))
    terminal.keep(folder / "peers.csv", DataFrame([asdict(row) for row in rows]))
    return True
