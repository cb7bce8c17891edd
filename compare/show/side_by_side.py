"""Sweeps of one case side by side, of engines or from files: one page, one table, one picture."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from analytic import CLAMP_READINGS, Readings
from compare.comparison import Comparison, compare
from compare.explain.budget import Budget
from compare.explain.split import Split, split
from compare.read.runs import EngineOutcome
from compare.show import style
from compare.show.document import Block, Document, Items, Picture, Table, Text, Verdict, sections
from compare.show.figures.over_foot import foot_label, key_below, shade_reference
from compare.show.numbers import object_of, short
from compare.show.page import Content, write_all

_EDGE = 0.97  # of the picture's width


@dataclass(frozen=True)
class SideBySide:
    case: str  # what was swept
    outcomes: Sequence[EngineOutcome]  # in the order in which they were asked for
    against: dict[str, Comparison]  # each sweep against the reference, by its name
    # Each sweep against each one before it, by both names.
    between: dict[tuple[str, str], Comparison]
    split: Split | None  # implementation and model, if MuJoCo and a twin of it are there
    budget: Budget | None  # what MuJoCo's disagreement is made of, if it was measured

    @classmethod
    def of(
        cls,
        reference: Readings,
        sweeps: Mapping[str, Readings],
        asked: Sequence[EngineOutcome] = (),
        budget: Budget | None = None,
        case: str = "Sweeps",
    ) -> "SideBySide":
        """Compare sweeps by name; those that were asked for may have given none."""
        against = {name: compare(reference, one) for name, one in sweeps.items()}
        pairs = combinations([name for name, one in against.items() if _settled(one)], 2)
        between = {(one, other): compare(sweeps[one], sweeps[other]) for one, other in pairs}
        asked = asked or [EngineOutcome(name) for name in sweeps]
        parts = split(reference, sweeps, {one.name: one.role for one in asked})
        outcomes = [_compared(x, against[x.name]) if x.name in sweeps else x for x in asked]
        return cls(case, outcomes, against, between, parts, budget)

    @property
    def reference(self) -> Readings:
        return next(iter(self.against.values())).reference

    @property
    def agree(self) -> bool:
        """Whether all gave readings that agree with the reference."""
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
        source = self.reference.source
        found = {(source, name): one for name, one in self.against.items()} | self.between
        return {
            "case": self.case,
            "engines": [*self.outcomes],
            "split": None if self.split is None else self.split.to_dict(),
            "parts": self.parts(),
            "comparisons": [{"names": [*names], **one.to_dict()} for names, one in found.items()],
        }


def _compared(one: EngineOutcome, found: Comparison) -> EngineOutcome:
    apart, seconds = found.snap_off.difference, found.candidate.provenance.get("seconds")
    return replace(
        one,
        rms={n: found.disagreement[n].rms for n in CLAMP_READINGS} if _settled(found) else None,
        snap_off_apart=None if apart is None else apart / found.reference.running_unit[0],
        seconds_a_station=None if seconds is None else seconds / len(found.candidate.table),
        agrees=found.agrees,
        likely="; ".join(_causes(found)),
    )


def _settled(found: Comparison) -> bool:
    """Whether more stations are compared than are not to be trusted: else no figure says much."""
    counts = found.alignment.counts
    return counts["compared"] >= counts["untrusted"]


def _causes(found: Comparison) -> Iterator[str]:
    """Why it disagrees, and why stations of its own are not to be trusted."""
    if not _settled(found):
        stations = len(found.candidate.table)
        yield f"no figures: {found.stations} of {stations} stations can be compared"
    elif not found.agrees:
        yield f"likely {found.likely}" if found.likely else "the readings alone do not show why"
    unsettled = found.candidate.provenance.get("unsettled") or {}
    if unsettled:
        most = max(unsettled, key=unsettled.__getitem__)
        yield f"{sum(unsettled.values())} stations unsettled, mostly as {most}"


def write_side_by_side(found: SideBySide, folder: Path, called: str) -> list[Path]:
    document = side_by_side_document(found)
    drawn = error_against_time(found) if _timed(found) else differences(found)
    contents: dict[str, Content] = {".html": document, ".json": found.to_dict(), ".png": drawn}
    return write_all(folder, {f"{called}{end}": content for end, content in contents.items()})


def side_by_side_document(found: SideBySide) -> Document:
    reference = found.reference
    return Document(
        f"{found.case} side by side: {', '.join(one.name for one in found.outcomes)}",
        f"{object_of(reference)}; {len(reference.table)} stations. Differences are root mean "
        "squares over the stations in contact, relative to each reading's largest magnitude.",
        Verdict(found.agree, _tally(found), "" if found.split is None else found.split.sentence),
        sections(
            ("engines", "Sweeps", _sweeps(found)),
            ("split", "What the disagreement is made of", _split(found)),
            ("fairness", "What was set for each engine, and by whom", _fairness(found)),
        ),
    )


def _tally(found: SideBySide) -> str:
    agree = sum(one.agrees for one in found.outcomes)
    none = sum(one.trouble is not None for one in found.outcomes)
    agrees = f"{agree} of {len(found.outcomes)} agree{'s' * (agree == 1)}"
    no_readings = f", {none} gave no readings" if none else ""
    return f"{agrees} with {_named(found.reference)}{no_readings}."


def _named(reference: Readings) -> str:
    return "the closed form" if reference.source == "analytic" else reference.source


def summary(found: SideBySide) -> Iterator[Block]:
    """Each sweep against the reference and each other, and what their differences are made of."""
    yield from _each(found)
    if found.parts():
        yield parts_table({found.case: found.parts()})


def _each(found: SideBySide) -> Iterator[Block]:
    yield outcomes_table({found.case: found.outcomes}, _named(found.reference))
    yield from reasons(found.outcomes)
    rows = [
        (f"{one}, {other}", *(short(pair.disagreement[name].rms) for name in CLAMP_READINGS))
        for (one, other), pair in found.between.items()
    ]
    if rows:
        yield Table("Each other, relative rms", ("pair", *CLAMP_READINGS), rows)


def outcomes_table(
    found: Mapping[str, Sequence[EngineOutcome]], reference: str = "the closed form"
) -> Table:
    rows = {case: [_outcome(one) for one in outcomes] for case, outcomes in found.items()}
    head = ("sweep", "", *CLAMP_READINGS, "snap-off apart / L", "ms a station")
    caption = f"Each against {reference}, relative rms"
    return _by_case(caption, head, rows, [0, 1])


def _outcome(one: EngineOutcome) -> tuple[str, ...]:
    rms = (short(one.rms[name]) if one.rms else "none" for name in CLAMP_READINGS)
    seconds = one.seconds_a_station
    time = "none" if seconds is None else f"{1e3 * seconds:.2g}"
    said = "no readings" if one.trouble else "agrees" if one.agrees else "disagrees"
    return (one.label, said, *rms, short(one.snap_off_apart), time)


def reasons(found: Iterable[EngineOutcome]) -> Iterator[Items]:
    """Why sweeps are missing, disagree, or are not to be trusted everywhere."""
    said = [f"{one.name}: {why}" for one in found if (why := one.trouble or one.likely)]
    if said:
        yield Items(said)


def parts_table(found: Mapping[str, Mapping[str, Mapping[str, float]]]) -> Table:
    rows = {
        case: [(part, *(short(rms[name]) for name in CLAMP_READINGS)) for part, rms in of.items()]
        for case, of in found.items()
    }
    head = ("part", *CLAMP_READINGS)
    return _by_case("What the disagreement is made of, relative rms", head, rows, [0])


def _by_case(
    caption: str, head: Sequence[str], found: Mapping[str, list[tuple[str, ...]]], words: list[int]
) -> Table:
    """The rows of all cases, with a column of the case if there are several."""
    if len(found) == 1:
        (rows,) = found.values()
        return Table(caption, head, rows, words)
    named = [(case, *row) for case, rows in found.items() for row in rows]
    return Table(caption, ("case", *head), named, [0, *(i + 1 for i in words)])


def _sweeps(found: SideBySide) -> Iterator[Block]:
    yield from _each(found)
    if _timed(found):
        yield Picture(
            "time",
            {"Error against time a station, a mark an engine": partial(error_against_time, found)},
            "Error against time. Processor time of one process; an engine that is not tuned for "
            "this can be faster.",
            "middle",
        )
    yield Picture(
        "apart",
        {
            f"Differences of {name} over the foot position": partial(differences, found, name)
            for name in CLAMP_READINGS
        },
        "Differences from the reference over the foot position.",
        "three",
    )


def _timed(found: SideBySide) -> bool:
    """Whether there is more than one engine, for one to be faster."""
    return sum(bool(one.role and one.rms) for one in found.outcomes) > 1


def _split(found: SideBySide) -> Iterator[Block]:
    if found.parts():
        yield parts_table({found.case: found.parts()})
        yield Text(
            "A twin computes the same discrete model with the same settings, so what it differs by "
            "is implementation. The model's part is what the twin differs by from the closed form. "
            "Budget parts are MuJoCo's: discretisation, facets, softness and unrest, measured by "
            "controlled changes.",
            aside=True,
        )


def _fairness(found: SideBySide) -> Iterator[Block]:
    made = "All settings were made by the authors of this page's program, not by the engines' own"
    rows = [(one.name, one.tuned) for one in found.outcomes if one.tuned]
    if rows:
        yield Table(f"{made} developers", ("engine", "what was set"), rows, words=(0, 1))


def error_against_time(found: SideBySide) -> Figure:
    figure = Figure(figsize=(5.6, 4.0), layout="constrained")
    ax = figure.subplots()
    ax.set(xscale="log", yscale="log", ylabel="rms relative to the largest magnitude")
    ax.set_xlabel("processor time a station [ms], building the model included")
    ax.set_title(f"{style.label(found.case)}: error against time", fontsize=style.LARGE)
    for one in found.outcomes:
        if one.rms is None:
            continue
        # One that records no time is a mark at the right edge.
        x, across, where, more = _EDGE, ax.get_yaxis_transform(), "right", ", no time"
        if one.seconds_a_station is not None:
            x, across, where, more = 1e3 * one.seconds_a_station, ax.transData, "center", ""
        for reading, rms in one.rms.items():
            colour, marker = style.READING_COLOURS[reading], style.READING_MARKERS[reading]
            name = style.SYMBOLS[reading]
            ax.plot(x, rms, marker, color=colour, label=name, transform=across)
        ax.annotate(
            style.label(one.name) + more, (x, max(one.rms.values())), (0, 8), xycoords=across,
            textcoords="offset points", ha=where, fontsize=style.SMALL,
        )  # fmt: skip
    ax.margins(0.25)
    ax.grid(which="both", alpha=0.25)
    handles, names = ax.get_legend_handles_labels()
    named = dict(zip(names, handles, strict=True))  # each once
    if named:
        ax.legend(named.values(), named, frameon=False, fontsize=style.SMALL)
    return figure


def differences(found: SideBySide, *names: str) -> Figure:
    """Draw how far the readings, or some, are from the reference's, over the foot position."""
    names = names or CLAMP_READINGS
    figure = Figure(figsize=(4 * len(names), 4.2), layout="constrained")
    axes = figure.subplots(1, len(names), sharex=True, squeeze=False)[0]
    first = next(iter(found.against.values()))
    for ax, name in zip(axes, names, strict=True):
        shade_reference(ax, first)
        for i, (candidate, one) in enumerate(found.against.items()):
            table = one.alignment.table
            error = table[f"{name}_candidate"] - table[f"{name}_reference"]
            ax.plot(
                table["at"].to_numpy() / first.reference.running_unit[0],
                error.to_numpy() / one.disagreement[name].scale,
                color=style.SERIES[i % len(style.SERIES)],
                linestyle=style.LINE_STYLES[i % len(style.LINE_STYLES)],
                label=style.label(candidate),
            )
        ax.ticklabel_format(axis="y", scilimits=(-2, 2))
        ax.set_title(style.SYMBOLS[name], fontsize=style.LARGE)
        ax.set_xlabel(foot_label(first.reference))
    axes[0].set_ylabel(
        f"difference from {style.label(found.reference.source)}\nrelative to largest magnitude"
    )
    key_below(figure, axes[0], min(len(found.against), 4))
    return figure
