"""A document as one offline HTML file, in light and dark, on paper and on a telephone."""

import base64
import io
import platform
import re
import shlex
import subprocess
import sys
import warnings
from collections.abc import Mapping
from contextlib import suppress
from datetime import datetime
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np
from markupsafe import Markup, escape
from matplotlib import rc_context
from matplotlib.figure import Figure
from pydantic_core import to_json

from analytic.numerics.arrays import Floats
from analytic.problem.files import SOFTWARE, write_whole
from compare.show.document import Document, Table
from compare.show.scene import SweepScene, corners_and_faces, normals
from compare.show.style import BLUE, BODY, FAINT, GREEN, GREY, INK, ORANGE, PAPER, PHASE_NAMES, PINK

if TYPE_CHECKING:
    from jinja2 import Template
    from pandas import DataFrame

Content: TypeAlias = "str | bytes | Document | Figure | Mapping[str, Any] | DataFrame"

_PACKAGES = {"vibrissa-testbed": "vibrissa-testbed", "numpy": "NumPy", "scipy": "SciPy",
             "mujoco": "MuJoCo"}  # fmt: skip
_PATIENCE = 5  # s; a repository on a slow disk is no reason to wait
_STATIONS = 200  # that a slider has
_GHOSTS = 24  # shapes that are always there
_DIGITS = 4  # of a length in L: a tenth of a pixel
_LIGHT = np.array([0.3, 0.2, 0.9]) / np.linalg.norm([0.3, 0.2, 0.9])
_DARKEST = 0.62
_COLOURS = {"free": "faint", "tip": "blue", "tangent": "orange"}  # of the page, light or dark


def html(document: Document) -> str:
    made = Table("This report", (), [*colophon().items()], words=(1,))
    return _template().render(document=document, made=made)


@cache  # to compile it takes longer than to fill it in
def _template() -> "Template":
    from jinja2 import Environment, PackageLoader, StrictUndefined  # slow to load

    environment = Environment(
        loader=PackageLoader("compare.show"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        kind=lambda block: type(block).__name__,
        svg=inline_svg,
        embedded=embedded,
        turning=turning,
        # Words between back quotes are code.
        code=lambda text: Markup(re.sub("`([^`]+)`", r"<code>\1</code>", str(escape(text)))),
    )
    return environment.get_template("document.html.j2")


def colophon() -> dict[str, str]:
    """What is known of the process that makes a page."""
    program, *words = sys.argv
    versions = [f"Python {platform.python_version()}"]
    for package, name in _PACKAGES.items():
        with suppress(PackageNotFoundError):
            versions.append(f"{name} {version(package)}")
    found = {
        "command": "" if program in ("", "-c") else shlex.join([Path(program).name, *words]),
        "date": datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z"),
        "versions": ", ".join(versions),
        "commit": _commit(),
    }
    return {name: value for name, value in found.items() if value}


def _commit() -> str:
    root = Path(__file__).parents[2]
    if not (root / ".git").exists():
        return ""
    try:
        described = subprocess.run(
            ["git", "-C", root, "describe", "--always", "--dirty", "--abbrev=10", "--exclude=*"],
            capture_output=True,
            text=True,
            timeout=_PATIENCE,
            check=True,
        )
    except (OSError, subprocess.SubprocessError):
        return ""
    return described.stdout.strip()


def turning(scene: SweepScene) -> dict[str, object]:
    """What ``turning.js`` draws, as JSON holds it."""
    shown = np.unique(np.linspace(0, len(scene.foot) - 1, _STATIONS).round().astype(int))
    touching = [n for n, i in enumerate(shown) if np.isfinite(scene.contact[i]).all()]
    corners, where = corners_and_faces(scene.faces)
    lit = _DARKEST + (1 - _DARKEST) * (1 + normals(scene.faces) @ _LIGHT) / 2
    lights = zip(lit.round(2).tolist(), where.tolist(), strict=True)
    return {
        "low": _rounded(scene.low),
        "high": _rounded(scene.high),
        "corners": _rounded(corners),
        "faces": [[light, *face] for light, face in lights],
        "every": max(1, len(shown) // _GHOSTS),
        "first": touching[len(touching) // 2] if touching else 0,
        "colours": _COLOURS,
        "stations": [
            {
                "foot": _rounded(scene.foot[i]),
                "line": _rounded(scene.lines[i]),
                "contact": _rounded(scene.contact[i]),
                "phase": scene.phase[i],
                "said": _said(scene, int(i)),
            }
            for i in shown
        ],
    }


def _said(scene: SweepScene, station: int) -> str:
    x, _, z = scene.foot[station]
    table = scene.readings.table
    status = str(table["status"].iloc[station]) if "status" in table else "ok"
    phase = PHASE_NAMES[scene.phase[station]] if status == "ok" else status
    count = len(scene.foot)
    return f"station {station + 1} of {count}, foot at ({x:.3f}, {z:.3f}) L, {phase}"


def _rounded(values: Floats) -> list[object] | None:
    if not np.isfinite(values).all():
        return None
    found: list[object] = values.round(_DIGITS).tolist()
    return found


_THEMED = {
    INK: "currentColor",
    PAPER: "var(--page)",
    GREY: "var(--grey)",
    FAINT: "var(--faint)",
    BODY: "var(--body)",
    BLUE: "var(--blue)",
    ORANGE: "var(--orange)",
    GREEN: "var(--green)",
    PINK: "var(--pink)",
}
_IMAGE_DPI = 180  # of what is too much to be drawn as lines
_COLOUR = re.compile(r"#[0-9a-f]{6}\b")
_IDENTIFIED = (' id="', 'href="#', "url(#")  # what is followed by an identifier


def inline_svg(figure: Figure, name: str, description: str) -> Markup:
    """A figure as an ``<svg>`` element, in the page's own colours, light or dark."""
    with rc_context({"svg.hashsalt": name}):
        unnamed = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        text = _drawn(figure, "svg", transparent=True, dpi=_IMAGE_DPI, metadata=unnamed).decode()
    text = text[text.index("<svg") :]
    text = _COLOUR.sub(lambda colour: _THEMED.get(colour[0], colour[0]), text)
    for before in _IDENTIFIED:
        text = text.replace(before, f"{before}{name}-")
    opening = f'<svg role="img" fill="currentColor" aria-label="{escape(description)}"'
    return Markup(text.replace("<svg", opening, 1))  # drawn here, its words escaped


def png(figure: Figure, dots_per_inch: int = 150) -> bytes:
    return _drawn(figure, "png", dpi=dots_per_inch, metadata={"Software": SOFTWARE})


def write_all(folder: Path, contents: Mapping[str, Content]) -> list[Path]:
    """Write files by name, in the order given: all is drawn first, and each appears whole."""
    made = {folder / name: as_file(content) for name, content in contents.items()}
    for path in made:
        path.parent.mkdir(parents=True, exist_ok=True)
    return [write_whole(path, content) for path, content in made.items()]


def as_file(content: Content) -> str | bytes:
    """A page, a picture, JSON of numbers by name, or a table as CSV; a text is as it is.

    JSON has null for what is no number, dataclasses by field.
    """
    match content:
        case str() | bytes():
            return content
        case Document():
            return html(content)
        case Figure():
            return png(content)
        case Mapping():
            return to_json(content, indent=2, inf_nan_mode="null").decode()
    return str(content.to_csv(index=False))


def embedded(file: Path) -> str:
    """A picture file as an address that holds all of it."""
    content = base64.b64encode(file.read_bytes()).decode()
    return f"data:image/{file.suffix.removeprefix('.')};base64,{content}"


def _drawn(figure: Figure, kind: str, **options: Any) -> bytes:  # noqa: ANN401
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        # A character that the font lacks is drawn as a box; the page's text has it.
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        # Its parts are placed once for all pictures of it: `savefig` draws each twice to do it.
        layout = figure.get_layout_engine()
        if layout is not None:
            layout.execute(figure)
            figure.set_layout_engine(None)
        figure.savefig(buffer, format=kind, **options)
    return buffer.getvalue()
