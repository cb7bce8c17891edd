"""What the pages of all comparisons have: how a verdict is led to, limits, settings."""

from collections.abc import Iterator, Mapping
from typing import Any

from analytic import Readings
from analytic.space import SpatialReadings
from compare.comparison import Comparison
from compare.comparison_in_space import SpatialComparison
from compare.judge.tolerances import Limit
from compare.show.document import Block, Table, Text, Tile, Verdict
from compare.show.numbers import place, sentence, short, words

PHASE_KEY = "A: tip contact, B: tangential contact"

_BULKY = ("contour", "events", "joints", "path")  # of a source's provenance; they are drawn instead
_BEAM = ("length", "flexural_rigidity", "radius")
_LONGEST = 200  # characters of a setting
_OF_LARGEST = "of the reading's largest magnitude"
_LIMITED = {
    "snap_off_window": "of the sweep's length",
    "phase_agreement": "of the stations",
    "transition": "L",
    "snap_off": "L",
    "lateness": "L",
    "contact": "L",
    "event": "L",
    "untrusted": "of the stations",
}
"""What a limit is a number of; all others are of a reading's largest magnitude."""


def agreement(comparison: Comparison | SpatialComparison, said: str, why: str = "") -> Verdict:
    """Whether the two agree, and why not."""
    agrees = "agrees" if comparison.agrees else "disagrees"
    return Verdict(
        comparison.agrees,
        f"{comparison.candidate.source} {agrees} with {comparison.reference.source}.",
        said,
        "" if comparison.agrees else sentence(why),
        comparison.failures,
        [sentence(comparison.remark)] if comparison.remark else [],
    )


def sizes(comparison: Comparison | SpatialComparison, worst: str, where: str) -> Iterator[Tile]:
    """How large the worst disagreement is."""
    found = comparison.disagreement[worst]
    at = where.format(place(found.at / comparison.reference.beam.length))
    yield Tile("worst disagreement, rms", short(found.rms), f"{worst}, of the largest magnitude")
    known = at if found.at == found.at else "at no station"
    yield Tile("largest single difference", short(found.max), f"{worst}, {known}")


def limits(allowed: Mapping[str, Limit], remark: str = "") -> tuple[str, str, list[Block]]:
    """The limits of a verdict, what they are numbers of, and why they are as large as they are."""
    rows = [
        (words(name), f"{limit:g}", _LIMITED.get(name, _OF_LARGEST), limit.reason)
        for name, limit in allowed.items()
    ]
    head = ("tolerance", "limit", "unit", "reason")
    blocks: list[Block] = [Table("Limits of the verdict", head, rows, words=(0, 2, 3))]
    if remark:
        blocks.append(Text(sentence(remark), aside=True))
    return "tolerances", "Tolerances, and why", blocks


def settings(
    reference: Readings | SpatialReadings, candidate: Readings | SpatialReadings
) -> tuple[str, str, list[Block]]:
    """What is recorded of both sweeps, side by side."""
    sweeps = (_recorded(reference), _recorded(candidate))
    names = dict.fromkeys(name for sweep in sweeps for name in sweep)
    rows = [(words(name), *(sweep.get(name, "") for sweep in sweeps)) for name in names]
    head = ("", f"reference: {reference.source}", f"candidate: {candidate.source}")
    table = Table("As recorded by the source of each sweep", head, rows, words=(0, 1, 2))
    return "settings", "Settings and versions", [table]


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
