"""The elements of an MJCF file and of what it includes, by their places in the text."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from xml.parsers import expat

from analytic.problem.errors import InputError


@dataclass
class Element:
    """An element in the text of a file."""

    tag: str
    attributes: dict[str, str]
    file: Path
    start: int  # of its start tag, in bytes
    children: list["Element"] = field(default_factory=list)
    end: int = 0  # of its end tag, or of itself if it has none

    def below(self) -> Iterator["Element"]:
        """It and all that is in it, in the order of the text."""
        yield self
        for child in self.children:
            yield from child.below()


def read_tree(path: Path, folder: Path | None = None, seen: tuple[Path, ...] = ()) -> Element:
    """The root of a file, with includes in their places; MuJoCo finds these from the main file."""
    folder = folder or path.parent
    if path in seen:
        raise InputError("model", path, "a file that does not include itself", "take it out")
    parser = expat.ParserCreate()
    open_: list[Element] = []
    roots: list[Element] = []

    def started(tag: str, attributes: dict[str, str]) -> None:
        element = Element(tag, attributes, path, parser.CurrentByteIndex)
        if open_:
            open_[-1].children.append(element)
        else:
            roots.append(element)
        open_.append(element)

    def ended(_: str) -> None:
        open_.pop().end = parser.CurrentByteIndex

    parser.StartElementHandler, parser.EndElementHandler = started, ended
    try:
        parser.Parse(path.read_bytes(), True)
    except (expat.ExpatError, OSError) as error:
        raise InputError("model", path, "XML that can be read", f"correct it ({error})") from error
    for element in list(roots[0].below()):
        element.children = [
            inner
            for child in element.children
            for inner in (
                [child, *read_tree(folder / child.attributes.get("file", ""), folder,
                                   (*seen, path)).children]
                if child.tag == "include"
                else [child]
            )
        ]  # fmt: skip
    return roots[0]
