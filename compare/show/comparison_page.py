"""What the pages of all comparisons, in the plane and in space, have in common."""

from collections.abc import Iterable, Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np

from analytic import PHASES, Readings
from analytic.space import SpatialReadings
from compare.comparison import Comparison, SpatialComparison
from compare.explain.budget import Budget
from compare.explain.parts import UNRESOLVED, Parted
from compare.judge.tolerances import CONVENTION, Limit
from compare.sense.occurrence import Occurrence
from compare.show.budgets import bars, budget_summary, left_over, phases_table
from compare.show.document import Block, Document, Picture, Table, Text, Tile, Verdict, sections
from compare.show.numbers import place, quantity, sentence, short, words
from compare.show.style import ALONG, PHASE_LETTERS, Along

# Of a source's provenance; they are drawn instead.
_BULKY = ("contour", "others", "events", "joints", "path")
_BEAM = ("length", "flexural_rigidity", "radius")
_LONGEST = 200  # characters of a setting
_OF_LARGEST = "of the reading's largest magnitude"
_LIMITED = {
    "snap_off_window": "of the sweep's length",
    "phase_agreement": "of the stations",
    "contact": "L",
    "untrusted": "of the stations",
}
"""What a limit is a number of; all others are of a reading's largest magnitude."""
_PLACES = ("transition", "snap_off", "lateness", "event")  # of places along the sweep


def document(
    found: Comparison | SpatialComparison,
    about: str,
    verdict: Verdict,
    tiles: Iterable[Tile],
    budget: Parted | None,
    *parts: tuple[str, str, Iterable[Block]],
) -> Document:
    """All that there is to say of a comparison, the sections of its own before the common ones."""
    reference, beam = found.reference, found.reference.beam
    length = quantity(beam.length, "length", beam)
    force = quantity(beam.force_unit, "force", beam)
    moment = quantity(beam.moment_unit, "moment", beam)
    own = "" if beam.si else " of the readings' own units"
    case = reference.provenance.get("case") or "a sweep"
    return Document(
        f"{case}: {found.candidate.source} against {reference.source}",
        f"{about} Lengths are given in L = {length}, forces in EI/L² = {force} and moments in "
        f"EI/L = {moment}{own}.",
        verdict,
        sections(
            ("budget", "What the disagreement is made of", _parts(budget)),
            *parts,
            ("tolerances", "Tolerances, and why", _limits(found)),
            ("settings", "Settings and versions", _settings(found)),
        ),
        [*tiles],
    )


def agreement(found: Comparison | SpatialComparison, said: str, why: str = "") -> Verdict:
    """Whether the two agree, and why not; the table of what is apart has the rest of it."""
    agrees = "agrees" if found.agrees else "disagrees"
    claim = f"{found.candidate.source} {agrees} with {found.reference.source}."
    likely = "" if found.agrees else sentence(why)
    elsewhere = (found.worst, *(one for one in found.exceeded if one.overall))
    failures = [str(one) for one in found.exceeded if one not in elsewhere]
    remarks = [*map(sentence, found.remarks)]
    return Verdict(found.agrees, claim, said, likely, failures, remarks)


def along(found: Comparison | SpatialComparison) -> Along:
    """What is said of the column over which the sweeps run."""
    return ALONG[found.reference.running]


def sizes(found: Comparison | SpatialComparison, worst: str) -> Iterator[Tile]:
    """How large the worst disagreement is."""
    one = found.disagreement[worst]
    if not one.stations:
        return
    yield Tile("worst disagreement, rms", short(one.rms), f"{worst}, of the largest magnitude")
    name, one = max(found.disagreement.items(), key=lambda each: each[1].max)
    at = along(found).at.format(place(one.at / found.reference.running_unit[0]))
    yield Tile("largest single difference", short(one.max), f"{name}, {at}")


def unexplained(budget: Parted | None) -> Iterator[Tile]:
    """What a budget leaves, if there is one."""
    if budget is not None:
        still_open = "is undecided" if budget.undecided else "does not close"
        said = "closes" if budget.closes else still_open
        yield Tile("stays unexplained", left_over(budget), f"the budget {said}")


def apart_table(found: Comparison | SpatialComparison) -> Iterator[Table]:
    """How far apart the two are, reading by reading and by phase, if any station shows it."""
    if not found.stations:
        return
    beam, (size, unit_along) = found.reference.beam, found.reference.running_unit
    there = {phase for one in found.disagreement.values() for phase in one.rms_by_phase}
    phases = [phase for phase in PHASES if phase in there]
    units = {"f": (beam.force_unit, "EI/L²"), "m": (beam.moment_unit, "EI/L")}
    exceeded = {one.name for one in found.exceeded if one.overall}
    near_snap_off = not np.isnan([x.max_before_snap_off for x in found.disagreement.values()]).all()
    rows = []
    for name, one in found.disagreement.items():
        unit, symbol = units[name[0]]
        allowed = found.noise.rms(found.tolerances.of(name, "rms"), name, one.stations)
        row = {"reading": name, "rms": short(one.rms), "limit": short(allowed)}
        row |= {f"rms, {PHASE_LETTERS[p]}": short(one.rms_by_phase.get(p)) for p in phases}
        row |= {"max": short(one.max), f"max at / {unit_along}": place(one.at / size)}
        if near_snap_off:
            row["max at snap-off"] = short(one.max_before_snap_off)
        rows.append(row | {"largest magnitude": f"{one.scale / unit:.4g} {symbol}"})
    yield Table(
        "Candidate less reference, relative to the largest magnitude at a station of the "
        "reference; A: tip contact, B: tangential contact",
        [*rows[0]],
        [[*row.values()] for row in rows],
        blamed=[i for i, name in enumerate(found.disagreement) if name in exceeded],
    )


def places_table(
    found: Comparison | SpatialComparison, caption: str, events: Mapping[str, Occurrence]
) -> Table:
    size, _ = found.reference.running_unit
    unsure = any(pair.uncertainty for pair in events.values())
    rows = []
    for name, pair in events.items():
        known = (pair.reference, pair.candidate, pair.difference)
        ours, theirs, apart = (None if x is None else x / size for x in known)
        row = [words(name), place(ours), place(theirs), short(apart)]
        if unsure:
            row.append(short(pair.uncertainty / size) if pair.uncertainty else "")
        rows.append(row)
    head = ["", found.reference.source, found.candidate.source, "difference"]
    return Table(caption, [*head, "uncertainty"] if unsure else head, rows)


def _parts(budget: Parted | None) -> Iterator[Block]:
    if budget is None:
        return
    table, *said = budget_summary(budget)
    yield from said
    shows = "Bars: the parts of {}'s disagreement; the table below has the numbers"
    yield Picture(
        "budget-bars",
        {shows.format(name): partial(bars, budget, name) for name in budget.disagreement},
        "Each part is measured by a controlled change of its own and combines with the others as a "
        "signal over the sweep, so sizes do not add up; the axis is logarithmic. Orange: the "
        "largest part. Last: what no part explains. Whiskers: uncertainty. Dashed: the whole "
        f"disagreement. Grey: less than {short(UNRESOLVED)} is not resolved.",
        "three",
    )
    yield table
    if isinstance(budget, Budget):
        yield phases_table(budget)


def _limits(found: Comparison | SpatialComparison) -> Iterator[Block]:
    """The limits of a verdict, what they are numbers of, and why they are as large as they are."""
    allowed: dict[str, Limit] = found.tolerances.limits()
    units = _LIMITED | dict.fromkeys(_PLACES, found.reference.running_unit[1])
    rows = [
        (words(name), f"{limit:g}", units.get(name, _OF_LARGEST), limit.reason)
        for name, limit in allowed.items()
    ]
    head = ("tolerance", "limit", "unit", "reason")
    yield Table("Limits of the verdict", head, rows, words=(0, 2, 3))
    if isinstance(found, Comparison) and found.agrees and found.tolerances.conventional:
        yield Text(sentence(CONVENTION), aside=True)


def _settings(found: Comparison | SpatialComparison) -> Iterator[Table]:
    sweeps = (_recorded(found.reference), _recorded(found.candidate))
    names = dict.fromkeys(name for sweep in sweeps for name in sweep)
    rows = [(words(name), *(sweep.get(name, "") for sweep in sweeps)) for name in names]
    head = ("", f"reference: {found.reference.source}", f"candidate: {found.candidate.source}")
    yield Table("As recorded by the source of each sweep", head, rows, words=(0, 1, 2))


def _recorded(readings: Readings | SpatialReadings) -> dict[str, str]:
    beam = {words(name): getattr(readings.beam, name) for name in _BEAM}
    provenance: dict[str, Any] = dict(readings.provenance)
    if isinstance(readings, Readings):
        beam |= readings.beyond_the_paper
        provenance.pop("support", None)
    settings = provenance.pop("settings", {})
    numerics = settings if isinstance(settings, Mapping) else {"settings": settings}
    recorded = {
        "vibrissa": ", ".join(f"{name} {value:g}" for name, value in beam.items()),
        "stations": len(readings.table),
        **{name: value for name, value in provenance.items() if name not in _BULKY},
        **numerics,
    }
    return {str(name): _value(value) for name, value in recorded.items() if value is not None}


def _value(value: object) -> str:
    text = f"{value:.6g}" if isinstance(value, float) else str(value)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…"
