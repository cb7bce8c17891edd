"""The report of a comparison: one offline HTML file, and the figures beside it."""

import io
import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup
from matplotlib.figure import Figure

from analytic import Readings
from analytic.problem.readings import CLAMP_READINGS, PHASES
from compare import figures
from compare.comparison import Comparison
from compare.figures import PHASE_NAMES

FIGURES = {
    "geometry": figures.geometry,
    "readings": figures.readings,
    "phases": figures.phase_criterion,
}

_UNITS = {"force_x": "EI/L²", "force_y": "EI/L²", "moment_z": "EI/L"}


def write_report(comparison: Comparison, folder: Path) -> Path:
    """Write ``comparison.json``, the figures and ``report.html`` into `folder`.

    Everything is drawn before the first file is written, and each file appears whole.

    Returns
    -------
    Path
        Of ``report.html``.
    """
    drawn = {name: draw(comparison) for name, draw in FIGURES.items()}
    contents = {f"{name}.png": _bytes(figure, "png") for name, figure in drawn.items()}
    contents["comparison.json"] = json.dumps(comparison.to_dict(), indent=2).encode()
    contents["report.html"] = _html(comparison, drawn).encode()
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in contents.items():
        unfinished = folder / f".{name}.partial"
        unfinished.write_bytes(content)
        unfinished.replace(folder / name)
    return folder / "report.html"


def _html(comparison: Comparison, drawn: Mapping[str, Figure]) -> str:
    environment = Environment(
        loader=PackageLoader("compare"), autoescape=True, undefined=StrictUndefined
    )
    environment.filters["sci"] = lambda x: "none" if x is None else f"{x:.1e}"
    environment.filters["place"] = lambda x: "none" if x is None else f"{x:.5g}"
    found = comparison.to_dict()
    return environment.get_template("report.html.j2").render(
        comparison=comparison,
        found=found,
        readings=CLAMP_READINGS,
        units=_UNITS,
        phases=PHASES,
        phase_names=PHASE_NAMES,
        worst=max(CLAMP_READINGS, key=lambda name: comparison.disagreement[name].rms),
        origins=[_origin(comparison.reference), _origin(comparison.candidate)],
        figures={name: Markup(_svg(figure)) for name, figure in drawn.items()},
    )


def _origin(readings: Readings) -> dict[str, Any]:
    known = {k: v for k, v in readings.provenance.items() if k not in ("contour", "events")}
    beam = ", ".join(f"{name} {value:g}" for name, value in asdict(readings.beam).items())
    return {"source": readings.source, "beam": beam, "stations": len(readings.table), **known}


def _svg(figure: Figure) -> str:
    text = _bytes(figure, "svg").decode()
    return text[text.index("<svg") :]


def _bytes(figure: Figure, kind: str) -> bytes:
    buffer = io.BytesIO()
    figure.savefig(buffer, format=kind, dpi=150)
    return buffer.getvalue()
