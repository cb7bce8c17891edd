"""Tables as measuring programs write them: which separator, which decimal mark, where they begin.

What a program writes differs in three ways: what is between two cells (a comma, a semicolon, a
tab, blanks), whether 0.5 is 0.5 or 0,5, and how many lines of its own come first. The three are
found from the lines themselves: that reading counts under which the most lines are numbers.
"""

import io
import re
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import compress
from pathlib import Path
from typing import Any

import pandas as pd

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file
from compare.read.units import is_unit

_LARGEST = 512_000_000  # bytes; 10^6 rows of four columns have 80 MB
_LOOKED_AT = 200  # lines that decide
_BLANKS = r"\s+"
_MISSING = frozenset({"", "nan", "na", "n/a", "null", "none", "#n/a", "-"})
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?|[+-]?(inf|infinity)", re.IGNORECASE)


@dataclass(frozen=True)
class Dialect:
    """How a table is written."""

    separator: str  # between cells: ``","``, ``";"``, a tab, or a pattern for blanks
    decimal: str  # ``"."`` or ``","``

    def cells(self, line: str) -> list[str]:
        """The cells of a line."""
        parts = line.split() if self.separator == _BLANKS else line.split(self.separator)
        return [part.strip().strip('"').strip() for part in parts]

    def weight(self, cell: str) -> int:
        """What a cell says for its line being a row of numbers."""
        if cell.lower() in _MISSING:
            return 0
        written = "?" if self.decimal == "," and "." in cell else self.with_point(cell)
        return 1 if _NUMBER.fullmatch(written) else -1

    def with_point(self, cell: Any) -> Any:  # noqa: ANN401  # an empty cell is no text
        """A cell with a decimal point, if it is a number."""
        if self.decimal == "," and isinstance(cell, str):
            pointed = cell.replace(",", ".")
            return pointed if _NUMBER.fullmatch(pointed) else cell
        return cell


_DIALECTS = tuple(
    Dialect(separator, decimal)
    for separator in (";", "\t", ",", _BLANKS)
    for decimal in (".", ",")
    if separator != decimal
)


@dataclass(frozen=True)
class TextTable:
    """A table in a text file."""

    # Its columns, called ``"1"``, ``"2"``, ... if the file does not name them; those whose cells
    # are not all numbers are texts.
    frame: pd.DataFrame
    path: Path  # the file
    text: str  # what is in it
    first: int  # line of its first row
    units: dict[str, str]  # units of the columns, if a line between the names and the data has them

    def place(self, row: int) -> str:
        """Where a row stands."""
        filled = (number for number, line in _filled(self.text) if number >= self.first)
        number = next((n for i, n in enumerate(filled) if i == row), self.first + row)
        return f"line {number} of {self.path}"


def read_text_table(path: Path) -> TextTable:
    """A table in a text file, whoever wrote it."""
    regular_file(path, "readings file", _LARGEST)
    try:
        text = _decoded(path.read_bytes())
    except OSError as error:
        raise InputError(
            "readings file", path, "readable", f"check it ({error.strerror})"
        ) from error
    head = [line for _, line in _first(text)]
    dialect = max(_DIALECTS, key=lambda one: _rows(one, head)[1])  # of equals the first
    begin, count = _rows(dialect, head)
    if not count:
        raise InputError(
            f"readings file {path}",
            "without lines of two or more numbers",
            "a table of numbers, its columns named in the line before",
            "export it as CSV",
        )
    numbered = list(_first(text))
    first, line = numbered[begin]
    width = len(dialect.cells(line))
    before = [line for _, line in numbered[:begin]]
    units = _units(dialect, before, width)
    names = _distinct(_names(dialect, before[:-1] if units else before, width))
    _check_widths(dialect, text, first, width, path)
    frame = _parsed(dialect, text, first, names, path)
    return TextTable(frame, path, text, first, dict(zip(names, units, strict=False)))


def _decoded(content: bytes) -> str:
    if content.startswith((b"\xff\xfe", b"\xfe\xff")):
        return content.decode("utf-16", errors="replace")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252", errors="replace")  # a degree sign or an umlaut in a name


def _filled(text: str) -> Iterator[tuple[int, str]]:
    """The lines that are neither blank nor comments, each with its number from 1."""
    for number, line in enumerate(io.StringIO(text, newline=None), 1):
        stripped = line.strip()
        if stripped and not stripped.startswith(("#", "%")):
            yield number, line.rstrip("\r\n")


def _first(text: str) -> Iterator[tuple[int, str]]:
    for index, found in enumerate(_filled(text)):
        if index == _LOOKED_AT:
            return
        yield found


def _rows(dialect: Dialect, lines: list[str]) -> tuple[int, int]:
    """Where the data begin under a dialect, and how many more cells are numbers than are not.

    A row may have texts too, as a time or a phase, but not more of them than numbers.
    """
    rows = [dialect.cells(line) for line in lines]
    balance = [sum(map(dialect.weight, row)) for row in rows]
    widths = [len(row) for row, more in zip(rows, balance, strict=True) if more > 0]
    if not widths or max(widths) < 2:
        return 0, 0
    width = max(widths, key=widths.count)
    good = [len(row) == width and more > 0 for row, more in zip(rows, balance, strict=True)]
    return good.index(True), sum(compress(balance, good))


def _names(dialect: Dialect, before: list[str], width: int) -> list[str]:
    """The columns' names: the last line before the data, if it has as many cells."""
    named = _cells(dialect, before[-1], width) if before else []
    return [name or str(i) for i, name in enumerate(named, 1)] or [str(i + 1) for i in range(width)]


def _cells(dialect: Dialect, line: str, width: int) -> list[str]:
    """The cells of a line before the data; none if they are not as many as the columns."""
    found = dialect.cells(line)
    if len(found) != width:  # names with blanks, over columns between blanks
        found = re.split(r"\t| {2,}", line.strip())
    return found if len(found) == width else []


def _units(dialect: Dialect, before: list[str], width: int) -> list[str]:
    """The columns' units: the last line before the data, if all in it are, with names above."""
    names, units = ([_cells(dialect, line, width) for line in before[-2:]] + [[], []])[:2]
    units = [unit.strip("[]") for unit in units]
    given = [(name, unit) for name, unit in zip(names, units, strict=False) if unit]
    is_row = len(given) > 1 and all(name and is_unit(unit) for name, unit in given)
    return units if is_row else []


def _check_widths(dialect: Dialect, text: str, first: int, width: int, path: Path) -> None:
    """Refuse lines with too many or too few cells: their numbers may be another column's."""
    if '"' in text:  # a separator in quotes is none; the parser sees to it
        return
    for number, line in _filled(text):
        if dialect.separator == _BLANKS:
            found = len(line.split())
        else:
            found = line.count(dialect.separator) + 1
        if number >= first and found != width:
            raise InputError(
                f"line {number} of {path}", f"{found} cells", f"{width}, as line {first}", "fix it"
            )


def _parsed(dialect: Dialect, text: str, first: int, names: list[str], path: Path) -> pd.DataFrame:
    rows = "\n".join(line for number, line in _filled(text) if number >= first)
    try:
        frame = pd.read_csv(
            io.StringIO(rows),
            sep=dialect.separator,
            decimal=dialect.decimal,
            header=None,
            names=range(len(names)),
            skipinitialspace=True,
            na_values=["-"],
            low_memory=False,
        )
    except (ValueError, pd.errors.ParserError) as error:
        raise InputError(
            f"readings file {path}",
            "unreadable",
            "a table of numbers",
            " ".join(str(error).split()),
        ) from error
    if dialect.decimal == ",":  # a column with a text in it is left to the next reader
        for name, column in frame.items():
            if not pd.api.types.is_numeric_dtype(column):
                frame[name] = [dialect.with_point(cell) for cell in column]
    return frame.set_axis(names, axis=1)


def _distinct(names: list[str]) -> list[str]:
    """The names, the second of equal ones with its number."""
    return [
        name if names.index(name) == i else f"{name}.{names[:i].count(name)}"
        for i, name in enumerate(names)
    ]
