"""What is said of a comparison in the plane: its verdict, and a section a question."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

from matplotlib.figure import Figure

from analytic import PHASES, Beam
from compare.comparison import Comparison
from compare.explain.budget import UNRESOLVED, Budget
from compare.explain.convergence import fitted_orders
from compare.judge.tolerances import CONVENTION
from compare.sense.occurrence import Occurrence
from compare.show.budgets import budget_summary, convergence_table, phases_table
from compare.show.document import (
    Beside,
    Block,
    Document,
    Film,
    Layout,
    Picture,
    Table,
    Text,
    Tile,
    Verdict,
    sections,
)
from compare.show.numbers import percent, place, quantity, sentence, short, words
from compare.show.sections import PHASE_KEY, agreement, limits, settings, sizes
from compare.show.style import PHASE_LETTERS
from compare.show.validity import validation_lines, validation_tables
from compare.show.verdict import absent_transitions, verdict, why, worst_reading

_UNITS = {"force_x": "EI/L²", "force_y": "EI/L²", "moment_z": "EI/L"}


def comparison_document(
    comparison: Comparison,
    pictures: Mapping[str, Mapping[str, Figure]],
    budget: Budget | None = None,
    film: Film | None = None,
) -> Document:
    """All that there is to say of a comparison, with the pictures of its sections."""
    reference, candidate = comparison.reference, comparison.candidate
    recorded, beam = reference.provenance, reference.beam
    compared = comparison.alignment.counts["compared"]
    length = quantity(beam.length, "length", beam)
    force = quantity(beam.force_unit, "force", beam)
    moment = quantity(beam.moment_unit, "moment", beam)
    own = "" if beam.si else " of the readings' own units"
    convention = comparison.tolerances.conventional and not comparison.remark
    found = comparison_verdict(comparison, budget)
    page = _Sections(comparison, pictures, budget, film)
    return Document(
        f"{recorded.get('case') or 'a sweep'}: {candidate.source} against {reference.source}",
        f"{recorded.get('profile') or 'Contour not recorded'}; {compared} stations compared. "
        f"Lengths are given in L = {length}, forces in EI/L² = {force} and moments in EI/L = "
        f"{moment}{own}.",
        replace(found, remarks=[*found.remarks, *validation_lines(comparison)[:1]]),
        sections(
            ("budget", "What the disagreement is made of", page.parts()),
            (
                "validation",
                "Validation: the disagreement against its uncertainty",
                page.validation(),
            ),
            ("apart", "How far apart, reading by reading", page.apart()),
            ("sweep", "The sweep", page.sweep()),
            ("phases", "Phases judged from the clamp", page.phases()),
            ("snap-off", "Snap-off", page.snap_off()),
            ("convergence", "Convergence", page.convergence()),
            limits(comparison.tolerances.limits(), CONVENTION if convention else ""),
            settings(reference, candidate),
        ),
        [*comparison_tiles(comparison, budget)],
    )


def comparison_verdict(comparison: Comparison, budget: Budget | None = None) -> Verdict:
    """Whether the two agree, and why not."""
    likely = why(comparison) if comparison.likely or budget is None else ""
    return agreement(comparison, verdict(comparison, budget), likely)


def comparison_tiles(comparison: Comparison, budget: Budget | None = None) -> Iterator[Tile]:
    """The numbers that matter."""
    length, worst = comparison.reference.beam.length, worst_reading(comparison)
    yield from sizes(comparison, worst, "foot at {} L")
    apart = comparison.snap_off.difference
    shift = "none" if apart is None else short(apart / length, " L")
    yield Tile("snap-off apart", shift, "candidate less reference")
    alike, right = comparison.phases_alike(), comparison.phase_agreement().get("candidate")
    if alike is not None:
        known = "the candidate's true ones are not known"
        if right is not None:
            known = f"{percent(right)} of the candidate's are its true ones"
        yield Tile("phases alike", percent(alike), f"judged from both clamps; {known}")
    offset = _offset(comparison)
    if offset:
        yield Tile("offset of the foot", offset, "taken from the candidate's foot_x")
    noise = max(comparison.noise.level.values())
    if noise:
        yield Tile("noise", short(noise), "of the noisiest reading, allowed for in the limits")
    if budget is not None:
        rest = max(part.rms for part in budget.parts["unexplained"].values())
        still_open = "is undecided" if budget.undecided else "does not close"
        said = "closes" if budget.closes else still_open
        yield Tile("stays unexplained", short(rest), f"the budget {said}")


def apart_table(comparison: Comparison) -> Table:
    """How far apart the two are, reading by reading."""
    phases, beam = _phases(comparison), comparison.reference.beam
    rows = []
    for name, unit in _UNITS.items():
        d = comparison.disagreement[name]
        size = d.scale / (beam.moment_unit if name == "moment_z" else beam.force_unit)
        by_phase = (short(d.rms_by_phase.get(phase)) for phase in phases)
        at, near = place(d.at / beam.length), short(d.max_before_snap_off)
        rows.append((name, short(d.rms), *by_phase, short(d.max), at, near, f"{size:.4g} {unit}"))
    heads = (f"rms, {PHASE_LETTERS[phase]}" for phase in phases)
    return Table(
        "Candidate less reference, relative to the reading's largest magnitude in the reference; "
        f"{PHASE_KEY}",
        ("reading", "rms", *heads, "max", "foot at / L", "max at snap-off", "largest magnitude"),
        rows,
    )


@dataclass(frozen=True)
class _Sections:
    """The blocks of each section, but for those that all comparisons have."""

    comparison: Comparison
    pictures: Mapping[str, Mapping[str, Figure]]
    budget: Budget | None
    film: Film | None

    def parts(self) -> Iterator[Block]:
        if self.budget is None:
            return
        table, *said = budget_summary(self.budget)
        yield from said
        yield from self._picture(
            "budget",
            "Each part is measured by a controlled change of its own and combines with the others "
            "as a signal over the sweep, so sizes do not add up; the axis is logarithmic. Orange: "
            "the largest part. Last: what no part explains. Whiskers: uncertainty. Dashed: the "
            f"whole disagreement. Grey: up to {short(UNRESOLVED)} may stay unexplained.",
            "three",
        )
        yield table
        yield phases_table(self.budget, _phases(self.comparison))

    def validation(self) -> Iterator[Block]:
        found = self.comparison.validation
        if found is None:
            return
        yield from map(Text, validation_lines(self.comparison))
        yield from validation_tables(found, self.comparison.reference.beam)
        yield from self._picture(
            "validation",
            "Dots: E at each station. Blue: twice its standard uncertainty, which 95 % of the dots "
            "of a right model are within, all on one side if an input is off. Grey: noise alone.",
        )

    def apart(self) -> Iterator[Block]:
        reference, candidate = self._sources
        yield apart_table(self.comparison)
        yield from self._picture(
            "readings",
            "Clamp force and moment, and the contact's arc length reconstructed from them, over "
            f"the foot's position. Line: {reference}. Dots: {candidate}. Shaded: the reference's "
            "phases. Below: candidate less reference, in the same unit.",
            "panels",
        )
        counts = self.comparison.alignment.counts.items()
        counted = [(words(why), str(n)) for why, n in counts if n or why == "compared"]
        removed = [("offset of the candidate's foot", _offset(self.comparison) or "none")]
        removed += [
            (f"noise of {name}, of its largest magnitude", short(level) if level else "none")
            for name, level in self.comparison.noise.level.items()
        ]
        stations = Table("What became of the candidate's stations", (), counted)
        caption = "Removed before the comparison, or allowed for in its limits"
        yield Beside([stations, Table(caption, (), removed)])

    def sweep(self) -> Iterator[Block]:
        if self.film is not None:
            yield self.film
            yield Text(
                "Black: the reference, filled with the colour of its curvature. Dots: the "
                "candidate. Arrow: contact force.",
                aside=True,
            )
        yield from self._picture(
            "geometry",
            "The vibrissa at stations of the sweep, drawn from the clamp readings alone. Grey: the "
            "side of the object that faces the foot, the only one that the vibrissa can touch.",
        )

    def phases(self) -> Iterator[Block]:
        yield from self._picture(
            "phases",
            "In Phase B criterion (26) of Will, Steigenberger and Behn (2014) is zero, in Phase A "
            "the contact is at the tip; each station goes to the phase whose condition it meets "
            "better, in units of the readings' own noise.",
        )
        found = self.comparison.transitions.items()
        transitions = Table(
            "Foot positions / L where one phase gives way to the next, found from the clamp "
            "readings alone",
            ("transition", *self._sources, "difference"),
            [(words(name), *self._places(one)) for name, one in found],
        )
        absent = [Text(sentence(line), aside=True) for line in absent_transitions(self.comparison)]
        yield Beside([transitions, *absent, *self._confusions()])

    def snap_off(self) -> Iterator[Block]:
        found = self.comparison.snap_off
        wide = short(found.uncertainty / self._length)
        yield Table(
            "Foot position / L where the vibrissa lets go: as its source recorded it, else between "
            "the last station in contact and the next",
            ("", *self._sources, "difference", "uncertainty"),
            [("snap-off", *self._places(found), wide)],
        )
        if found.reference is None and found.candidate is None:
            yield Text("Neither sweep has one.")
        yield from self._picture(
            "snap-off",
            "The readings grow like a square root towards the snap-off (dotted), so a small error "
            "of its place is a large one of theirs. Between its last stations the reference's line "
            "follows that square root.",
            "three",
        )

    def convergence(self) -> Iterator[Block]:
        if self.budget is None or not self.budget.convergence:
            return
        orders = fitted_orders(self.budget.convergence)
        falls = ", ".join(f"{name} falls with order {x:.2f}" for name, x in orders.items())
        yield Text(
            "The beam's own order, observed between the three numbers of segments, is "
            f"{self.budget.order:.2f}. The lines below are fitted to the whole disagreement: "
            f"{falls}."
        )
        drawn = self._picture(
            "convergence",
            "Disagreement with the reference against the number of segments; the triangle shows "
            "second order. A reading that flattens has reached what segments do not change, as the "
            "facets of the object.",
            "middle",
        )
        yield Beside([*drawn, convergence_table(self.budget.convergence)])

    def _picture(self, name: str, caption: str, layout: Layout = "wide") -> Iterator[Picture]:
        figures = self.pictures.get(name)
        if figures:
            yield Picture(name, figures, caption, layout)

    def _confusions(self) -> Iterator[Table]:
        right = self.comparison.phase_agreement()
        sources = dict(zip(("reference", "candidate"), self._sources, strict=True))
        letters = [PHASE_LETTERS[phase] for phase in PHASES]
        head = ("true phase", *(f"judged {letter}" for letter in letters))
        for which, counts in self.comparison.confusion.items():
            said = "no station has a known phase"
            if which in right:
                said = f"{percent(right[which])} of stations judged rightly"
            numbers = zip(letters, counts.to_numpy(), strict=True)
            rows = [(letter, *(str(n) for n in row)) for letter, row in numbers]
            yield Table(f"{sources[which]}: {said}", head, rows)

    @property
    def _length(self) -> float:
        return self.comparison.reference.beam.length

    @property
    def _sources(self) -> tuple[str, str]:
        return self.comparison.reference.source, self.comparison.candidate.source

    def _places(self, found: Occurrence) -> tuple[str, str, str]:
        ours, theirs, apart = (
            None if x is None else x / self._length
            for x in (found.reference, found.candidate, found.difference)
        )
        return place(ours), place(theirs), short(apart)


def _phases(comparison: Comparison) -> list[str]:
    """Of the reference, at the stations that are compared."""
    there = set(comparison.alignment.table["phase"])
    return [phase for phase in PHASES if phase in there]


def _offset(comparison: Comparison) -> str:
    """In L, and in the readings' own unit unless that is L; empty if there is none."""
    beam, offset = comparison.reference.beam, comparison.offset
    if not (offset.value or offset.uncertainty):
        return ""
    value, unsure = place(offset.value / beam.length), short(offset.uncertainty / beam.length)
    if beam == Beam():
        return f"{value} ± {unsure} L"
    own = " ± ".join(quantity(x, "length", beam) for x in (offset.value, offset.uncertainty))
    return f"{value} ± {unsure} L ({own})"
