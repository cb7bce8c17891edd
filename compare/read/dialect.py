"""Tables as measuring programs write them: which separator, which decimal mark, where they begin.

These are found from the lines themselves: that reading counts under which most lines are numbers.
"""

import io
import re
from collections.abc import Iterator, Mapping
from itertools import compress, islice
from pathlib import Path
from typing import NamedTuple

import pandas as pd

from analytic.problem.errors import InputError, Place, row_number
from analytic.problem.files import regular_file
from compare.read.units import is_unit

_LARGEST = 512_000_000  # bytes; 10^6 rows of four columns have 80 MB
_LOOKED_AT = 200  # lines that decide
_ARCHIVES = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")  # what spreadsheets write, new and old
_MISSING = frozenset({"", "nan", "na", "n/a", "null", "none", "#n/a", "-"})
_NO_UNIT = frozenset({"-", "--", "1", "%", "°", "°C"})  # of nothing that is sensed
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d+)?|[+-]?(inf|infinity)", re.IGNORECASE)
_CLOCK = r"\d{1,2}:\d\d:\d\d(\.\d+)?"  # becomes seconds
_COMMA_IS_POINT = str.maketrans(",.", ".,")


class Dialect(NamedTuple):
    separator: str | None  # between cells; None for blanks
    decimal: str  # ``"."`` or ``","``

    def cells(self, line: str) -> list[str]:
        return [part.strip().strip('"').strip() for part in line.split(self.separator)]

    def pointed(self, text: str) -> str:
        """A text whose numbers have a decimal point."""
        return text.translate(_COMMA_IS_POINT) if self.decimal == "," else text

    def as_written(self, pointed: str) -> str:
        return pointed if _NUMBER.fullmatch(pointed.strip()) else self.pointed(pointed)

    def weight(self, cell: str) -> int:
        """What a cell says for its line being a row of numbers."""
        if cell.lower() in _MISSING:
            return 0
        return 1 if _NUMBER.fullmatch(self.pointed(cell)) else -1


_DIALECTS = [
    Dialect(separator, decimal)
    for separator in (";", "\t", ",", None)
    for decimal in (".", ",")
    if separator != decimal
]


class RawTable(NamedTuple):
    # Its columns, called ``"1"``, ``"2"``, ... if the file does not name them; those whose cells
    # are not all numbers are texts.
    frame: pd.DataFrame
    place: Place = row_number  # where a row stands
    units: Mapping[str, str] = {}  # of columns, if a line between the names and the data has them


def read_text_table(path: Path) -> RawTable:
    regular_file(path, "readings file", _LARGEST)
    try:
        content = path.read_bytes()
    except OSError as error:
        remedy = f"check it ({error.strerror})"
        raise InputError("readings file", path, "readable", remedy) from error
    if content.startswith(_ARCHIVES):
        raise InputError(f"readings file {path}", "a workbook", "text", "export it as CSV")
    text = _decoded(content)
    looked_at = list(islice(_filled(text), _LOOKED_AT))
    head = [line for _, line in looked_at]
    dialect = max(_DIALECTS, key=lambda one: _rows(one, head)[1])  # of equals the first
    begin, count = _rows(dialect, head)
    if not count:
        what = "without lines of two or more numbers"
        allowed = "a table of numbers, its columns named in the line before"
        raise InputError(f"readings file {path}", what, allowed, "export it as CSV")
    first, width = looked_at[begin][0], len(dialect.cells(head[begin]))
    titles = dialect.cells(head[begin - 1]) if begin else []
    if dialect.separator == "," and 2 * len(titles) == width:
        what, allowed = f"{width} cells for {len(titles)} names", "one for each"
        remedy = "its commas divide cells and decimals alike: export it with ';' or tabs between"
        raise InputError(f"readings file {path}", what, allowed, remedy)
    units = _units(dialect, head[:begin], dialect.cells(head[begin]))
    names = _names(dialect, head[: begin - bool(units)], width)
    rows = [(number, line) for number, line in _filled(text) if number >= first]

    def place(row: int) -> str:
        return f"line {rows[row][0]} of {path}"

    if '"' not in text:  # a separator in quotes is none; the parser sees to it
        for i, (_, line) in enumerate(rows):  # else numbers may be another column's
            found = len(line.split(dialect.separator))
            if found != width:
                allowed = f"{width}, as line {rows[0][0]}"
                raise InputError(place(i), f"{found} cells", allowed, "fix it")
    frame = _parsed(dialect, "\n".join(line for _, line in rows), names, path)
    return RawTable(frame, place, dict(zip(names, units, strict=False)))


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
    numbered = [right and dialect.weight(row[0]) > 0 for row, right in zip(rows, good, strict=True)]
    begin = good.index(True)
    if 2 * sum(numbered) > sum(good):  # "Samples 9 9 9" of a head is none; texts come after it
        first = numbered.index(True)
        begin = first if min(balance[begin:first], default=0) < 0 else begin
    numbers = [dialect.weight(cell) > 0 for cell in rows[begin]]
    while begin and _lacks_some(dialect, rows[begin - 1], numbers):
        begin -= 1
    return begin, sum(compress(balance, good))


def _lacks_some(dialect: Dialect, row: list[str], numbers: list[bool]) -> bool:
    """Whether a row has numbers and empty cells where the first full one has numbers."""
    if len(row) != len(numbers):
        return False
    weights = [dialect.weight(cell) for cell, number in zip(row, numbers, strict=True) if number]
    return 1 in weights and -1 not in weights


def _names(dialect: Dialect, before: list[str], width: int) -> list[str]:
    """The columns' names: the last line before the data, if it has as many cells."""
    named = _cells(dialect, before[-1], width) if before else []
    names = [name or str(i) for i, name in enumerate(named or [""] * width, 1)]
    return [  # the second of equal ones with its number
        name if names.index(name) == i else f"{name}.{names[:i].count(name)}"
        for i, name in enumerate(names)
    ]


def _cells(dialect: Dialect, line: str, width: int) -> list[str]:
    """The cells of a line before the data; none if they are not as many as the columns."""
    found = dialect.cells(line)
    if len(found) == width + 1 and found[-1] == "Comment":  # LabVIEW's last, mostly without cells
        found.pop()
    if len(found) != width:  # names with blanks, over columns between blanks
        found = re.split(r"\t| {2,}", line.strip())
    return found if len(found) == width else []


def _units(dialect: Dialect, before: list[str], data: list[str]) -> list[str]:
    """The columns' units: the last line before the data, if all in it are, with names above.

    But over texts: a clock's may be hh:mm:ss.
    """
    names, units = ([_cells(dialect, line, len(data)) for line in before[-2:]] + [[], []])[:2]
    units = [unit.strip("[]()") for unit in units]
    texts = [dialect.weight(cell) < 0 for cell in data]
    units = ["" if text or x in _NO_UNIT else x for x, text in zip(units, texts, strict=False)]
    given = [(name, unit) for name, unit in zip(names, units, strict=False) if unit]
    is_row = len(given) > 1 and all(name and is_unit(unit) for name, unit in given)
    return units if is_row else []


def _parsed(dialect: Dialect, rows: str, names: list[str], path: Path) -> pd.DataFrame:
    try:
        frame = pd.read_csv(
            io.StringIO(dialect.pointed(rows)),
            sep=dialect.separator or r"\s+",
            header=None,
            names=range(len(names)),
            skipinitialspace=True,
            na_values=["-"],
            low_memory=False,
        )
    except (ValueError, pd.errors.ParserError) as error:
        why = " ".join(str(error).split())
        raise InputError(
            f"readings file {path}", "unreadable", "a table of numbers", why
        ) from error
    for i, column in frame.items():
        if pd.api.types.is_string_dtype(column.dtype):
            if column.str.fullmatch(_CLOCK, na=True).all():
                frame[i] = pd.to_timedelta(column).dt.total_seconds()
            elif dialect.decimal == ",":  # what is no number stays as it is written
                frame[i] = column.map(dialect.as_written, na_action="ignore")
    return frame.set_axis(names, axis=1)
