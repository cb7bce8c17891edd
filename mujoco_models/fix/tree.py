"""The elements of an MJCF file and of what it includes or attaches, by places in the text."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeAlias
from xml.parsers import expat

from analytic.problem.errors import InputError

Place: TypeAlias = tuple[Path, int]


@dataclass
class Element:
    """An element in the text of a file."""

    tag: str
    attributes: dict[str, str]
    file: Path
    start: int  # of its start tag, in bytes
    children: list["Element"] = field(default_factory=list)
    end: int = 0  # of its end tag, or of itself if it has none
    model: tuple["Element", ...] = ()  # the root of what is attached, if it is of that

    @property
    def place(self) -> Place:
        return self.file, self.start

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
    _attach(roots[0], folder)
    return roots[0]


_LISTS = ("sensor", "actuator", "equality")  # what comes with what is attached


def _attach(root: Element, folder: Path) -> None:
    """Put what other models' bodies hold, under the names that it has here, in its place."""
    files: dict[str, Path] = {}
    for asset in root.below():
        file = folder / asset.attributes.get("file", "")
        if asset.tag == "model" and file.is_file():
            own = read_tree(file).attributes.get("model", "")
            files[asset.attributes.get("name", own)] = file
    for element in list(root.below()):
        element.children = [
            inner
            for child in element.children
            for inner in (_attached(child, files, root) if child.tag == "attach" else [child])
        ]


def _attached(attach: Element, files: dict[str, Path], into: Element) -> list[Element]:
    file = files.get(attach.attributes.get("model", ""))
    if file is None:
        return [attach]
    root, prefix = read_tree(file), attach.attributes.get("prefix", "")
    for element in root.below():
        element.model = (root,)
        if "name" in element.attributes:
            element.attributes["name"] = prefix + element.attributes["name"]
    into.children += [child for child in root.children if child.tag in _LISTS]
    if "body" in attach.attributes:
        name = prefix + attach.attributes["body"]
        return [e for e in root.below() if e.tag == "body" and e.attributes.get("name") == name]
    return [e for world in root.children if world.tag == "worldbody" for e in world.children]
