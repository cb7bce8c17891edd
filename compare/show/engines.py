"""A case in many engines: one page, one picture, one table."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from analytic import CLAMP_READINGS, Case, Readings
from analytic.problem.files import write_whole
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.explain.split import Split, split
from compare.read.runs import EngineOutcome
from compare.show import style
from compare.show.document import Block, Document, Picture, Table, Text, Verdict, sections
from compare.show.html import html
from compare.show.numbers import short
from compare.show.page import as_json, png
from compare.show.side_by_side import (
    SideBySide,
    between_table,
    picture,
    seconds_per_station,
    side_by_side,
)

_EDGE = 0.97  # of the picture's width


@dataclass(frozen=True)
class ManyEngines:
    """The sweeps of one case in several engines."""

    case: Case  # the problem
    exact: Readings  # the closed form
    outcomes: Sequence[EngineOutcome]  # in the order in which they were asked for
    found: SideBySide  # each against the closed form, and against each other
    split: Split | None  # implementation and model, if MuJoCo and a twin of it are there
    budget: Budget | None  # what MuJoCo's disagreement is made of, if it was measured

    @classmethod
    def of(
        cls,
        case: Case,
        exact: Readings,
        asked: Sequence[EngineOutcome],
        sweeps: Mapping[str, Readings],
        budget: Budget | None = None,
    ) -> "ManyEngines":
        """Compare the sweeps of those that gave any, by engine."""
        found = side_by_side(exact, dict(sweeps))
        outcomes = [
            _compared(one, found.against[one.name]) if one.name in sweeps else one for one in asked
        ]
        roles = {one.name: one.role for one in asked}
        return cls(case, exact, outcomes, found, split(exact, sweeps, roles), budget)

    @property
    def agree(self) -> bool:
        """Whether all engines gave readings that agree with the closed form."""
        return all(one.agrees for one in self.outcomes)

    def parts(self) -> dict[str, dict[str, float]]:
        """What the disagreement is split into: by the twin, by other models, by the budget."""
        parts = {} if self.split is None else self.split.parts()
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
            "engines": [*self.outcomes],
            "split": None if self.split is None else self.split.to_dict(),
            "parts": self.parts(),
            **self.found.to_dict(),
        }


def _compared(one: EngineOutcome, found: Comparison) -> EngineOutcome:
    apart = found.snap_off.difference
    return replace(
        one,
        rms={name: found.disagreement[name].rms for name in CLAMP_READINGS},
        snap_off_apart=None if apart is None else apart / found.reference.beam.length,
        seconds_a_station=seconds_per_station(found.candidate),
        agrees=found.agrees,
        likely="; ".join(_causes(found)),
    )


def _causes(found: Comparison) -> Iterator[str]:
    """Why it disagrees, and why stations of its own are not to be trusted."""
    if not found.agrees:
        yield f"likely {found.likely}" if found.likely else "the readings alone do not show why"
    unsettled = found.candidate.provenance.get("unsettled") or {}
    if unsettled:
        most = max(unsettled, key=unsettled.__getitem__)
        yield f"{sum(unsettled.values())} stations unsettled, mostly as {most}"


def write_engines(many: ManyEngines, folder: Path) -> list[Path]:
    """Write the page, its numbers, and the picture of error against time."""
    document = engines_document(many)
    timed, _ = document.pictures()
    return [
        write_whole(folder / "engines.html", html(document)),
        write_whole(folder / "engines.json", as_json(many.to_dict())),
        write_whole(folder / "engines.png", png(next(iter(timed.figures.values())))),
    ]


def engines_document(many: ManyEngines) -> Document:
    """All that there is to say of a case in many engines."""
    count = len(many.outcomes)
    object_ = many.exact.provenance.get("profile") or "Contour not recorded"
    return Document(
        f"{many.case.name} in {count} engine{'s' if count > 1 else ''}",
        f"{object_}; {len(many.exact.table)} stations. Differences are root mean squares over the "
        "stations in contact, relative to each reading's largest magnitude.",
        Verdict(
            many.agree,
            f"{'All' if many.agree else 'Not all'} agree with the closed form.",
            "" if many.split is None else many.split.sentence,
        ),
        sections(
            ("engines", "Engines", _engines(many)),
            ("split", "What the disagreement is made of", _split(many)),
            ("fairness", "What was set for each engine, and by whom", [_fairness(many)]),
        ),
    )


def outcomes_table(found: Mapping[str, Sequence[EngineOutcome]]) -> Table:
    """Each engine against the closed form, by case."""
    rows = {
        case: [
            (
                f"{one.name} {one.version}, {one.role}",
                *(short(one.rms[name]) if one.rms else "none" for name in CLAMP_READINGS),
                short(one.snap_off_apart),
                "none" if one.seconds_a_station is None else f"{1e3 * one.seconds_a_station:.2g}",
                one.trouble or "; ".join(filter(None, (_verdict(one), one.likely))),
            )
            for one in outcomes
        ]
        for case, outcomes in found.items()
    }
    head = ("engine", *CLAMP_READINGS, "snap-off apart / L", "ms a station", "")
    caption = "Each engine against the closed form, relative rms"
    return Table(caption, ("case", *head), _by_case(rows), words=(0, 1, 7))


def _verdict(one: EngineOutcome) -> str:
    return "agrees" if one.agrees else "disagrees"


def parts_table(found: Mapping[str, Mapping[str, Mapping[str, float]]]) -> Table:
    """What the disagreement is made of, by case."""
    rows = {
        case: [(part, *(short(rms[name]) for name in CLAMP_READINGS)) for part, rms in of.items()]
        for case, of in found.items()
    }
    head = ("case", "part", *CLAMP_READINGS)
    caption = "What the disagreement is made of, relative rms"
    return Table(caption, head, _by_case(rows), words=(0, 1))


def _by_case(found: Mapping[str, Sequence[tuple[str, ...]]]) -> list[tuple[str, ...]]:
    return [(case, *row) for case, rows in found.items() for row in rows]


def _engines(many: ManyEngines) -> Iterator[Block]:
    yield outcomes_table({many.case.name: many.outcomes})
    yield from between_table(many.found)
    yield Picture(
        "time",
        {"Error against time a station, a mark an engine": partial(error_against_time, many)},
        "Error against time. Processor time of one process; an engine that is not tuned for this "
        "can be faster.",
    )
    caption = "Differences from the closed form over the foot position."
    yield Picture(
        "apart", {"Differences over the foot position": partial(picture, many.found)}, caption
    )


def _split(many: ManyEngines) -> Iterator[Block]:
    if many.parts():
        yield parts_table({many.case.name: many.parts()})
        yield Text(
            "A twin computes the same discrete model with the same settings, so what it differs by "
            "is implementation. The model's part is what the twin differs by from the closed form. "
            "Budget parts are MuJoCo's: discretisation, facets, softness and unrest, measured by "
            "controlled changes.",
            aside=True,
        )


def _fairness(many: ManyEngines) -> Table:
    made = "All settings were made by the authors of this page's program, not by the engines' own"
    rows = [(one.name, one.tuned) for one in many.outcomes]
    return Table(f"{made} developers", ("engine", "what was set"), rows, words=(0, 1))


def error_against_time(many: ManyEngines) -> Figure:
    """Draw the rms of each reading against the time a station, for all engines."""
    figure = Figure(figsize=(7, 4.4), layout="constrained")
    ax = figure.subplots()
    ax.set(
        xscale="log",
        yscale="log",
        xlabel="processor time a station [ms], building the model included",
        ylabel="rms relative to the largest magnitude",
    )
    ax.set_title(f"{style.label(many.case.name)}: error against time", fontsize=style.LARGE)
    named = set()
    for one in many.outcomes:
        if one.rms is None:
            continue
        # One that records no time is a mark at the right edge.
        timed = one.seconds_a_station is not None
        x = 1e3 * one.seconds_a_station if one.seconds_a_station is not None else _EDGE
        across = ax.transData if timed else ax.get_yaxis_transform()
        for reading, rms in one.rms.items():
            said = "_" if reading in named else style.SYMBOLS[reading]
            colour, marker = style.READING_COLOURS[reading], style.READING_MARKERS[reading]
            ax.plot(x, rms, marker, color=colour, label=said, transform=across)
            named.add(reading)
        ax.annotate(
            style.label(one.name) + ("" if timed else ", no time"), (x, max(one.rms.values())),
            (0, 8), xycoords=across, textcoords="offset points",
            ha="center" if timed else "right", fontsize=style.SMALL,
        )  # fmt: skip
    ax.margins(0.25)
    ax.grid(which="both", alpha=0.25)
    if named:
        ax.legend(frameon=False, fontsize=style.SMALL)
    return figure
