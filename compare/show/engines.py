"""A case in many engines: one page, one picture, one table."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from matplotlib.ticker import LogFormatter

from analytic import CLAMP_READINGS, Case, Readings
from analytic.problem.files import write_whole
from compare.explain.budget import Budget
from compare.explain.split import Split, split
from compare.show.colophon import colophon
from compare.show.page import document, inline_svg, png, render
from compare.show.side_by_side import SideBySide, picture, seconds_per_station, side_by_side
from compare.show.style import (
    AT_TOP,
    LARGE,
    READING_COLOURS,
    READING_MARKERS,
    SMALL,
    SYMBOLS,
    label,
)

_DECADE = 10.0  # of time, drawn at least


@dataclass(frozen=True)
class EngineRow:
    """What is known of one engine, whether or not it gave readings."""

    name: str  # as the engine says itself
    role: str  # as the engine says itself
    version: str  # as the engine says itself
    tuned: str  # as the engine says itself
    trouble: str | None  # why there are no readings


@dataclass(frozen=True)
class ManyEngines:
    """The sweeps of one case in several engines."""

    case: Case  # the problem
    exact: Readings  # the closed form
    rows: Sequence[EngineRow]  # in the order in which they were asked for
    sweeps: Mapping[str, Readings]  # of those that gave any, by engine
    found: SideBySide  # each against the closed form, and against each other
    split: Split | None  # implementation and model, if MuJoCo and a twin of it are there
    budget: Budget | None  # what MuJoCo's disagreement is made of, if it was measured

    @classmethod
    def of(
        cls,
        case: Case,
        exact: Readings,
        rows: Sequence[EngineRow],
        sweeps: Mapping[str, Readings],
        budget: Budget | None = None,
    ) -> "ManyEngines":
        """Compare them."""
        roles = {row.name: row.role for row in rows}
        found = side_by_side(exact, dict(sweeps))
        return cls(case, exact, rows, sweeps, found, split(exact, sweeps, roles), budget)

    @property
    def agree(self) -> bool:
        """Whether all engines gave readings that agree with the closed form."""
        complete = all(row.trouble is None for row in self.rows)
        return complete and all(one.agrees for one in self.found.against.values())

    def parts(self) -> dict[str, dict[str, float]]:
        """What the disagreement is split into: by the twin, by other models, by the budget."""
        parts: dict[str, dict[str, float]] = {}
        if self.split is not None:
            subject, twin = self.split.subject, self.split.twin
            parts[f"{subject} against exact"] = self.split.disagreement
            parts[f"implementation: {subject} against {twin}"] = self.split.implementation
            parts[f"model: {twin} against exact"] = self.split.model
            parts |= {
                f"other model: {name} against exact": rms for name, rms in self.split.others.items()
            }
        if self.budget is not None:
            parts |= {
                f"budget: {part}": {name: one.rms for name, one in readings.items()}
                for part, readings in self.budget.parts.items()
            }
        return parts

    def to_dict(self) -> dict[str, Any]:
        """What ``engines.json`` holds."""
        return {
            "case": self.case.name,
            "engines": [
                {
                    **vars(row),
                    "rms": self.rms(row.name),
                    "snap_off_apart": self._apart(row.name),
                    "seconds_a_station": self.seconds(row.name),
                    "agrees": row.name in self.sweeps and self.found.against[row.name].agrees,
                }
                for row in self.rows
            ],
            "split": None if self.split is None else self.split.to_dict(),
            "parts": self.parts(),
            **self.found.to_dict(),
        }

    def rms(self, name: str) -> dict[str, float] | None:
        """Of an engine's readings from the closed form's."""
        if name not in self.sweeps:
            return None
        found = self.found.against[name].disagreement
        return {reading: found[reading].rms for reading in CLAMP_READINGS}

    def _apart(self, name: str) -> float | None:
        """Snap-off of an engine less that of the closed form [L]."""
        if name not in self.sweeps:
            return None
        apart = self.found.against[name].snap_off.difference
        return None if apart is None else apart / self.exact.beam.length

    def seconds(self, name: str) -> float | None:
        """Processor time a station."""
        seconds = seconds_per_station(self.sweeps[name]) if name in self.sweeps else np.nan
        return None if np.isnan(seconds) else float(seconds)


def write_engines(many: ManyEngines, folder: Path) -> list[Path]:
    """Write the page, its numbers, and the picture of error against time."""
    content = many.to_dict()
    timed = error_against_time(many)
    page = render(
        "compare.show",
        "engines.html.j2",
        many=many,
        engines=content["engines"],
        parts=content["parts"],
        readings=CLAMP_READINGS,
        between={names: c.disagreement for names, c in many.found.between.items()},
        timed=inline_svg(timed, "time", "Error against time a station, a mark an engine"),
        apart=inline_svg(picture(many.found), "apart", "Differences over the foot position"),
        colophon=colophon(),
    )
    return [
        write_whole(folder / "engines.html", page),
        write_whole(folder / "engines.json", document(content)),
        write_whole(folder / "engines.png", png(timed)),
    ]


def error_against_time(many: ManyEngines) -> Figure:
    """Draw the rms of each reading against the time a station, for all engines."""
    figure = Figure(figsize=(7, 4.4), layout="constrained")
    ax = figure.subplots()
    ax.set_xscale("log")
    ax.set_yscale("log")
    timed = [row.name for row in many.rows if many.seconds(row.name)]
    for reading in CLAMP_READINGS:
        points = [(many.seconds(name), many.rms(name)) for name in timed]
        ax.plot(
            [1e3 * (seconds or np.nan) for seconds, _ in points],
            [rms[reading] if rms else np.nan for _, rms in points],
            linestyle="",
            marker=READING_MARKERS[reading],
            color=READING_COLOURS[reading],
            label=SYMBOLS[reading],
        )
    for name in timed:
        rms = many.rms(name) or {}
        x, y = 1e3 * (many.seconds(name) or np.nan), max(rms.values())
        ax.annotate(
            label(name), (x, y), (0, 8), textcoords="offset points", ha="center", fontsize=SMALL
        )
    ax.margins(0.25)
    low, high = ax.get_xlim()
    if high < _DECADE * low:  # times that hardly differ are not drawn far apart
        middle = np.sqrt(low * high)
        ax.set_xlim(middle / np.sqrt(_DECADE), middle * np.sqrt(_DECADE))
    for formatter in (ax.xaxis.set_major_formatter, ax.xaxis.set_minor_formatter):
        formatter(LogFormatter(minor_thresholds=(1.5, 0.4)))  # 50, not 5 x 10^1
    ax.set_title(f"{label(many.case.name)}: error against time", fontsize=LARGE, y=AT_TOP)
    ax.set_xlabel("processor time a station [ms], building the model included")
    ax.set_ylabel("rms relative to the largest magnitude")
    ax.grid(which="both", alpha=0.25)
    ax.legend(frameon=False, fontsize=SMALL)
    return figure
