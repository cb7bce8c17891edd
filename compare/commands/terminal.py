"""What the command line prints: tables and lines on standard output, progress beside it.

Lengths are printed in units of the vibrissa's length L, whatever the units of the case.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pandas as pd
from rich.console import Console
from rich.progress import (
    BarColumn,
    MofNCompleteColumn,
    Progress,
    ProgressColumn,
    Task,
    TextColumn,
    TimeRemainingColumn,
)
from rich.table import Column, Table
from rich.text import Text

from analytic import CLAMP_READINGS, PHASES, Beam, Readings
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.explain.motion import MotionBudget
from compare.measure.repeats import Repeat
from compare.read.assumed import ASSUMED
from compare.read.passes import Pass
from compare.read.rig import OWN_UNITS
from compare.show.engines import ManyEngines
from compare.show.figures.budget_bars import headline
from compare.show.quantities import quantity
from compare.show.side_by_side import SideBySide
from compare.show.style import PHASE_LETTERS
from compare.show.validity import validation_lines
from compare.show.verdict import why
from compare.simulate.target import Followed

_MEANINGS = {
    "touches again": ": another part of the vibrissa would lie in the object, no readings",
    "chattering": ": the contact was lost more than once between two stations",
    "lost": ": no contact, between stations with one",
    "sticks": ": the contact would slide back, which friction prevents as the foot moves on; the "
    "readings are those of one that slides on",
}


def print_line(text: str) -> None:
    """Print a line as it is: no markup, no folding.

    Parameters
    ----------
    text : str
        The line.
    """
    _output().print(text, soft_wrap=True, markup=False)


def print_written(path: Path) -> None:
    """Print which file there is now.

    Parameters
    ----------
    path : Path
        The file.
    """
    print_line(f"wrote {path}")


class _Rate(ProgressColumn):
    def render(self, task: Task) -> Text:
        return Text("" if task.speed is None else f"{task.speed:.3g}/s")


@contextmanager
def progress(what: str, total: int) -> Iterator[Callable[[], None]]:
    """Show a bar with rate and remaining time on a terminal, nothing elsewhere.

    Parameters
    ----------
    what : str
        What is counted.
    total : int
        How many there are.

    Yields
    ------
    callable
        To be called after each of them.
    """
    console = Console(stderr=True, highlight=False)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), _Rate(),
               TimeRemainingColumn())  # fmt: skip
    with Progress(
        *columns, console=console, disable=not console.is_terminal, transient=True
    ) as bar:
        task = bar.add_task(Text(what).markup, total=total)
        yield lambda: bar.advance(task)


def print_sweep(readings: Readings) -> None:
    """Print what a sweep found, in a line: stations, phases, snap-off, the worst residuals.

    Parameters
    ----------
    readings : Readings
        Of an engine.
    """
    table, length = readings.table, readings.beam.length
    parts = [f"{int(readings.trusted.sum())} of {len(table)} stations ok"]
    parts += _untrusted(readings)
    if "phase" in table:
        counts = table["phase"].value_counts()
        found = [f"{counts[phase]} {phase}" for phase in PHASES if phase in counts]
        parts.append(", ".join(found))
    unsettled = readings.provenance.get("unsettled", {})
    parts.extend(f"{count} unsettled: {reason}" for reason, count in unsettled.items())
    snap_off = readings.snap_off
    parts.append(
        "no snap-off" if snap_off is None else f"snap-off at foot_x = {snap_off / length:.4f} L"
    )
    for name, unit in (
        ("residual", " EI/L"),
        ("residual_boundary", ""),
        ("residual_moment", " EI/L"),
    ):
        if name in table:
            worst = np.nanmax(table[name].to_numpy(dtype=float), initial=0.0)
            parts.append(f"{name.replace('_', ' ')} at most {worst:.1e}{unit}")
    if "kinetic_share" in readings.table:
        touching = table.loc[table["phase"] != "free", "kinetic_share"].to_numpy(dtype=float)
        parts.append(f"kinetic share in contact at most {np.nanmax(touching, initial=0.0):.1e}")
        parts.append(f"{table['time'].max():.4g} T1")
    parts += [f"{name} {value:g}" for name, value in readings.beyond_the_paper.items()]
    print_line(f"{readings.source}: {'; '.join(parts)}")


def _untrusted(readings: Readings) -> list[str]:
    """How many stations have a status that nothing else is said of, where, and what it means."""
    if "status" not in readings.table:
        return []
    said = []
    for name, group in readings.table.groupby("status", sort=False)["foot_x"]:
        if name in ("ok", "unsettled"):
            continue
        ends = (x / readings.beam.length for x in (group.iloc[0], group.iloc[-1]))
        where = " to ".join(f"{x:.4f}" for x in ends)
        meaning = _MEANINGS.get(str(name), "")
        said.append(f"{len(group)} {name} (foot_x {where} L{meaning})")
    return said


def print_motion_budget(found: MotionBudget, case: str) -> None:
    """Print the parts of a disagreement in motion, and the verdict.

    Parameters
    ----------
    found : MotionBudget
        What was measured.
    case : str
        Name of the case.
    """
    title = Text(f"Budget of {case} in motion, rms +- uncertainty")
    table = Table("part", *CLAMP_READINGS, title=title)
    for name, readings in found.parts.items():
        cells = [f"{p.rms:.1e} +- {p.uncertainty:.0e}" for p in readings.values()]
        table.add_row(name, *cells)
    table.add_section()
    table.add_row("disagreement", *(f"{x:.1e}" for x in found.disagreement.values()))
    _output().print(table)
    closes = "closes" if found.closes else "does not close"
    print_line(f"The budget {closes}; {found.blame} dominates, over {found.stations} stations.")
    print_line(f"Observed order in the speed, halved twice: {found.order:.2f}.")


def print_at_rest(rest: Comparison, motion: Comparison) -> None:
    """Print what of a disagreement in motion is there at rest, and what the motion adds.

    Parameters
    ----------
    rest : Comparison
        Of the closed form and the same model at rest.
    motion : Comparison
        Of the model at rest and in motion.
    """
    settings = rest.candidate.provenance["settings"]
    for what, found in (
        (f"at rest, with contacts of {settings['contact_stiffness']:.1e} EI/L^3", rest),
        ("what the motion adds to that", motion),
    ):
        shift = found.snap_off.difference
        sizes = (f"{name} {found.disagreement[name].rms:.1e}" for name in CLAMP_READINGS)
        late = "" if shift is None else f"; snap-off {shift / rest.reference.beam.length:+.1e} L"
        print_line(f"{what}: {', '.join(sizes)}{late}")


def note_rows(readings: Readings) -> None:
    """Say on standard error what was assumed of a rig's file or done to its rows, if anything.

    Parameters
    ----------
    readings : Readings
        As `compare.read_measured` returns them.
    """
    rows = readings.provenance.get("rows", {})
    notes = []
    if ASSUMED in readings.provenance:
        notes.append("no vibrissa given, L = EI = 1 is assumed")
    if units := readings.provenance.get(OWN_UNITS):
        shown = ", ".join(f"{name} in {unit}" for name, unit in units.items())
        notes.append(f"units taken from the line below the names: {shown}")
    notes += [
        f"{count} rows {what}"
        for name, what in (
            ("out_of_order", "out of order were sorted by foot_x"),
            ("averaged", "averaged with the one before, at the same foot_x"),
        )
        if (count := rows.get(name))
    ]
    if notes:
        Console(stderr=True, highlight=False).print(
            f"vibrissa: {readings.source}: {'; '.join(notes)}", soft_wrap=True, markup=False
        )


def print_reconstruction(readings: Readings, found: pd.DataFrame, method: str) -> None:
    """Print what a reconstruction found, in a line.

    Parameters
    ----------
    readings : Readings
        What the contact was found from.
    found : pandas.DataFrame
        As `analytic.reconstruct` returns it.
    method : str
        By which method.
    """
    counts = found["phase"].value_counts()
    touching = int(np.isfinite(found["contact_x"].to_numpy(dtype=float)).sum())
    words = [
        f"{touching} contact points from {len(found)} stations",
        ", ".join(f"{counts[phase]} {phase}" for phase in PHASES if phase in counts),
    ]
    if "unexplained" in counts:
        words.append(f"{counts['unexplained']} with readings that no such vibrissa has")
    unused = int((~readings.trusted).sum())
    if unused:
        words.append(f"{unused} not used, their readings are not to be trusted")
    if touching:
        x, y = (found[name].to_numpy(dtype=float) for name in ("contact_x", "contact_y"))
        length = readings.beam.length
        words.append(
            f"x from {np.nanmin(x) / length:.4g} to {np.nanmax(x) / length:.4g} L, "
            f"y from {np.nanmin(y) / length:.4g} to {np.nanmax(y) / length:.4g} L"
            + (f" (L = {quantity(length, 'length', readings.beam)})" if readings.beam.si else "")
        )
    unanswered = int((found["status"] == "no answer").sum())
    if unanswered:
        words.append(f"{unanswered} to which the method has no answer")
    by = "" if method == "elastica" else f", {method}"
    print_line(f"{readings.source}{by}: {'; '.join(words)}")


def print_comparison(comparison: Comparison) -> None:
    """Print the verdict, and why.

    Parameters
    ----------
    comparison : Comparison
        What was found.
    """
    _output().print(_summary(comparison))
    print_line("relative to each reading's largest magnitude; lengths in L")
    for line in validation_lines(comparison):
        print_line(line)
    if comparison.agrees:
        return
    print_line(why(comparison))
    for failure in comparison.failures:
        print_line(f"  {failure}")
    if comparison.remark is not None:
        print_line(f"  {comparison.remark}")


def _summary(comparison: Comparison) -> Table:
    length = comparison.reference.beam.length
    title = Text(f"{comparison.candidate.source} ")
    title.append("agrees" if comparison.agrees else "disagrees",
                 "green" if comparison.agrees else "red")  # fmt: skip
    title.append(f" with {comparison.reference.source}")
    table = Table(
        "reading", "rms", "max", "at foot_x", "phase",
        title=title,
    )  # fmt: skip
    for name in CLAMP_READINGS:
        d = comparison.disagreement[name]
        table.add_row(name, f"{d.rms:.1e}", f"{d.max:.1e}", f"{d.at / length:.4g} L", d.phase)
    table.add_section()
    shift = comparison.snap_off.difference
    alike, right = comparison.phases_alike(), comparison.phase_agreement().get("candidate")
    table.add_row("snap-off", "", "none" if shift is None else f"{shift / length:+.1e} L", "", "")
    if alike is not None:
        known = "" if right is None else f"{right:.1%} right"
        table.add_row("phases", "", f"{alike:.1%} alike", "", known)
    offset = comparison.offset
    if offset.value or offset.uncertainty:
        width = f"+- {offset.uncertainty / length:.1g} L"
        beam = comparison.reference.beam
        own = quantity(offset.value, "length", beam) if beam != Beam() else ""
        table.add_row("offset", "", f"{offset.value / length:+.4g} L", width, own)
    if any(comparison.noise.level.values()):
        table.add_row("noise", "", f"{max(comparison.noise.level.values()):.1e}", "", "")
    return table


def print_budget(found: Budget, case: str) -> None:
    """Print the parts, the verdict and the suspects.

    Parameters
    ----------
    found : Budget
        What was measured.
    case : str
        Name of the case.
    """
    _output().print(_budget_table(found, case))
    print_line(f"{headline(found)}.")
    for suspect in found.suspects:
        print_line(
            f"  suspect: {suspect.name} differs by {suspect.size} "
            f"(accounts for {suspect.share:.0%} of the unexplained)"
        )


def _budget_table(found: Budget, case: str) -> Table:
    table = Table("part", *CLAMP_READINGS, title=Text(f"Budget of {case}, rms +- uncertainty"))
    for name, readings in found.parts.items():
        cells = [f"{p.rms:.1e} +- {p.uncertainty:.0e}" for p in readings.values()]
        table.add_row(name, *cells)
    table.add_section()
    table.add_row("disagreement", *(f"{x:.1e}" for x in found.disagreement.values()))
    table.add_section()
    for name, sizes in found.checks.items():
        table.add_row(f"{name}, closed form alone", *(f"{x:.1e}" for x in sizes.values()))
    return table


def print_advice(advice: Followed) -> None:
    """Print the advised settings, with what was predicted and measured of them.

    Parameters
    ----------
    advice : Followed
        Advice, and what came of it.
    """
    settings = advice.predicted.settings
    mesh = f" of {settings.contour_points} points" if settings.obstacle == "mesh" else ""
    print_line(
        f"Cheapest for {advice.target:g}: {settings.beam} of {settings.segments} segments, "
        f"{settings.obstacle}{mesh}, contact stiffness {settings.contact_stiffness:.1e}."
    )
    for what, error, seconds in (
        ("predicted", advice.predicted.error, advice.predicted.seconds_a_station),
        ("measured", advice.error, advice.seconds_a_station),
    ):
        print_line(f"  {what}: {error:.1e} rms, {1e3 * seconds:.1f} ms a station")
    if not advice.reached:
        print_line("  The target was missed: ask for a little less.")


def print_methods(found: pd.DataFrame, title: str) -> None:
    """Print each method's median error by noise, and how many contacts it has an answer for.

    Parameters
    ----------
    found : pandas.DataFrame
        As `compare.measure.methods.method_errors` has it.
    title : str
        Which sweep.
    """
    levels = sorted(found["noise"].unique())
    table = Table(
        Column("method", no_wrap=True), "phase", Column("answered", justify="right"),
        *(f"noise {level:g}" if level else "no noise" for level in levels),
        Column("contacts/s", justify="right"),
        title=Text(f"Median error of the contact, over L: {title}"),
    )  # fmt: skip
    for method, rows in found.groupby("method", sort=False):
        name = str(method)
        for phase, by_noise in rows.groupby("phase", sort=False):
            by = by_noise.set_index("noise")
            if not by["contacts"][levels[0]]:
                continue
            medians = (by["median"][level] for level in levels)
            table.add_row(
                name,
                PHASE_LETTERS[str(phase)],
                f"{by['answered'][levels[0]]:.0%}",
                *("-" if np.isnan(x) else f"{x:.1e}" for x in medians),
                f"{1 / by['seconds'].median():.0f}" if name and by["seconds"].min() > 0 else "",
            )
            name = ""
    _output().print(table)


def print_passes(passes: Sequence[Pass], repeats: Mapping[tuple[str, str], Repeat]) -> None:
    """Print what was read of each pass, what was not used, and how far passes repeat each other.

    Parameters
    ----------
    passes : sequence of Pass
        All of them.
    repeats : mapping of Repeat
        By the names of the two passes.
    """
    reasons = [name for name in passes[0].dropped if any(one.dropped[name] for one in passes)]
    table = Table(
        Column("pass", overflow="fold"), "to the", "rows", "kept",
        *(name.replace("_", " ") for name in reasons), "sorted", "gaps",
        *(f"drift of {name}" for name in CLAMP_READINGS),
        title="Passes: rows, why some are not used, and drift of the zero over the largest reading",
    )  # fmt: skip
    for one in passes:
        largest = {n: np.nanmax(np.abs(one.readings.values(n)), initial=0.0) for n in one.drift}
        drifts = [one.drift[n] / largest[n] if largest[n] > 0 else np.nan for n in one.drift]
        table.add_row(
            Text(one.name),
            one.direction,
            *(str(n) for n in (one.rows, one.kept)),
            *(str(one.dropped[name]) for name in reasons),
            *(str(n) for n in (one.sorted, one.record.gaps)),
            *("not known" if np.isnan(x) else f"{x:+.1e}" for x in drifts),
        )
    _output().print(table)
    length = passes[0].readings.beam.length
    for (first, second), found in repeats.items():
        apart = max(found.rms.values())
        left = max(found.rms_without_shift.values())
        shift = (
            "no shift of the foot to be seen"
            if found.shift is None
            else f"foot_x reads {found.shift / length:+.1e} L more "
            f"(+- {found.shift_uncertainty / length:.0e}), without that {left:.1e} rms"
        )
        print_line(f"{second} after {first}: {apart:.1e} rms apart; {shift}")


def print_side_by_side(found: SideBySide) -> None:
    """Print the candidates against the reference and, if there are several, against each other.

    Parameters
    ----------
    found : SideBySide
        All comparisons.
    """
    against = Table(
        "", Column("candidate", overflow="fold"), *CLAMP_READINGS, "snap-off", "ms/station",
        title=Text(f"Against {found.reference}: rms relative to each reading's largest magnitude"),
    )  # fmt: skip
    rows = found.table()
    numbers = {name: str(i) for i, name in enumerate(found.against, 1)}
    for row in rows[rows["reference"] == found.reference].to_dict("records"):
        took, snap_off = row["seconds_per_station"], row["snap_off"]
        against.add_row(
            numbers[row["candidate"]],
            Text(row["candidate"]),
            *(f"{row[name]:.1e}" for name in CLAMP_READINGS),
            "none" if np.isnan(snap_off) else f"{snap_off:+.1e}",
            "" if np.isnan(took) else f"{1e3 * took:.1f}",
        )
    _output().print(against)
    if len(numbers) < 2:
        return
    between = Table("", *list(numbers.values())[:-1], title="Each other: the largest rms")
    worst = {
        (row["reference"], row["candidate"]): max(row[name] for name in CLAMP_READINGS)
        for row in rows.to_dict("records")
    }
    names = list(numbers)
    for i, name in enumerate(names[1:], 1):
        between.add_row(numbers[name], *(f"{worst[one, name]:.1e}" for one in names[:i]))
    _output().print(between)


def print_engines(many: ManyEngines) -> None:
    """Print each engine against the closed form, and what the disagreement is made of.

    Parameters
    ----------
    many : ManyEngines
        All sweeps of a case.
    """
    table = Table(
        "engine", "role", *CLAMP_READINGS, "snap-off", "ms/station", "",
        title=Text(f"{many.case.name}: each engine against the closed form, relative rms"),
    )  # fmt: skip
    for one in many.to_dict()["engines"]:
        rms, took, apart = one["rms"], one["seconds_a_station"], one["snap_off_apart"]
        table.add_row(
            one["name"],
            one["role"],
            *("none" if rms is None else f"{rms[name]:.1e}" for name in CLAMP_READINGS),
            "none" if apart is None else f"{apart:+.1e}",
            "" if took is None else f"{1e3 * took:.1f}",
            "no readings" if one["trouble"] else "agrees" if one["agrees"] else "disagrees",
        )
    _output().print(table)
    if many.parts():
        parts = Table("part", *CLAMP_READINGS, title="What the disagreement is made of")
        for part, readings in many.parts().items():
            parts.add_row(Text(part), *(f"{readings[name]:.1e}" for name in CLAMP_READINGS))
        _output().print(parts)
    if many.split is not None:
        print_line(many.split.sentence)


def _output() -> Console:
    """Standard output, as it is now: tests and notebooks replace it."""
    return Console(highlight=False)
