"""A document as one offline HTML file, in light and dark, on paper and on a telephone."""

import re
from functools import cache
from typing import TYPE_CHECKING

from markupsafe import Markup, escape

from compare.show.colophon import colophon
from compare.show.document import Document, Table
from compare.show.page import embedded, inline_svg
from compare.show.turning import turning

if TYPE_CHECKING:
    from jinja2 import Template


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
        code=_code,
    )
    return environment.get_template("document.html.j2")


def _code(text: object) -> Markup:
    """Text whose words between back quotes are code."""
    return Markup(re.sub("`([^`]+)`", r"<code>\1</code>", str(escape(text))))
