"""What commands print of their results: the verdict, the numbers that matter, the tables."""

from typing import TYPE_CHECKING

import pandas as pd

from analytic import CLAMP_READINGS
from compare.commands.terminal.blocks import show
from compare.comparison import Comparison
from compare.show.budgets import budget_summary
from compare.show.document import Text

if TYPE_CHECKING:
    from compare.comparison_in_space import SpatialComparison
    from compare.explain.budget import Budget
    from compare.explain.motion import MotionBudget
    from compare.explain.split_space import Parts
    from compare.show.engines import ManyEngines
    from compare.show.side_by_side import SideBySide
    from compare.simulate.fastest import Fastest
    from compare.simulate.target import Followed


def print_comparison(comparison: Comparison) -> None:
    """Print the verdict, and what it rests on."""
    from compare.show.plane_page import plane_summary

    show(*plane_summary(comparison))


def print_spatial_comparison(comparison: "SpatialComparison", parts: "Parts | None") -> None:
    """Print the verdict in space, and what it rests on."""
    from compare.show.spatial_page import spatial_summary

    show(*spatial_summary(comparison, parts))


def print_budget(found: "Budget | MotionBudget", case: str) -> None:
    """Print the parts, the verdict and the suspects."""
    show(Text("", strong=f"Budget of {case}"), *budget_summary(found))


def print_advice(advice: "Followed") -> None:
    """Print the advised settings, with what was predicted and measured of them."""
    settings = advice.predicted.settings
    mesh = f" of {settings.contour_points} points" if settings.obstacle == "mesh" else ""
    found = [
        f"Cheapest for {advice.target:g}: {settings.beam} of {settings.segments} segments, "
        f"{settings.obstacle}{mesh}, contact stiffness {settings.contact_stiffness:.1e}."
    ]
    for what, error, seconds in (
        ("predicted", advice.predicted.error, advice.predicted.seconds_a_station),
        ("measured", advice.error, advice.seconds_a_station),
    ):
        found.append(f"  {what}: {error:.1e} rms, {1e3 * seconds:.1f} ms a station")
    if not advice.reached:
        found.append("  The target was missed: ask for a little less.")
    show(*map(Text, found))


def print_fastest(found: "Fastest") -> None:
    """Print the fastest motion with a wanted error, and what was tried."""
    tried = ", ".join(f"{v:.3g}: {error:.1e}" for v, error in found.tried.items())
    show(
        Text(
            f"Fastest for {found.target:g}: {found.speed:.3g} L/T1, {found.error:.1e} rms, "
            f"{found.seconds:.1f} s; {found.at_rest:.1e} is left at rest."
        ),
        Text(f"  {tried}"),
    )


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
        show(Text(f"{what}: {', '.join(sizes)}{late}"))


def print_side_by_side(found: "SideBySide") -> None:
    """Print the candidates against the reference and, if there are several, against each other."""
    from compare.show.side_by_side import against_table, between_table

    show(against_table(found), *between_table(found))


def print_engines(many: "ManyEngines") -> None:
    """Print each engine against the closed form, and what the disagreement is made of."""
    from compare.show.engines import outcomes_table, parts_table

    show(outcomes_table({many.case.name: many.outcomes}))
    if many.parts():
        show(parts_table({many.case.name: many.parts()}))
    if many.split is not None:
        show(Text(many.split.sentence))


def print_float32(found: pd.DataFrame, case: str) -> None:
    """Print what single precision loses, by contact stiffness."""
    from compare.show.float32 import losses_table

    show(losses_table(found, case))
