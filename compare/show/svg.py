"""Figures as part of an HTML page: they take its colours, light or dark, and its narrator's voice.

A page holds many figures, so their identifiers must differ, and no link may lead elsewhere.
"""

import io
import re

from markupsafe import Markup, escape
from matplotlib import rc_context
from matplotlib.figure import Figure

_THEMED = {
    "#000000": "currentColor",
    "#ffffff": "var(--page)",
    "#555555": "var(--grey)",
    "#999999": "var(--faint)",
    "#dddddd": "var(--body)",
    "#0072b2": "var(--blue)",
    "#d55e00": "var(--orange)",
    "#009e73": "var(--green)",
    "#cc79a7": "var(--pink)",
}
_COLOUR = re.compile(r"#[0-9a-f]{6}\b")
_IDENTIFIER = re.compile(r'(\bid="|href="#|url\(#)')


def inline_svg(figure: Figure, name: str, says: str) -> Markup:
    """A figure as an ``<svg>`` element.

    Parameters
    ----------
    figure : Figure
        Drawn with the colours that the pages have a light and a dark version of; others stay.
    name : str
        Distinguishes it from the page's other figures.
    says : str
        What it shows, for those who cannot see it.
    """
    buffer = io.StringIO()
    with rc_context({"svg.hashsalt": name}):
        unsaid = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        figure.savefig(buffer, format="svg", transparent=True, metadata=unsaid)
    text = buffer.getvalue()
    text = text[text.index("<svg") :]
    text = _COLOUR.sub(lambda colour: _THEMED.get(colour[0], colour[0]), text)
    text = _IDENTIFIER.sub(rf"\g<1>{name}-", text)
    opening = f'<svg role="img" fill="currentColor" aria-label="{escape(says)}"'
    return Markup(text.replace("<svg", opening, 1))  # drawn here, its words escaped
