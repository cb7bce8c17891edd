"""What is said of a result, whoever shows it: a page in HTML or Markdown, or a terminal."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Literal, TypeAlias

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from compare.show.scene import SweepScene

Layout: TypeAlias = Literal["wide", "panels", "three", "middle", "still"]


@dataclass(frozen=True)
class Text:
    said: str
    strong: str = ""  # what stands before it, in bold
    aside: bool = False  # whether it may be passed over


@dataclass(frozen=True)
class Items:
    said: Sequence[str]


@dataclass(frozen=True)
class Table:
    """Cells as they are read; the first column names the rows."""

    caption: str
    head: Sequence[str]  # none if empty
    rows: Sequence[Sequence[str]]
    words: Collection[int] = (0,)  # columns that may be folded; the others hold numbers
    blamed: Collection[int] = ()  # rows that stand out
    whole: Collection[int] = ()  # rows that sum up those above them


@dataclass(frozen=True)
class Tile:
    """One number that matters."""

    name: str
    value: str
    note: str


def tiles_line(found: Iterable[Tile]) -> Text:
    """Tiles beside each other, without their notes."""
    line = "; ".join(f"{one.name} {one.value}" for one in found)
    return Text(f"{line[:1].upper()}{line[1:]}.")


@dataclass(frozen=True)
class Verdict:
    good: bool
    claim: str  # in bold
    said: str = ""
    why: str = ""
    failures: Sequence[str] = ()
    remarks: Sequence[str] = ()


@dataclass(frozen=True, eq=False)
class Picture:
    """Figures side by side, drawn when somebody looks at them."""

    name: str  # unique on its page
    draw: "Mapping[str, Callable[[], Figure]]"  # by what they show for those who cannot see them
    caption: str
    layout: Layout = "wide"

    @cached_property
    def figures(self) -> "Mapping[str, Figure]":
        return {shows: draw() for shows, draw in self.draw.items()}


@dataclass(frozen=True)
class Image:
    """A picture that is a file already."""

    file: Path
    shows: str  # for those who cannot see it
    caption: str


@dataclass(frozen=True)
class Film:
    """A sweep in motion: a GIF, and a PNG for those who want nothing to move."""

    gif: Path
    still: Path

    @classmethod
    def of(cls, folder: Path) -> "Film | None":
        film = cls(folder / "animation.gif", folder / "still-3.png")
        return film if film.gif.is_file() and film.still.is_file() else None


@dataclass(frozen=True)
class Turntable:
    """A sweep in space that the reader turns; where that cannot be, the still of it is shown."""

    scene: "SweepScene"


@dataclass(frozen=True)
class Beside:
    """What may stand side by side."""

    blocks: "Sequence[Block]"


Block: TypeAlias = Text | Items | Table | Verdict | Picture | Image | Film | Turntable | Beside


@dataclass(frozen=True)
class Section:
    name: str  # by which it is linked to
    title: str
    blocks: Sequence[Block]


@dataclass(frozen=True)
class Document:
    title: str
    lead: str
    verdict: Verdict
    sections: Sequence[Section]
    tiles: Sequence[Tile] = ()

    def pictures(self) -> Iterator[Picture]:
        for section in self.sections:
            for block in section.blocks:
                within = block.blocks if isinstance(block, Beside) else [block]
                yield from (one for one in within if isinstance(one, Picture))


def sections(*parts: tuple[str, str, Iterable[Block]]) -> list[Section]:
    """Sections by name, title and blocks, but for those that have none."""
    found = [Section(name, title, [*blocks]) for name, title, blocks in parts]
    return [one for one in found if one.blocks]
