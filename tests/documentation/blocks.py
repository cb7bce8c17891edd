"""The pages of the documentation, and the blocks of code in them.

What a block needs to be run stands in a comment before it, which no reader sees:
``<!-- slow -->``, ``<!-- file: NAME -->`` for a block that is the content of a file,
``<!-- not run: REASON -->``. A block without a language after one that is run is what that prints,
where ``...`` stands for anything.
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import zip_longest
from pathlib import Path

ROOT = Path(__file__).parents[2]
_FOLDERS = ("analytic", "mujoco_models", "engines", "compare", "tests", "docs")
_FILES = [*ROOT.glob("*.md"), ROOT / "results" / "README.md"]
_FILES += [path for folder in _FOLDERS for path in (ROOT / folder).rglob("*.md")]
PAGES = sorted(path.relative_to(ROOT) for path in _FILES)

_BLOCK = re.compile(
    r"^(?:<!-- (?P<note>[^>]*?) -->\n)?```(?P<language>\w*)\n(?P<text>.*?)^```$", re.M | re.S
)


@dataclass(frozen=True)
class Block:
    """A block of a page.

    Attributes
    ----------
    page : Path
        The page, from the top folder.
    line : int
        Where the block's text begins.
    language, text : str
        As it stands there.
    note : str
        What stands in the comment before it.
    prints : str or None
        What the page says that it prints.
    """

    page: Path
    line: int
    language: str
    text: str
    note: str
    prints: str | None = None

    @property
    def file(self) -> str | None:
        """Name of the file that the block is the content of."""
        return self.note.removeprefix("file: ") if self.note.startswith("file: ") else None

    @property
    def runs(self) -> bool:
        """Whether it is code or commands to be run."""
        kind = self.language in ("python", "sh")
        return kind and self.file is None and not self.note.startswith("not run: ")

    @property
    def slow(self) -> bool:
        """Whether it takes long."""
        return self.note == "slow"

    def __str__(self) -> str:
        return f"{self.page}:{self.line}"


def blocks(page: Path) -> Iterator[Block]:
    """The blocks of a page that are code, commands or files, in order."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = list(_BLOCK.finditer(text))
    for this, after in zip_longest(found, found[1:]):
        printed = after and after["language"] == "" and not text[this.end() : after.start()].strip()
        yield Block(
            page,
            text[: this.start("text")].count("\n") + 1,
            this["language"],
            this["text"],
            this["note"] or "",
            after["text"] if after and printed else None,
        )
