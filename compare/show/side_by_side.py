"""Any number of sweeps against one reference: a table, a picture, and the differences in pairs."""

from dataclasses import dataclass
from itertools import combinations
from typing import Any

from matplotlib.figure import Figure

from analytic import CLAMP_READINGS, Readings
from compare.comparison import Comparison, compare
from compare.show.document import Table
from compare.show.figures.keys import key_below
from compare.show.figures.over_foot import foot_label, shade_reference
from compare.show.numbers import short
from compare.show.style import LARGE, LINE_STYLES, SERIES, SYMBOLS, label


@dataclass(frozen=True)
class SideBySide:
    """Sweeps compared with a reference and with each other."""

    against: dict[str, Comparison]  # each sweep against the reference, by its name
    # Each sweep against each one before it, by both names.
    between: dict[tuple[str, str], Comparison]

    @property
    def reference(self) -> str:
        """What the sweeps are compared with."""
        return next(iter(self.against.values())).reference.source

    def to_dict(self) -> dict[str, Any]:
        """What ``side-by-side.json`` holds."""
        found = {(self.reference, name): one for name, one in self.against.items()} | self.between
        return {"comparisons": [{"names": [*names], **c.to_dict()} for names, c in found.items()]}


def side_by_side(reference: Readings, candidates: dict[str, Readings]) -> SideBySide:
    """Compare every candidate with the reference, and the candidates in pairs."""
    return SideBySide(
        {name: compare(reference, readings) for name, readings in candidates.items()},
        {
            (one, other): compare(candidates[one], candidates[other])
            for one, other in combinations(candidates, 2)
        },
    )


def seconds_per_station(readings: Readings) -> float | None:
    """Time of a sweep, if its source recorded it."""
    seconds = readings.provenance.get("seconds")
    return None if seconds is None else float(seconds) / len(readings.table)


def against_table(found: SideBySide) -> Table:
    """Each sweep against the reference."""
    rows = []
    for number, (name, one) in enumerate(found.against.items(), 1):
        apart, took = one.snap_off.difference, seconds_per_station(one.candidate)
        rows.append(
            (
                f"{number} {name}",
                *(short(one.disagreement[reading].rms) for reading in CLAMP_READINGS),
                short(apart),
                "" if took is None else f"{1e3 * took:.1f}",
            )
        )
    return Table(
        f"Against {found.reference}: rms relative to each reading's largest magnitude",
        ("candidate", *CLAMP_READINGS, "snap-off", "ms/station"),
        rows,
    )


def between_table(found: SideBySide) -> list[Table]:
    """The sweeps against each other, if there are several."""
    rows = [
        (f"{one}, {other}", *(short(pair.disagreement[name].rms) for name in CLAMP_READINGS))
        for (one, other), pair in found.between.items()
    ]
    return [Table("Each other, relative rms", ("pair", *CLAMP_READINGS), rows)] if rows else []


def picture(found: SideBySide) -> Figure:
    """Draw how far the clamp readings are from the reference's, over the foot position."""
    figure = Figure(figsize=(12, 4.2), layout="constrained")
    axes = figure.subplots(1, 3, sharex=True)
    first = next(iter(found.against.values()))
    for ax, name in zip(axes, CLAMP_READINGS, strict=True):
        shade_reference(ax, first)
        for i, (candidate, one) in enumerate(found.against.items()):
            table = one.alignment.table
            error = table[f"{name}_candidate"] - table[f"{name}_reference"]
            ax.plot(
                table["foot_x"].to_numpy() / first.reference.beam.length,
                error.to_numpy() / one.disagreement[name].scale,
                color=SERIES[i % len(SERIES)],
                linestyle=LINE_STYLES[i % len(LINE_STYLES)],
                label=label(candidate),
            )
        ax.ticklabel_format(axis="y", scilimits=(-2, 2))
        ax.set_title(SYMBOLS[name], fontsize=LARGE)
        ax.set_xlabel(foot_label(first.reference))
    axes[0].set_ylabel(f"difference from {label(found.reference)}\nrelative to largest magnitude")
    key_below(figure, axes[0], min(len(found.against), 4))
    return figure
