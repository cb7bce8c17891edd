"""How far sweeps disagree, and why."""

from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from rich.table import Column, Table
from rich.text import Text

from analytic import CLAMP_READINGS, Beam
from compare.commands.terminal.console import console, print_line
from compare.comparison import Comparison
from compare.show.figures.budget_bars import headline
from compare.show.quantities import quantity
from compare.show.validity import validation_lines
from compare.show.verdict import why

if TYPE_CHECKING:
    from compare.explain.budget import Budget
    from compare.explain.motion import MotionBudget
    from compare.show.engines import ManyEngines
    from compare.show.side_by_side import SideBySide
    from compare.simulate.fastest import Fastest
    from compare.simulate.target import Followed


def print_comparison(comparison: Comparison) -> None:
    """Print the verdict, and why."""
    console().print(_summary(comparison))
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


def print_budget(found: "Budget", case: str) -> None:
    """Print the parts, the verdict and the suspects."""
    console().print(_budget_table(found, case))
    print_line(f"{headline(found)}.")
    for suspect in found.suspects:
        print_line(
            f"  suspect: {suspect.name} differs by {suspect.size} "
            f"(accounts for {suspect.share:.0%} of the unexplained)"
        )


def _budget_table(found: "Budget", case: str) -> Table:
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


def print_advice(advice: "Followed") -> None:
    """Print the advised settings, with what was predicted and measured of them."""
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


def print_motion_budget(found: "MotionBudget", case: str) -> None:
    """Print the parts of a disagreement in motion, and the verdict."""
    title = Text(f"Budget of {case} in motion, rms +- uncertainty")
    table = Table("part", *CLAMP_READINGS, title=title)
    for name, readings in found.parts.items():
        cells = [f"{p.rms:.1e} +- {p.uncertainty:.0e}" for p in readings.values()]
        table.add_row(name, *cells)
    table.add_section()
    table.add_row("disagreement", *(f"{x:.1e}" for x in found.disagreement.values()))
    console().print(table)
    closes = "closes" if found.closes else "does not close"
    print_line(f"The budget {closes}; {found.blame} dominates, over {found.stations} stations.")
    print_line(f"Observed order in the speed, of three speeds: {found.order:.2f}.")
    if found.left_out:
        print_line(f"Diverged, and left out: {', '.join(found.left_out)}.")


def print_fastest(found: "Fastest") -> None:
    """Print the fastest motion with a wanted error, and what was tried."""
    print_line(
        f"Fastest for {found.target:g}: {found.speed:.3g} L/T1, {found.error:.1e} rms, "
        f"{found.seconds:.1f} s; {found.at_rest:.1e} is left at rest."
    )
    print_line("  " + ", ".join(f"{v:.3g}: {error:.1e}" for v, error in found.tried.items()))


def print_at_rest(rest: Comparison, motion: Comparison) -> None:
    """Print what of a disagreement in motion is there at rest, and what the motion adds."""
    settings = rest.candidate.provenance["settings"]
    for what, found in (
        (f"at rest, with contacts of {settings['contact_stiffness']:.1e} EI/L^3", rest),
        ("what the motion adds to that", motion),
    ):
        shift = found.snap_off.difference
        sizes = (f"{name} {found.disagreement[name].rms:.1e}" for name in CLAMP_READINGS)
        late = "" if shift is None else f"; snap-off {shift / rest.reference.beam.length:+.1e} L"
        print_line(f"{what}: {', '.join(sizes)}{late}")


def print_side_by_side(found: "SideBySide") -> None:
    """Print the candidates against the reference and, if there are several, against each other."""
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
    console().print(against)
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
    console().print(between)


def print_engines(many: "ManyEngines") -> None:
    """Print each engine against the closed form, and what the disagreement is made of."""
    table = Table(
        "engine", *CLAMP_READINGS, "snap-off", "ms", "",
        title=Text(f"{many.case.name}: each engine against the closed form, relative rms"),
        caption="snap-off: how far apart [L]; ms: computing time of a station",
    )  # fmt: skip
    for one in many.to_dict()["engines"]:
        rms, took, apart = one["rms"], one["seconds_a_station"], one["snap_off_apart"]
        table.add_row(
            one["name"],
            *("none" if rms is None else f"{rms[name]:.1e}" for name in CLAMP_READINGS),
            "none" if apart is None else f"{apart:+.1e}",
            "" if took is None else f"{1e3 * took:.1f}",
            "no readings" if one["trouble"] else "agrees" if one["agrees"] else "disagrees",
        )
    console().print(table)
    if many.parts():
        parts = Table("part", *CLAMP_READINGS, title="What the disagreement is made of")
        for part, readings in many.parts().items():
            parts.add_row(Text(part), *(f"{readings[name]:.1e}" for name in CLAMP_READINGS))
        console().print(parts)
    if many.split is not None:
        print_line(many.split.sentence)


def print_float32(found: pd.DataFrame, case: str) -> None:
    """Print what single precision loses, by contact stiffness."""
    table = Table(
        "stiffness", "depth", "resolution", "lost", "force off", "imbalance",
        title=Text(f"{case}: MuJoCo's states at rest in single precision"),
        caption="found (predicted); lost: stations; force: over the largest load; L = EI = 1",
    )  # fmt: skip
    for row in found.to_dict("records"):
        table.add_row(
            f"{row['contact_stiffness']:g}",
            f"{row['depth']:.1e}",
            f"{row['resolution']:.1e}",
            f"{row['lost']} of {row['stations']} ({row['predicted_lost']:.1f})",
            f"{row['force_error']:.1e} ({row['predicted_force_error']:.1e})",
            f"{row['imbalance']:.1e} ({row['predicted_imbalance']:.1e})",
        )
    console().print(table)
