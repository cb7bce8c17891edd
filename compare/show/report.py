"""The report of a comparison: one offline HTML file, and the figures beside it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from markupsafe import Markup
from matplotlib.figure import Figure

from analytic import CLAMP_READINGS, PHASES, Beam, Readings
from analytic.problem.files import write_whole
from compare.comparison import Comparison
from compare.explain.budget import UNRESOLVED, Budget
from compare.explain.convergence import fitted_orders
from compare.judge.tolerances import CONVENTION
from compare.show.colophon import colophon
from compare.show.figures.budget_bars import headline, picture
from compare.show.figures.budget_bars import panels as budget_panels
from compare.show.figures.geometry import geometry
from compare.show.figures.order_plot import convergence_picture
from compare.show.figures.over_foot import unit
from compare.show.figures.phases import phase_criterion
from compare.show.figures.readings import at_snap_off, reading_panels, readings
from compare.show.figures.validation import validation_picture
from compare.show.page import document, embedded, inline_svg, png, render, words
from compare.show.quantities import Kind, quantity
from compare.show.style import PHASE_LETTERS
from compare.show.validity import standard_of, validation_lines
from compare.show.verdict import absent_transitions, verdict, why, worst_reading

FIGURES = {"geometry": geometry, "readings": readings, "phases": phase_criterion}
"""Pictures that are also written as files of their own."""

_BULKY = ("contour", "events", "joints")  # of a source's provenance; they are drawn instead
_BEAM = ("length", "flexural_rigidity", "radius")
_LONGEST = 200  # characters of a setting
_OF_LARGEST = "of the reading's largest magnitude"
_LIMITED = {
    "snap_off_window": "of the sweep's length",
    "phase_agreement": "of the stations",
    "transition": "L",
    "snap_off": "L",
    "lateness": "L",
    "untrusted": "of the stations",
}
"""What a limit is a number of; all others are of a reading's largest magnitude."""


@dataclass(frozen=True)
class Film:
    """The sweep in motion: a GIF, and a PNG for those who want nothing to move."""

    gif: Path
    still: Path

    @classmethod
    def of(cls, folder: Path) -> "Film | None":
        """The film of a folder."""
        film = cls(folder / "animation.gif", folder / "still-3.png")
        return film if film.gif.is_file() and film.still.is_file() else None


def write_report(
    comparison: Comparison,
    folder: Path,
    budget: Budget | None = None,
    film: Film | None = None,
) -> Path:
    """Write ``comparison.json``, the figures and ``report.html`` into `folder`.

    Everything is drawn before the first file is written, each file appears whole, and
    ``report.html`` last.
    """
    drawn = {name: draw(comparison) for name, draw in FIGURES.items()}
    contents: dict[str, str | bytes] = {
        f"{name}.png": png(figure) for name, figure in drawn.items()
    }
    contents["comparison.json"] = document(comparison.to_dict())
    if comparison.validation is not None:
        drawn["validation"] = validation_picture(comparison, comparison.validation)
        contents["validation.png"] = png(drawn["validation"])
        contents["validation.csv"] = comparison.validation.table.to_csv(index=False)
    if budget is not None:
        contents |= budget_files(budget)
    figures = _figures(comparison, drawn, budget)
    contents["report.html"] = report_page(comparison, figures, budget, film)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(folder / name, content)
    return folder / "report.html"


def budget_files(found: Budget, advice: Mapping[str, Any] | None = None) -> dict[str, str | bytes]:
    """What is written of a budget."""
    content = found.to_dict() if advice is None else {**found.to_dict(), "advice": advice}
    return {"budget.json": document(content), "budget.png": png(picture(found), 100)}


def report_page(
    comparison: Comparison,
    figures: Mapping[str, Sequence[Markup]],
    budget: Budget | None = None,
    film: Film | None = None,
) -> str:
    """The report as a page."""
    found = comparison.to_dict()
    return render(
        "compare.show",
        "report.html.j2",
        found=found,
        verdict=verdict(comparison, budget),
        why=_sentence(why(comparison) if comparison.likely or budget is None else ""),
        remark=_sentence(comparison.remark or ""),
        convention=_sentence(CONVENTION if comparison.tolerances.conventional else ""),
        absent=[_sentence(line) for line in absent_transitions(comparison)],
        worst=worst_reading(comparison),
        readings=CLAMP_READINGS,
        phases=[p for p in PHASES if p in set(comparison.alignment.table["phase"])],
        letters=PHASE_LETTERS,
        units=_units(comparison.reference),
        sizes=_sizes(comparison.reference.beam),
        si=comparison.reference.beam.si,
        offset=_offset(comparison),
        alike=comparison.phases_alike(),
        recorded=_known(comparison),
        colophon=colophon(),
        limited={name: _LIMITED.get(name, _OF_LARGEST) for name in found["tolerances"]},
        budget=budget,
        validation=comparison.validation,
        validity=validation_lines(comparison),
        standards=_standards(comparison),
        unresolved=UNRESOLVED,
        headline=None if budget is None else headline(budget),
        orders=fitted_orders(budget.convergence) if budget and budget.convergence else {},
        figures=figures,
        film=film and {"gif": embedded(film.gif), "still": embedded(film.still)},
    )


def _figures(
    comparison: Comparison, drawn: Mapping[str, Figure], budget: Budget | None
) -> dict[str, list[Markup]]:
    """The page's pictures by the section they are in."""
    panels = reading_panels(comparison)
    page = {
        "geometry": _inline(
            "geometry",
            "The object and the vibrissa at stations of the sweep, in {}",
            {"both sweeps": drawn["geometry"]},
        ),
        "readings": _inline(
            "readings", "{} of both models over the foot position, and their difference", panels
        ),
        "phases": _inline(
            "phases",
            "Phase B's criterion and the contact's arc length over the foot position, {}",
            {"both sweeps": drawn["phases"]},
        ),
        "snap-off": _inline(
            "snap-off",
            "{} of both models around the snap-off, and their difference",
            at_snap_off(panels, comparison),
        ),
    }
    if "validation" in drawn:
        page["validation"] = _inline(
            "validation",
            "E = S - D and twice its standard uncertainty over the foot position",
            {"": drawn["validation"]},
        )
    if budget is not None:
        page["budget"] = _inline(
            "budget",
            "Bars: the parts of {}'s disagreement; the table below has the numbers",
            budget_panels(budget),
        )
        if budget.convergence:
            page["convergence"] = _inline(
                "convergence",
                "Disagreement against the number of segments, both logarithmic",
                {"": convergence_picture(budget.convergence)},
            )
    return page


def _inline(section: str, describes: str, figures: Mapping[str, Figure]) -> list[Markup]:
    return [
        inline_svg(figure, f"{section}-{i}", describes.format(name))
        for i, (name, figure) in enumerate(figures.items())
    ]


def _sentence(text: str) -> str:
    text = text.replace("`", "")  # a mark of code on a terminal and in Markdown
    return text and f"{text[0].upper()}{text[1:].rstrip('.')}."


def _units(readings: Readings) -> dict[str, float]:
    """What the page's units are in those of the readings."""
    beam = readings.beam
    return {
        "length": beam.length,
        **{name: unit(readings, name) for name in CLAMP_READINGS},
    }


def _sizes(beam: Beam) -> dict[str, str]:
    """What the page's units are, with the readings' own unit where it is known."""
    values: dict[Kind, float] = {
        "length": beam.length,
        "force": beam.force_unit,
        "moment": beam.moment_unit,
    }
    return {kind: quantity(value, kind, beam) for kind, value in values.items()}


def _offset(comparison: Comparison) -> str:
    """The offset in the readings' own unit; empty if that is L."""
    beam, offset = comparison.reference.beam, comparison.offset
    if beam == Beam() or not (offset.value or offset.uncertainty):
        return ""
    return " ± ".join(quantity(x, "length", beam) for x in (offset.value, offset.uncertainty))


def _standards(comparison: Comparison) -> dict[str, str]:
    """Standard uncertainty of each input, with its unit."""
    if comparison.validation is None:
        return {}
    beam, standard = comparison.reference.beam, comparison.validation.standard
    return {name: standard_of(name, value, beam) for name, value in standard.items()}


def _known(comparison: Comparison) -> dict[str, dict[str, str]]:
    """What is recorded of both sweeps: of each thing that is known, what the source says."""
    sweeps = (_recorded(comparison.reference), _recorded(comparison.candidate))
    names = dict.fromkeys(name for sweep in sweeps for name in sweep)
    return {
        name: {
            which: sweep.get(name, "")
            for which, sweep in zip(("reference", "candidate"), sweeps, strict=True)
        }
        for name in names
    }


def _recorded(readings: Readings) -> dict[str, str]:
    beam = {words(name): getattr(readings.beam, name) for name in _BEAM}
    beam |= readings.beyond_the_paper
    provenance = dict(readings.provenance)
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
