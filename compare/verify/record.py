"""The quoted numbers of all sources, each beside ours: how many digits agree, and why not more."""

import math
import tomllib
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any, Literal, TypeAlias

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
        """Of ours, relative to theirs."""
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
    return Row(
        source["name"],
        source["cite"],
        source.get("contact", False),
        row["what"],
        printed or row["against"],
        theirs,
        ours,
        agree,
        state,
        why,
        explained[row["value"]] if "because" in row else None,
    )


def _digits(relative: float) -> int:
    """Significant digits that a relative difference leaves; none if there is no number."""
    if relative == 0:
        return _FORMULA
    return math.floor(-math.log10(2 * relative)) if relative < 0.5 else 0
