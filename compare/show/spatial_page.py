"""What is said of a comparison in space: its verdict, and a section a question."""

from collections.abc import Iterator
from functools import partial

from compare.comparison import SpatialComparison
from compare.explain.parts import Parted
from compare.show import comparison_page as common
from compare.show.document import (
    Block,
    Document,
    Film,
    Picture,
    Table,
    Text,
    Tile,
    Turntable,
    Verdict,
)
from compare.show.figures import space as drawn
from compare.show.numbers import object_of, percent, short, words
from compare.show.scene import SweepScene


def spatial_document(
    comparison: SpatialComparison,
    scene: SweepScene,
    budget: Parted | None = None,
    film: Film | None = None,
) -> Document:
    touching, stations = comparison.compared.sum(), len(comparison.compared)
    return common.document(
        comparison,
        f"{object_of(comparison.reference)}; {touching} of {stations} stations compared: those at "
        f"which both touch. Components are in the {comparison.frame}'s frame.",
        spatial_verdict(comparison),
        spatial_tiles(comparison, budget),
        budget,
        ("apart", "How far apart, component by component", _apart(comparison)),
        ("sweep", "The sweep", _sweep(scene, film)),
        ("events", "Where they touch and leave", _events(comparison)),
    )


def spatial_verdict(comparison: SpatialComparison) -> Verdict:
    name, worst = comparison.largest, comparison.worst
    rms = short(comparison.disagreement[name].rms)
    allowed = short(comparison.tolerances.of(name, "rms"))
    over = f"over {comparison.stations} stations"
    noise = comparison.noise.level[name]
    beside = f" beside noise of {short(noise)}" if noise else ""
    said = f"{name} is off most: {rms} rms {over}, {allowed} is allowed{beside}."
    likely = f"likely: {comparison.likely}" if comparison.likely else ""
    return common.agreement(
        comparison, said if worst is None else f"Most of all {worst.clause}, {over}.", likely
    )


def spatial_tiles(comparison: SpatialComparison, budget: Parted | None = None) -> Iterator[Tile]:
    yield from common.sizes(comparison, comparison.largest)
    contact = comparison.contact
    if contact.stations:
        where = f"{short(comparison.tolerances.contact)} allowed, at {contact.stations} stations"
        yield Tile("contacts apart, rms", short(contact.rms, " L"), where)
        yield Tile("contacts apart, most", short(contact.max, " L"), "at any one station")
    if comparison.phase_agreement is not None:
        asked = percent(comparison.tolerances.phase_agreement)
        note = f"of the compared stations; {asked} must be"
        yield Tile("phases alike", percent(comparison.phase_agreement), note)
    for name, event in comparison.events.items():
        if event.difference is not None:
            apart = short(event.difference / comparison.reference.running_unit[0], " L")
            note = f"candidate less reference; {short(comparison.tolerances.event)} allowed"
            yield Tile(f"{words(name)} apart", apart, note)
    yield from common.unexplained(budget)


def _apart(comparison: SpatialComparison) -> Iterator[Block]:
    lines, dots = comparison.reference.source, comparison.candidate.source
    shows = "Six components of both sweeps over the way of the foot, and their differences"
    caption = f"Lines: {lines}. Dots: {dots}. Below each: candidate less reference."
    yield Picture("components", {shows: partial(drawn.both_in_space, comparison)}, caption)
    yield from common.apart_table(comparison)


def _sweep(scene: SweepScene, film: Film | None) -> Iterator[Block]:
    yield Turntable(scene)
    shows = "The body, the vibrissa at some stations, the contacts, and the readings"
    caption = (
        f"{scene.readings.source}: the body, the vibrissa at some stations coloured by phase, and "
        "the contacts found from its clamp's readings."
    )
    yield Picture("space", {shows: partial(drawn.sweep_in_space, scene)}, caption, "still")
    if film is not None:
        yield film


def _events(comparison: SpatialComparison) -> Iterator[Block]:
    caption = f"Way of the foot / L; {short(comparison.tolerances.event)} apart is allowed"
    yield common.places_table(comparison, caption, comparison.events)
    shows = "When both sweeps touch, in which phase, and how far their contacts are apart"
    yield Picture(
        "contacts",
        {shows: partial(drawn.contacts_in_space, comparison)},
        "Above: phases of both sweeps; gaps are without readings. Below: distance between their "
        "contacts; dashed is what its rms may be.",
    )
    said = ""
    if comparison.phase_agreement is None:
        said += "Phases are not compared: a source records none. "
    if whose := comparison.contact.from_clamp:
        said += f"Contacts of {' and '.join(whose)} are found from the clamp. "
    lacking, having = comparison.candidate.source, comparison.reference.source
    said += f"{comparison.untrusted} stations lack readings in {lacking} but not in {having}."
    yield Text(said)
    statuses = comparison.statuses.items()
    counted = [(f"{which}, {what}", str(n)) for which, of in statuses for what, n in of.items()]
    yield Table("What became of the stations", (), counted)
