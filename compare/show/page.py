"""Figures as files, and as parts of a page."""

import base64
import io
import re
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from markupsafe import Markup, escape
from matplotlib import rc_context
from matplotlib.figure import Figure
from pydantic_core import to_json

from analytic.problem.files import SOFTWARE, write_whole
from compare.show.style import BLUE, BODY, FAINT, GREEN, GREY, INK, ORANGE, PAPER, PINK

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


def save_figure(figure: Figure, path: Path) -> Path:
    return write_whole(path, png(figure))


def embedded(file: Path) -> str:
    """A picture file as an address that holds all of it."""
    content = base64.b64encode(file.read_bytes()).decode()
    return f"data:image/{file.suffix.removeprefix('.')};base64,{content}"


def as_json(content: Mapping[str, Any]) -> str:
    """What a JSON file of results holds: null for what is no number, dataclasses by field."""
    return to_json(content, indent=2, inf_nan_mode="null").decode()


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
