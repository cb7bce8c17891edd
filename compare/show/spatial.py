"""The report of a comparison in space: one offline HTML file, and the figures beside it."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from analytic.problem.arrays import Floats
from analytic.problem.files import write_whole
from analytic.space import Body
from compare.align.frames import COMPONENTS
from compare.comparison_in_space import SpatialComparison
from compare.explain.split_space import Parts
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
    sections,
)
from compare.show.figures.space import (
    both_in_space,
    contacts_in_space,
    parts_in_space,
    sweep_in_space,
)
from compare.show.html import html
from compare.show.numbers import percent, place, short
from compare.show.page import document as as_json
from compare.show.page import png
from compare.show.scene import SweepScene
from compare.show.sections import PHASE_KEY, agreement, limits, settings, sizes
from compare.show.solid import solid_ply


def write_spatial_report(
    comparison: SpatialComparison,
    body: Body | Floats | None,
    folder: Path,
    parts: Parts | None = None,
    film: Film | None = None,
) -> Path:
    """Write ``comparison.json``, the figures, what they show of the body, and ``report.html``."""
    scene = SweepScene.of(comparison.candidate, body)
    drawn = {
        "space": sweep_in_space(scene),
        "components": both_in_space(comparison),
        "contacts": contacts_in_space(comparison),
    }
    if parts is not None:
        drawn["parts"] = parts_in_space(parts)
    contents: dict[str, str | bytes] = {f"{name}.png": png(one) for name, one in drawn.items()}
    if len(scene.faces):
        contents["body.ply"] = solid_ply(scene.faces * comparison.candidate.beam.length)
    contents["comparison.json"] = as_json(comparison.to_dict())
    if parts is not None:
        contents["budget.json"] = as_json(parts.to_dict())
    contents["report.html"] = html(spatial_document(comparison, scene, drawn, parts, film))
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(folder / name, content)
    return folder / "report.html"


def spatial_document(
    comparison: SpatialComparison,
    scene: SweepScene,
    drawn: Mapping[str, Figure],
    parts: Parts | None = None,
    film: Film | None = None,
) -> Document:
    """All that there is to say of a comparison in space, with its pictures."""
    reference, candidate = comparison.reference, comparison.candidate
    case = reference.provenance.get("case", "a sweep")
    body = reference.provenance.get("body", "Body not recorded")
    touching, stations = comparison.compared.sum(), len(comparison.compared)
    return Document(
        f"{case}: {candidate.source} against {reference.source} in space",
        f"{body}; {touching} of {stations} stations compared: those at which both touch. "
        "Differences are relative to the largest component of the force, or of the moment, of "
        f"{reference.source}. Components are in the {comparison.frame}'s frame.",
        spatial_verdict(comparison),
        sections(
            ("budget", "What the disagreement is made of", _made_of(parts, drawn)),
            ("apart", "How far apart, component by component", _apart(comparison, drawn)),
            ("sweep", "The sweep", _sweep(candidate.source, scene, drawn, film)),
            ("events", "Where they touch and leave", _events(comparison, drawn)),
            limits(comparison.tolerances.limits()),
            settings(reference, candidate),
        ),
        [*spatial_tiles(comparison, parts)],
    )


def spatial_verdict(comparison: SpatialComparison) -> Verdict:
    """Whether the two agree, and why not."""
    name, worst = comparison.largest, comparison.worst
    rms = short(comparison.disagreement[name].rms)
    allowed = short(comparison.tolerances.of(name, "rms"))
    said = f"{name} is off most: {rms} rms, {allowed} is allowed."
    return agreement(comparison, said if worst is None else f"Most of all {worst.clause}.")


def spatial_tiles(comparison: SpatialComparison, parts: Parts | None = None) -> Iterator[Tile]:
    """The numbers that matter."""
    yield from sizes(comparison, comparison.largest, "foot {} L on its way")
    contact = comparison.contact
    where = f"at {contact.stations} stations" if contact.stations else "known at no station"
    yield Tile("contacts apart, rms", short(contact.rms, " L"), where)
    if comparison.phase_agreement is not None:
        yield Tile("phases alike", percent(comparison.phase_agreement), "of the compared stations")
    if parts is not None:
        yield Tile("stays unexplained", short(parts.unexplained), f"of {short(parts.whole)}")


def spatial_table(comparison: SpatialComparison) -> Table:
    """How far apart the two are, component by component."""
    allowed, length = comparison.tolerances, comparison.reference.beam.length
    rows: list[tuple[str, ...]] = []
    for name in COMPONENTS:
        d = comparison.disagreement[name]
        by_phase = (short(d.rms_by_phase.get(phase)) for phase in ("tip", "tangent"))
        rms, most = (short(allowed.of(name, kind)) for kind in ("rms", "max"))
        at = place(d.at / length)
        rows.append((name, short(d.rms), rms, *by_phase, short(d.max), most, at))
    contact = comparison.contact
    sizes_apart = short(contact.rms), short(allowed.contact), "", "", short(contact.max), "", ""
    rows.append(("contact point / L", *sizes_apart))
    return Table(
        f"Candidate less reference, relative; {PHASE_KEY}",
        ("component", "rms", "allowed", "rms, A", "rms, B", "max", "allowed", "way at max / L"),
        rows,
        whole=[len(COMPONENTS)],
    )


def events_table(comparison: SpatialComparison) -> Table:
    """Where both sweeps touch and leave."""
    length = comparison.reference.beam.length
    rows = []
    for name, pair in comparison.events.items():
        wide = f" ± {short(pair.uncertainty / length)}" if pair.uncertainty else ""
        ours, theirs, apart = (
            None if x is None else x / length
            for x in (pair.reference, pair.candidate, pair.difference)
        )
        rows.append((name, place(ours), place(theirs) + wide, short(apart)))
    return Table(
        f"Way of the foot / L; {short(comparison.tolerances.event)} apart is allowed",
        ("event", comparison.reference.source, comparison.candidate.source, "apart"),
        rows,
    )


def parts_table(parts: Parts) -> Table:
    """What the disagreement is made of."""
    refined, harder = "twice (or half) as many segments, order two", "a contact ten times as stiff"
    rows = [
        ("discretisation", short(parts.discretisation), refined),
        ("softness", short(parts.softness), f"{harder} (or soft)"),
        ("unexplained", short(parts.unexplained), "what is left"),
        ("disagreement", short(parts.whole), ""),
    ]
    caption = f"Root mean square of the worst component over {parts.stations} stations; signals, so"
    head = ("part", "rms", "measured by")
    return Table(f"{caption} sizes do not add up", head, rows, words=(0, 2), whole=[3])


def _made_of(parts: Parts | None, drawn: Mapping[str, Figure]) -> Iterator[Block]:
    if parts is not None:
        yield parts_table(parts)
        bars = {"What the disagreement is made of, a bar a part": drawn["parts"]}
        yield Picture("parts", bars, "The same as bars.", "middle")


def _apart(comparison: SpatialComparison, drawn: Mapping[str, Figure]) -> Iterator[Block]:
    yield spatial_table(comparison)
    lines, dots = comparison.reference.source, comparison.candidate.source
    shows = "Six components of both sweeps over the way of the foot, and their differences"
    caption = f"Lines: {lines}. Dots: {dots}. Below each: candidate less reference."
    yield Picture("components", {shows: drawn["components"]}, caption)


def _sweep(
    source: str, scene: SweepScene, drawn: Mapping[str, Figure], film: Film | None
) -> Iterator[Block]:
    yield Turntable(scene)
    shows = "The body, the vibrissa at some stations, the contacts, and the readings"
    caption = f"{source}: the body, the vibrissa at some stations coloured by phase, and the"
    found = "contacts found from its clamp's readings."
    yield Picture("space", {shows: drawn["space"]}, f"{caption} {found}", "still")
    if film is not None:
        yield film


def _events(comparison: SpatialComparison, drawn: Mapping[str, Figure]) -> Iterator[Block]:
    yield events_table(comparison)
    yield Picture(
        "contacts",
        {
            "When both sweeps touch, in which phase, and how far their contacts are apart": drawn[
                "contacts"
            ]
        },
        "Above: phases of both sweeps; white is without readings. Below: distance between their "
        "contacts; dashed is what its rms may be.",
    )
    agree = comparison.phase_agreement
    said = "Phases are not compared: a source records none."
    if agree is not None:
        asked = percent(comparison.tolerances.phase_agreement)
        said = f"{percent(agree)} of the compared stations are in the same phase; {asked} must be."
    if comparison.contact.from_clamp:
        sources = " and ".join(comparison.contact.from_clamp)
        said += f" Contacts of {sources} are found from the clamp."
    lacking, having = comparison.candidate.source, comparison.reference.source
    yield Text(
        f"{said} {comparison.untrusted} stations lack readings in {lacking} but not in {having}."
    )
    statuses = comparison.statuses.items()
    counted = [(f"{which}, {what}", str(n)) for which, of in statuses for what, n in of.items()]
    yield Table("What became of the stations", (), counted)
