"""The report of a comparison: one offline HTML file, and the figures beside it."""

import base64
import io
import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from analytic import CLAMP_READINGS, PHASES, Readings
from analytic.problem.files import write_whole
from compare.comparison import Comparison
from compare.explain.budget import UNRESOLVED, Budget
from compare.explain.convergence import fitted_orders
from compare.show import figures
from compare.show.budget_figure import headline, panels, picture
from compare.show.convergence_figure import convergence_picture
from compare.show.page import place, short
from compare.show.svg import inline_svg
from compare.show.verdict import verdict, worst_reading

FIGURES = {
    "geometry": figures.geometry,
    "readings": figures.readings,
    "phases": figures.phase_criterion,
}
"""Pictures that are also written as files of their own."""

_VERSIONS = ("engine", "python")  # of a source's provenance; the rest are its settings
_BULKY = ("contour", "events")


@dataclass(frozen=True)
class Film:
    """The sweep in motion: a GIF, and a PNG for those who want nothing to move."""

    gif: Path
    still: Path


def write_report(
    comparison: Comparison,
    folder: Path,
    budget: Budget | None = None,
    film: Film | None = None,
) -> Path:
    """Write ``comparison.json``, the figures and ``report.html`` into `folder`.

    With a budget also ``budget.json`` and ``budget.png``. Everything is drawn before the first file
    is written, each file appears whole, and ``report.html`` last.

    Returns
    -------
    Path
        Of ``report.html``.
    """
    drawn = {name: draw(comparison) for name, draw in FIGURES.items()}
    contents = {f"{name}.png": _png(figure, 150) for name, figure in drawn.items()}
    contents["comparison.json"] = json.dumps(comparison.to_dict(), indent=2).encode()
    if budget is not None:
        contents["budget.png"] = _png(picture(budget), 100)
        contents["budget.json"] = json.dumps(budget.to_dict(), indent=2).encode()
    contents["report.html"] = _html(comparison, drawn, budget, film).encode()
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        write_whole(folder / name, content)
    return folder / "report.html"


def _html(
    comparison: Comparison, drawn: Mapping[str, Figure], budget: Budget | None, film: Film | None
) -> str:
    environment = Environment(
        loader=PackageLoader("compare.show"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(short=short, place=place, words=_words)
    return environment.get_template("report.html.j2").render(
        comparison=comparison,
        found=comparison.to_dict(),
        verdict=verdict(comparison, budget),
        worst=worst_reading(comparison),
        readings=CLAMP_READINGS,
        phases=[p for p in PHASES if p in set(comparison.alignment.table["phase"])],
        origins=[_origin(comparison.reference), _origin(comparison.candidate)],
        limits=comparison.tolerances.limits(),
        budget=budget,
        unresolved=UNRESOLVED,
        headline=None if budget is None else headline(budget),
        orders=fitted_orders(budget.convergence) if budget and budget.convergence else {},
        figures=_figures(comparison, drawn, budget),
        film=None
        if film is None
        else {"gif": _data(film.gif, "gif"), "still": _data(film.still, "png")},
    )


def _figures(
    comparison: Comparison, drawn: Mapping[str, Figure], budget: Budget | None
) -> dict[str, list[Markup]]:
    """The page's pictures by the section they are in."""
    sections: dict[str, Mapping[str, Figure]] = {
        "geometry": {"both sweeps": drawn["geometry"]},
        "readings": figures.reading_panels(comparison),
        "phases": {"both sweeps": drawn["phases"]},
        "snap-off": figures.snap_off_panels(comparison),
    }
    says = {
        "geometry": "The object and the vibrissa at stations of the sweep, in {}",
        "readings": "{} of both models over the foot position, and their difference",
        "phases": "Criterion (26) and the contact's arc length of {} over the foot position",
        "snap-off": "{} of both models around the snap-off, and their difference",
    }
    if budget is not None:
        sections["budget"] = panels(budget)
        says["budget"] = "Bars: the parts of {}'s disagreement; the table below has the numbers"
        if budget.convergence:
            sections["convergence"] = {"": convergence_picture(budget.convergence)}
            says["convergence"] = "Disagreement against the number of segments, both logarithmic"
    return {
        section: [
            inline_svg(figure, f"{section}-{i}", says[section].format(name))
            for i, (name, figure) in enumerate(pictures.items())
        ]
        for section, pictures in sections.items()
    }


def _origin(readings: Readings) -> dict[str, Any]:
    """What is known of a sweep, its versions apart from its settings."""
    known = dict(readings.provenance)
    numerics = known.pop("settings", {})
    return {
        "source": readings.source,
        "versions": {name: known[name] for name in _VERSIONS if name in known},
        "settings": {
            "vibrissa": ", ".join(
                f"{_words(name)} {value:g}" for name, value in asdict(readings.beam).items()
            ),
            "stations": len(readings.table),
            **{k: v for k, v in known.items() if k not in (*_VERSIONS, *_BULKY)},
            **{k: f"{v:g}" if isinstance(v, float) else v for k, v in numerics.items()},
        },
    }


def _words(name: str) -> str:
    return name.replace("_", " ").replace("phase b", "Phase B")


def _data(file: Path, kind: str) -> str:
    return f"data:image/{kind};base64,{base64.b64encode(file.read_bytes()).decode()}"


def _png(figure: Figure, dots_per_inch: int) -> bytes:
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", dpi=dots_per_inch)
    return buffer.getvalue()
