"""What all pages are made with: numbers and names for people, templates, pictures, documents."""

import base64
import io
import json
import re
import warnings
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from markupsafe import Markup, escape
from matplotlib import rc_context
from matplotlib.figure import Figure

from analytic.problem.files import write_whole
from compare.show.style import BLUE, BODY, FAINT, GREEN, GREY, INK, ORANGE, PAPER, PINK, PNG_LEVEL

if TYPE_CHECKING:
    from jinja2 import Environment

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
_MARKDOWN = re.compile(r"[\\`*~$\[\]]|#(?!\d+;)|(?<!\w)_|_(?!\w)")


def short(x: float | None) -> str:
    """Two digits and a power of ten."""
    if x is None or x != x:
        return "none"
    return f"{x:.1e}".replace("e-0", "e-").replace("e+0", "e+") if x else "0"


def place(x: float | None) -> str:
    """A position, to what a picture could show."""
    return "none" if x is None or x != x else f"{x:.5g}"


def words(name: str) -> str:
    """An identifier as words."""
    return name.replace("_", " ").replace("phase b", "Phase B")


def markdown(text: object) -> str:
    """Text without what Markdown or HTML would make of it."""
    line = " ".join(str(text).split())
    line = re.sub(r"[&<>|]", lambda mark: f"&#{ord(mark[0])};", line)
    return _MARKDOWN.sub(r"\\\g<0>", line)


def render(package: str, template: str, **values: Any) -> str:  # noqa: ANN401
    """Fill in a template."""
    environment = _environment(package, template.endswith(".md.j2"))
    return environment.get_template(template).render(**values)


@cache  # it keeps the templates that it has compiled, which takes longer than to fill them in
def _environment(package: str, is_markdown: bool) -> "Environment":
    from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined  # slow to load

    environment = Environment(
        loader=ChoiceLoader([PackageLoader(package), PackageLoader("compare.show")]),
        autoescape=not is_markdown,
        finalize=_as_markdown if is_markdown else None,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(short=short, place=place, words=words)
    return environment


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
    """A figure as the contents of a PNG file."""
    return _drawn(figure, "png", dpi=dots_per_inch, pil_kwargs={"compress_level": PNG_LEVEL})


def save_figure(figure: Figure, path: Path) -> Path:
    """Write a PNG, whole or not at all."""
    return write_whole(path, png(figure))


def embedded(file: Path) -> str:
    """A picture file as an address that holds all of it."""
    content = base64.b64encode(file.read_bytes()).decode()
    return f"data:image/{file.suffix.removeprefix('.')};base64,{content}"


def document(content: Mapping[str, Any]) -> str:
    """What a JSON file of results holds, as text."""
    return json.dumps(content, indent=2)


def _as_markdown(value: object) -> object:
    return value if isinstance(value, Markup) else markdown(value)


def _drawn(figure: Figure, kind: str, **options: Any) -> bytes:  # noqa: ANN401
    buffer = io.BytesIO()
    with warnings.catch_warnings():
        # A character that the font lacks is drawn as a box; the page's text has it.
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        _lay_out(figure)
        figure.savefig(buffer, format=kind, **options)
    return buffer.getvalue()


def _lay_out(figure: Figure) -> None:
    """Place its parts, once for all pictures of it: `savefig` draws each one twice to do it."""
    layout = figure.get_layout_engine()
    if layout is not None:
        layout.execute(figure)
        figure.set_layout_engine(None)
