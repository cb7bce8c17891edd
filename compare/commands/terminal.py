"""What the command line says: tables and lines on standard output, progress beside it."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import Progress
from rich.table import Column, Table

from analytic import CLAMP_READINGS
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.show.figures.budget_bars import headline
from compare.show.side_by_side import SideBySide
from compare.simulate.target import Followed

TOLD = Console(highlight=False)
NOTED = Console(stderr=True, highlight=False)


@contextmanager
def progress(what: str, total: int) -> Iterator[Callable[[], None]]:
    """A bar on a terminal, nothing elsewhere."""
    with Progress(console=NOTED, disable=not NOTED.is_terminal, transient=True) as bar:
        task = bar.add_task(what, total=total)
        yield lambda: bar.advance(task)


def tell_comparison(comparison: Comparison) -> None:
    """The verdict, and why."""
    TOLD.print(_summary(comparison))
    for failure in comparison.failures:
        TOLD.print(f"  {failure}", soft_wrap=True, markup=False)
    if comparison.likely is not None:
        TOLD.print(f"  likely: {comparison.likely}", soft_wrap=True, markup=False)


def _summary(comparison: Comparison) -> Table:
    verdict = "[green]agrees[/]" if comparison.agrees else "[red]disagrees[/]"
    table = Table(
        "reading", "rms", "max", "at foot_x", "phase",
        title=f"{comparison.candidate.source} {verdict} with {comparison.reference.source}",
        caption="relative to each reading's largest magnitude",
    )  # fmt: skip
    for name in CLAMP_READINGS:
        d = comparison.disagreement[name]
        table.add_row(name, f"{d.rms:.1e}", f"{d.max:.1e}", f"{d.at:.4g}", d.phase)
    table.add_section()
    shift = comparison.snap_off.difference
    agreement = comparison.phase_agreement()
    table.add_row("snap-off", "", "none" if shift is None else f"{shift:+.1e}", "", "")
    if agreement:
        table.add_row("phases", "", f"{min(agreement.values()):.1%} right", "", "")
    offset = comparison.offset
    if offset.value or offset.uncertainty:
        table.add_row("offset", "", f"{offset.value:+.4g}", f"+- {offset.uncertainty:.1g}", "")
    if any(comparison.noise.level.values()):
        table.add_row("noise", "", f"{max(comparison.noise.level.values()):.1e}", "", "")
    return table


def tell_budget(found: Budget, case: str) -> None:
    """The parts, the verdict and the suspects."""
    TOLD.print(_budget_table(found, case))
    TOLD.print(f"{headline(found)}.", soft_wrap=True)
    for suspect in found.suspects:
        TOLD.print(
            f"  suspect: {suspect.name} differs by {suspect.change:+.2%} "
            f"(accounts for {suspect.share:.0%} of the unexplained)"
        )


def _budget_table(found: Budget, case: str) -> Table:
    table = Table("part", *CLAMP_READINGS, title=f"Budget of {case}, rms +- uncertainty")
    for name, readings in found.parts.items():
        cells = [f"{p.rms:.1e} +- {p.uncertainty:.0e}" for p in readings.values()]
        table.add_row(name, *cells)
    table.add_section()
    table.add_row("disagreement", *(f"{x:.1e}" for x in found.disagreement.values()))
    table.add_section()
    for name, sizes in found.checks.items():
        table.add_row(f"{name}, closed form alone", *(f"{x:.1e}" for x in sizes.values()))
    return table


def tell_advice(advice: Followed) -> None:
    """The settings, foretold and measured."""
    settings = advice.foretold.settings
    mesh = f" of {settings.contour_points} points" if settings.obstacle == "mesh" else ""
    TOLD.print(
        f"Cheapest for {advice.target:g}: {settings.beam} of {settings.segments} segments, "
        f"{settings.obstacle}{mesh}, contact stiffness {settings.contact_stiffness:.1e}."
    )
    for told, error, seconds in (
        ("foretold", advice.foretold.error, advice.foretold.seconds_a_station),
        ("measured", advice.error, advice.seconds_a_station),
    ):
        TOLD.print(f"  {told}: {error:.1e} rms, {1e3 * seconds:.1f} ms a station")
    if not advice.reached:
        TOLD.print("  The target was missed: ask for a little less.")


def side_by_side_tables(found: SideBySide) -> tuple[Table, Table]:
    """Against the reference, and the largest rms between the candidates."""
    against = Table(
        "", Column("candidate", overflow="fold"), *CLAMP_READINGS, "snap-off", "ms/station",
        title=f"Against {found.reference}: rms relative to each reading's largest magnitude",
    )  # fmt: skip
    rows = found.table()
    numbers = {name: str(i) for i, name in enumerate(found.against, 1)}
    for row in rows[rows["reference"] == found.reference].to_dict("records"):
        took, snap_off = row["seconds_per_station"], row["snap_off"]
        against.add_row(
            numbers[row["candidate"]],
            row["candidate"],
            *(f"{row[name]:.1e}" for name in CLAMP_READINGS),
            "none" if np.isnan(snap_off) else f"{snap_off:+.1e}",
            "" if np.isnan(took) else f"{1e3 * took:.1f}",
        )
    between = Table("", *list(numbers.values())[:-1], title="Each other: the largest rms")
    worst = {
        (row["reference"], row["candidate"]): max(row[name] for name in CLAMP_READINGS)
        for row in rows.to_dict("records")
    }
    names = list(numbers)
    for i, name in enumerate(names[1:], 1):
        between.add_row(numbers[name], *(f"{worst[one, name]:.1e}" for one in names[:i]))
    return against, between


def tell_written(path: Path) -> None:
    """Which file there is now."""
    TOLD.print(f"wrote {path}", soft_wrap=True, markup=False)
