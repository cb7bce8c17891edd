"""A document as one offline HTML file, in light and dark, on paper and on a telephone."""

from functools import cache
from typing import TYPE_CHECKING, Any

from markupsafe import Markup

from compare.show.colophon import colophon
from compare.show.document import Document, Table
from compare.show.page import embedded, inline_svg

if TYPE_CHECKING:
    from jinja2 import Environment


def html(document: Document) -> str:
    """The document as a page."""
    made = Table("This report", (), [*colophon().items()], words=(1,))
    return str(render("document.html.j2", document=document, made=made))


def render(template: str, **values: Any) -> Markup:  # noqa: ANN401
    """Fill in a template."""
    return Markup(_environment().get_template(template).render(**values))


@cache  # it keeps the templates that it has compiled, which takes longer than to fill them in
def _environment() -> "Environment":
    from jinja2 import Environment, PackageLoader, StrictUndefined  # slow to load

    from compare.show.turning import turning

    environment = Environment(
        loader=PackageLoader("compare.show"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        kind=lambda block: type(block).__name__, svg=inline_svg, embedded=embedded, turning=turning
    )
    return environment
