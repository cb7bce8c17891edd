"""What an HTML page is made of, for tests of the pages that are written."""

from dataclasses import dataclass, field
from html.parser import HTMLParser

from compare.show.page import html
from compare.show.plane_page import plane_document

VOID = {"meta", "link", "img", "br", "hr", "input", "source"}
ADDRESSES = ("href", "src", "srcset", "xlink:href", "data", "action", "poster")


@dataclass
class Page(HTMLParser):
    """Elements in order; every tag that is not closed where it should be is a fault."""

    text: str
    elements: list[tuple[str, dict[str, str]]] = field(default_factory=list)
    faults: list[str] = field(default_factory=list)
    _open: list[str] = field(default_factory=list)

    def __post_init__(self):
        super().__init__()
        self.feed(self.text)
        self.close()
        self.faults += [f"<{tag}> never closed" for tag in self._open]

    def handle_starttag(self, tag, attrs):
        self.elements.append((tag, dict(attrs)))
        if tag not in VOID:
            self._open.append(tag)

    def handle_endtag(self, tag):
        if not self._open or self._open[-1] != tag:
            self.faults.append(f"</{tag}> inside <{self._open[-1] if self._open else 'nothing'}>")
        else:
            self._open.pop()

    def all(self, *tags: str) -> list[dict[str, str]]:
        return [attributes for tag, attributes in self.elements if tag in tags]

    @property
    def ids(self) -> list[str]:
        return [attributes["id"] for _, attributes in self.elements if "id" in attributes]

    @property
    def addresses(self) -> list[str]:
        return [a[name] for _, a in self.elements for name in ADDRESSES if name in a]


def written_page(comparison) -> str:
    """The report without its pictures."""
    document = plane_document(comparison)
    for picture in document.pictures():
        vars(picture)["figures"] = {}
    return html(document)
