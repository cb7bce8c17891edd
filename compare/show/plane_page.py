"""What is said of a comparison in the plane: its verdict, and a section a question."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from analytic import CLAMP_READINGS, PHASES, Beam
from compare.comparison import Comparison
from compare.explain.budget import Budget
from compare.explain.parts import fitted_orders
from compare.show import comparison_page as common
from compare.show.budgets import convergence_picture, convergence_table
from compare.show.document import Beside, Block, Document, Film, Picture, Table, Text, Tile, Verdict
from compare.show.figures import readings as drawn
from compare.show.figures.geometry import geometry
from compare.show.numbers import object_of, percent, sentence, short, uncertain, words
from compare.show.style import PHASE_LETTERS, SYMBOLS
from compare.show.verdict import (
    absent_transitions,
    scope,
    validation_claim,
    validation_lines,
    validation_tables,
    verdict,
    why,
    worst_reading,
)

# Why a station is not compared, where the reason's name alone does not say it.
_BECAME = {
    "free": "free in both sweeps",
    "one_free": "free in one of the two sweeps",
    "outside": "beyond the reference",
    "reference_coarse": "where the reference's stations are too far apart",
    "between_phases": "between two phases of the reference",
}


def plane_document(
    comparison: Comparison, budget: Budget | None = None, film: Film | None = None
) -> Document:
    found = plane_verdict(comparison, budget)
    remarks = [*found.remarks, *scope(comparison), *[*validation_lines(comparison)][:1]]
    validation = "Validation: the disagreement against its uncertainty"
    return common.document(
        comparison,
        f"{object_of(comparison.reference)}; the figures rest on {comparison.stations} stations.",
        replace(found, remarks=remarks),
        plane_tiles(comparison, budget),
        budget,
        ("validation", validation, _validation(comparison)),
        ("apart", "How far apart, reading by reading", _apart(comparison)),
        ("sweep", "The sweep", _sweep(comparison, film)),
        ("phases", "Phases judged from the clamp", _phases(comparison)),
        ("snap-off", "Snap-off", _snap_off(comparison)),
        ("convergence", "Convergence", _convergence(budget)),
    )


def plane_verdict(comparison: Comparison, budget: Budget | None = None) -> Verdict:
    """Whether the two agree, and why not: the cause first, if it is known.

    Of a validation first whether there is anything to explain, given what is uncertain.
    """
    said, likely = verdict(comparison, budget), ""
    if comparison.likely:
        said, likely = sentence(why(comparison)), said
    elif budget is None:
        likely = why(comparison)
    found = common.agreement(comparison, said, likely)
    if comparison.validation is None:
        return found
    claim = f"{validation_claim(comparison.validation)} By the tolerances, {found.claim}"
    return replace(found, claim=claim)


def plane_tiles(comparison: Comparison, budget: Budget | None = None) -> Iterator[Tile]:
    yield from common.sizes(comparison, worst_reading(comparison))
    apart, (size, unit) = comparison.snap_off.difference, comparison.reference.running_unit
    unsure, shift = comparison.snap_off.uncertainty, "not in both"
    if apart is not None:
        half = f" ± {short(unsure / size)}" if unsure else ""
        shift = f"{short(apart / size)}{half} {unit}"
    yield Tile("snap-off apart", shift, "candidate less reference")
    alike, right = comparison.phases_alike(), comparison.phase_agreement().get("candidate")
    if alike is not None:
        known = "the candidate's true ones are not known"
        if right is not None:
            known = f"{percent(right)} of the candidate's rightly"
        yield Tile("phases alike", percent(alike), f"judged from both clamps; {known}")
    offset = _offset(comparison)
    if offset:
        yield Tile("offset of the foot", offset, "taken from the candidate's foot_x")
    noise = max(comparison.noise.level.values())
    if noise:
        yield Tile("noise", short(noise), "of the noisiest reading, allowed for in the limits")
    yield from common.unexplained(budget)


def _validation(comparison: Comparison) -> Iterator[Block]:
    found = comparison.validation
    if found is None:
        return
    yield from map(Text, validation_lines(comparison))
    yield from validation_tables(found, comparison.reference.beam)
    shows = "E = S - D and twice its standard uncertainty over the foot position"
    yield Picture(
        "validation",
        {shows: partial(drawn.validation_picture, comparison, found)},
        "Dots: E at each station. Blue: twice its standard uncertainty, which 95 % of the dots of "
        "a right model are within, all on one side if an input is off. Grey: noise alone.",
    )


def _apart(comparison: Comparison) -> Iterator[Block]:
    over = common.along(comparison).name
    shows = f"{{}} of both models over the {over}, and their difference"
    yield Picture(
        "reading",
        {shows.format(name): partial(drawn.reading_panel, comparison, name) for name in SYMBOLS},
        "Clamp force and moment, and the contact's arc length reconstructed from them, over the "
        f"{over}. Line: {comparison.reference.source}, drawn on beyond its last station to the "
        f"snap-off. Dots: {comparison.candidate.source}. Shaded: the reference's phases. Below: "
        "candidate less reference, in the same unit.",
        "panels",
    )
    yield from common.apart_table(comparison)
    counts = comparison.alignment.counts.items()
    counted = [
        (_BECAME.get(why, words(why)), str(n)) for why, n in counts if n or why == "compared"
    ]
    if apart := comparison.alignment.counts["compared"] - comparison.stations:
        counted.insert(1, ("of these just before the snap-off: not in rms and max", str(apart)))
    removed = [("offset of the candidate's foot", _offset(comparison) or "none")]
    removed += [
        (f"noise of {name}, of its largest magnitude", short(level) if level else "none")
        for name, level in comparison.noise.level.items()
    ]
    yield Beside(
        [
            Table("What became of the candidate's stations", (), counted),
            Table("Removed before the comparison, or allowed for in its limits", (), removed),
        ]
    )


def _sweep(comparison: Comparison, film: Film | None) -> Iterator[Block]:
    if film is not None:
        yield film
        yield Text(
            "Outlined: the reference, in the colour of its curvature. Dots: the candidate. "
            "Arrow: contact force.",
            aside=True,
        )
    shows = "The object and the vibrissa at stations of both sweeps"
    yield Picture(
        "geometry",
        {shows: partial(geometry, comparison)},
        "The vibrissa at stations of the sweep, drawn from the clamp readings alone. Grey: the "
        "side of the object that faces the foot, the only one that the vibrissa can touch.",
    )


def _phases(comparison: Comparison) -> Iterator[Block]:
    along = common.along(comparison)
    shows = f"Phase B's criterion and the contact's arc length over the {along.name}"
    yield Picture(
        "phases",
        {shows: partial(drawn.phase_criterion, comparison)},
        "In Phase B criterion (26) of Will, Steigenberger and Behn (2014) is zero, in Phase A the "
        "contact is at the tip; each station goes to the phase whose condition it meets better, in "
        "units of the readings' own noise.",
    )
    caption = (
        f"{along.places} where one phase gives way to the next, found from the clamp readings alone"
    )
    transitions = common.places_table(comparison, caption, comparison.transitions)
    absent = [Text(sentence(line), aside=True) for line in absent_transitions(comparison)]
    yield Beside([transitions, *absent, *_confusions(comparison)])


def _confusions(comparison: Comparison) -> Iterator[Table]:
    right = comparison.phase_agreement()
    letters = [PHASE_LETTERS[phase] for phase in PHASES]
    head = ("true phase", *(f"judged {letter}" for letter in letters))
    for which, counts in comparison.confusion.items():
        said = "no station has a known phase"
        if which in right:
            said = f"{percent(right[which])} of stations judged rightly"
        numbers = zip(letters, counts.to_numpy(), strict=True)
        rows = [(letter, *map(str, row)) for letter, row in numbers]
        yield Table(f"{comparison.judged[which].readings.source}: {said}", head, rows)


def _snap_off(comparison: Comparison) -> Iterator[Block]:
    found = comparison.snap_off
    caption = (
        f"{common.along(comparison).places} where the vibrissa lets go: as its source recorded it, "
        "else between the last station in contact and the next"
    )
    yield common.places_table(comparison, caption, {"snap-off": found})
    if found.reference is None and found.candidate is None:
        yield Text("Neither sweep has one.")
        return
    shows = "{} of both models around the snap-off, and their difference"
    near = partial(drawn.around_snap_off, comparison)
    yield Picture(
        "snap-off",
        {shows.format(name): partial(near, name) for name in CLAMP_READINGS},
        "The readings grow like a square root towards the snap-off (dotted), so a small error of "
        "its place is a large one of theirs. Between its last stations the reference's line "
        "follows that square root.",
        "three",
    )


def _convergence(budget: Budget | None) -> Iterator[Block]:
    if budget is None or not budget.convergence:
        return
    orders = fitted_orders(budget.convergence)
    falls = ", ".join(f"{name} falls with order {x:.2f}" for name, x in orders.items())
    yield Text(
        "The beam's own order, observed between the three numbers of segments, is "
        f"{budget.order:.2f}. The lines below are fitted to the whole disagreement: {falls}."
    )
    shows = "Disagreement against the number of segments, both logarithmic"
    lines = Picture(
        "convergence",
        {shows: partial(convergence_picture, budget.convergence)},
        "Disagreement with the reference against the number of segments; dashed is second order. A "
        "reading that flattens has reached what segments do not change, as the facets of "
        "the object.",
        "middle",
    )
    yield Beside([lines, convergence_table(budget.convergence)])


def _offset(comparison: Comparison) -> str:
    """In the readings' own unit; empty if there is none."""
    beam, offset = comparison.reference.beam, comparison.offset
    if not (offset.value or offset.uncertainty):
        return "none was found" if offset.unknown else ""
    found = uncertain(offset.value, offset.uncertainty, "length", beam)
    return found if beam.si else f"{found} L" if beam == Beam() else f"{found}, L = {beam.length:g}"
