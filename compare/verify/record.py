"""The quoted numbers of all sources, each beside ours: how many digits agree, and why not more."""

import math
import tomllib
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from functools import partial
from itertools import groupby
from pathlib import Path
from typing import Any, Literal, TypeAlias

from matplotlib.figure import Figure

from compare.show.document import Document, Picture, Section, Table, Text, Tile, Verdict
from compare.show.style import BLUE, FAINT, GREEN, ORANGE, PAGE_WIDTH, PINK, SKY, SMALL
from compare.verify import contacts, rods

State: TypeAlias = Literal["all digits", "explained", "fitted", "open", "differs"]
_EDGE = 1 + 1e-9  # a number half-way between two printed ones rounds to either
_FORMULA, _ROUNDED = 14, 5e-15  # digits that a formula has in double precision, and half the last
_SHARED = "because", "state", "within"  # what a source may give for all its rows
_MODELS: Mapping[str, Callable[..., rods.Parts]] = vars(rods) | vars(contacts)


@dataclass(frozen=True)
class Row:
    source: str
    cite: str
    contact: bool  # whether the source is about contact or whiskers
    what: str
    quoted: str  # as printed, or the name of the formula
    theirs: float
    ours: float
    digits: int  # that agree
    state: State
    why: str
    because: float | None = None  # ours with what is said to make the difference

    @property
    def difference(self) -> float:
        return abs(self.ours - self.theirs) / abs(self.theirs)


def sources() -> list[dict[str, Any]]:
    file = Path(__file__).with_name("sources.toml")
    return list(tomllib.loads(file.read_text(encoding="utf-8"))["source"])


def verify(given: Iterable[Mapping[str, Any]]) -> Iterator[Row]:
    """The rows of these sources, one after the other as they are computed."""
    for source in given:
        known: dict[str, rods.Parts] = {}
        shared = {key: source[key] for key in _SHARED if key in source}
        for row in ({**shared, **row} for row in source["row"]):
            arguments = {**source.get("given", {}), **row.get("at", {})}
            made = []
            for one in (arguments, {**arguments, **row.get("because", {})}):
                if repr(one) not in known:
                    known[repr(one)] = _made(source["model"], one)
                made.append(known[repr(one)])
            yield _judged(source, row, *made)


def _made(model: str, given: Mapping[str, Any]) -> rods.Parts:
    """The model's numbers; none of them where a solver gives up, which differs from any."""
    try:
        return _MODELS[model](**given)
    except (ArithmeticError, LookupError, ValueError):
        return defaultdict(lambda: math.nan)


def _judged(
    source: Mapping[str, Any], row: Mapping[str, Any], made: rods.Parts, explained: rods.Parts
) -> Row:
    ours, printed = made[row["value"]], row.get("quoted")
    theirs = made[row["against"]] if printed is None else float(printed)
    if "coarser" in row:  # of half as many elements: their limit, of second order
        theirs += (theirs - float(row["coarser"])) / 3
    missed = abs(ours - theirs)
    whole, last = _FORMULA, _ROUNDED * abs(theirs)
    if printed is not None:
        number = Decimal(printed).as_tuple()
        whole, last = len(number.digits), 0.5 * 10.0 ** int(number.exponent)
    left = abs(explained[row["value"]] - theirs)  # by the reason, where it can be computed
    state: State = "differs"
    if missed <= _EDGE * last:
        state = "fitted" if row.get("state") == "fitted" else "all digits"
    elif left <= max(_EDGE * last, row.get("within", 0.0)):
        state = row.get("state", "explained")
    agree = whole if missed <= _EDGE * last else min(whole, _digits(missed / abs(theirs)))
    why = row.get("why", "" if state == "all digits" else source.get("why", ""))
    about = source["name"], source["cite"], source.get("contact", False), row["what"]
    because = explained[row["value"]] if "because" in row else None
    quoted = printed or row["against"]
    return Row(*about, quoted, theirs, ours, agree, state, why, because)


def _digits(relative: float) -> int:
    """Significant digits that a relative difference leaves; none if there is no number."""
    if relative == 0:
        return _FORMULA
    return math.floor(-math.log10(2 * relative)) if relative < 0.5 else 0


_COLOURS: dict[State, str] = {
    "all digits": GREEN,
    "explained": BLUE,
    "fitted": SKY,
    "open": ORANGE,
    "differs": PINK,
}
_COUNTED = {"all digits": "agree in all digits", "differs": "differ by more than is stated"}
_LEAST = 1e-16  # of a difference that is drawn
_LINE = 0.19  # inches


def verified(rows: Sequence[Row]) -> Document:
    sources = {row.source for row in rows if row.state in ("all digits", "explained")}
    contact = {row.source for row in rows if row.contact} & sources
    tiles = [
        Tile("sources that agree", str(len(sources)), f"{len(contact)} on contact or whiskers"),
        *(Tile(state, str(_count(rows, state)), f"of {len(rows)} numbers") for state in _COLOURS),
    ]
    picture = Picture("verify", {_CAPTION: partial(drawn, rows)}, _CAPTION)
    return Document(
        "Checked by strangers",
        "What others printed, measured or derived, beside what is computed here.",
        verdict(rows),
        [
            Section("numbers", "Number by number", [table(rows)]),
            Section("picture", "How far apart", [picture]),
            Section("sources", "Sources", [_sources(rows)]),
            Section("meaning", "How to read it", [Text(_MEANING)]),
        ],
        tiles,
    )


_CAPTION = "How far each number here is from the quoted one; 1e-16 stands for less."
_MEANING = (
    "A number agrees in all digits if ours rounds to the printed one. Explained: it does not, but "
    "the difference is no larger than what the reason on its line makes; where that is computed, "
    "the number with it in stands there too. Fitted: only with a constant that was set by the "
    "source's own numbers, which shows nothing on its own. Open: the difference has no reason "
    "here, and is no larger than when it was found. Differs: it is larger than is stated, and the "
    "exit code is 1."
)


def verdict(rows: Sequence[Row]) -> Verdict:
    """Whether any number differs by more than is known."""
    said: dict[State, list[str]] = {state: [] for state in _COLOURS}
    for row in rows:
        line = f"{row.source}, {row.what}: {row.quoted}, here {row.ours:.{row.digits + 3}g}"
        said[row.state].append(f"{row.state}: {line}; {_why(row)}".rstrip("; "))
    wrong = said["differs"]
    counts = ", ".join(f"{_count(rows, state)} {_COUNTED.get(state, state)}" for state in _COLOURS)
    claim = "All numbers agree, or differ for a known reason."
    if said["open"]:
        claim = f"No number differs by more than is stated; of {len(said['open'])} it is open why."
    if wrong:
        claim = "Some numbers differ by more than is stated."
    return Verdict(not wrong, claim, f"Of {len(rows)}: {counts}.", "", wrong, said["open"])


def table(rows: Sequence[Row]) -> Table:
    lines = []
    for row in rows:
        ours, why = f"{row.ours:.{max(row.digits + 2, 5)}g}", filter(None, (row.state, _why(row)))
        lines.append((row.source, row.what, row.quoted, ours, str(row.digits), ": ".join(why)))
    head = ("source", "number", "quoted", "here", "digits", "why not more")
    blamed = [number for number, row in enumerate(rows) if row.state == "differs"]
    return Table("What was quoted, and what is found", head, lines, (0, 1, 5), blamed)


def summary(rows: Sequence[Row]) -> Table:
    lines = []
    for name, group in groupby(rows, lambda row: row.source):
        found = list(group)
        digits = [row.digits for row in found]
        states = [str(_count(found, state) or "") for state in _COLOURS]
        lines.append((name, str(len(found)), f"{min(digits)} to {max(digits)}", *states))
    head = ("source", "numbers", "digits", *_COLOURS)
    return Table("What others printed, and what is found here", head, lines)


def drawn(rows: Sequence[Row]) -> Figure:
    figure = Figure(figsize=(PAGE_WIDTH, 1.2 + _LINE * len(rows)), layout="constrained")
    ax = figure.subplots()
    places = range(len(rows))
    for state, colour in _COLOURS.items():
        these = [place for place in places if rows[place].state == state]
        sizes = [max(rows[place].difference, _LEAST) for place in these]
        ax.plot(sizes, these, "o", color=colour, label=state)
    ax.set(xscale="log", xlabel="difference from the quoted number, relative")
    ax.set_yticks(places, [f"{row.source}: {row.what}" for row in rows], fontsize=SMALL)
    ax.set_ylim(len(rows) - 0.5, -0.5)
    ax.grid(axis="x", color=FAINT, alpha=0.35, linewidth=0.6)
    figure.legend(*ax.get_legend_handles_labels(), loc="outside upper center", ncols=5)
    return figure


def _why(row: Row) -> str:
    """The reason, and what comes with it in."""
    if row.because is None:
        return row.why
    return f"{row.why}: with it {row.because:.{max(row.digits + 4, 6)}g}"


def _sources(rows: Sequence[Row]) -> Table:
    cited = {row.source: row for row in rows}.values()
    lines = [(row.source, "contact" if row.contact else "rod", row.cite) for row in cited]
    return Table("Where the numbers stand", ("source", "about", "where"), lines, words=(0, 1, 2))


def _count(rows: Sequence[Row], state: State) -> int:
    return sum(row.state == state for row in rows)
