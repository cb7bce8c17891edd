"""A TOML file whose errors name the line they are on."""

import re
import tomllib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeAlias

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file

Place: TypeAlias = Callable[[Sequence[str]], str]
"""What an error calls a key: where it is, and its name."""

_LARGEST = 2_000_000  # bytes: some 50,000 points; what is slower to parse than to compute
_SHOWN = 60  # characters of a key
_WIDEST = 1024  # bits of an integer; beyond that it fits no float, and Python may not print it

# What may hold a newline or a bracket that ends no statement, else brackets and newlines.
_TOKEN = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}'
    r"|'''.*?'{3,5}"
    r'|"(?:\\.|[^"\\\n])*"'
    r"|'[^'\n]*'"
    r"|#[^\n]*"
    r"|[\[{]|[\]}]|\n",
    re.DOTALL,
)


@dataclass(frozen=True)
class TomlFile:
    """A TOML file, read and parsed."""

    path: Path  # where it is
    text: str  # what is in it
    tables: dict[str, Any]  # the same, parsed

    @classmethod
    def read(cls, path: Path, what: str) -> "TomlFile":
        """Read a file."""
        regular_file(path, what, _LARGEST)
        try:
            text = path.read_bytes().decode("utf-8")
            tables = tomllib.loads(text)
            wide = list(_wide_integers(tables, ()))
        except OSError as error:
            reason = error.strerror or type(error).__name__
            raise InputError(what, path, "readable", f"check the path ({reason})") from error
        except UnicodeDecodeError as error:
            raise InputError(
                what, path, "text in UTF-8", f"save it as UTF-8 ({error.reason})"
            ) from error
        except RecursionError as error:
            raise InputError(what, path, "fewer levels deep", "take brackets away") from error
        except ValueError as error:  # tomllib's own, and an integer of thousands of digits
            raise InputError(what, path, "valid TOML", f"correct it: {error}") from error
        file = cls(path, text.replace("\r\n", "\n"), tables)
        for keys, bits in wide:
            raise InputError(
                file.place(keys), f"an integer of {bits} bits", "less than 1e308", "correct it"
            )
        return file

    def place(self, keys: Sequence[str]) -> str:
        """Where a key is, as ``"grid.toml, line 7: axes.mujoco.segments"``."""
        line = next(
            (
                line
                for depth in range(len(keys), 0, -1)
                for line, tables in self._statements
                if _holds(tables, keys[:depth])
            ),
            None,
        )
        name = ".".join(key if len(key) <= _SHOWN else f"{key[:_SHOWN]}..." for key in keys)
        return f"{self.path}{'' if line is None else f', line {line}'}: {name}"

    @cached_property
    def _statements(self) -> list[tuple[int, dict[str, Any]]]:
        """The line of each statement, and what the statement says by itself.

        The file is valid, so every statement is too, and the parser reads it. Those of a table are
        nested into it.
        """
        found = []
        header: list[str] = []
        for line, text in _split(self.text):
            said = tomllib.loads(text)
            if text.lstrip().startswith("["):
                header = list(_only_path(said))
            else:
                for key in reversed(header):
                    said = {key: said}
            found.append((line, said))
        return found


def _split(text: str) -> Iterator[tuple[int, str]]:
    """The statements of a valid TOML text, each with its line; blank ones and comments are none."""
    depth, start, line, begun = 0, 0, 1, 1
    for token in _TOKEN.finditer(text):
        found = token[0]
        if found in "[{":
            depth += 1
        elif found in "]}":
            depth -= 1
        line += found.count("\n")
        if found == "\n" and depth == 0:
            if text[start : token.start()].strip()[:1] not in ("", "#"):
                yield begun, text[start : token.start()]
            start, begun = token.end(), line
    if text[start:].strip()[:1] not in ("", "#"):
        yield begun, text[start:]


def _only_path(tables: Any) -> Iterator[str]:  # noqa: ANN401  # whatever a header holds
    """The keys of a table's header, the outermost first."""
    while tables:
        if isinstance(tables, list):
            tables = tables[0]
            continue
        (key,) = tables
        yield key
        tables = tables[key]


def _holds(tables: object, keys: Sequence[str]) -> bool:
    for key in keys:
        if not isinstance(tables, dict) or key not in tables:
            return False
        tables = tables[key]
    return True


def _wide_integers(value: object, keys: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], int]]:
    """The keys of integers that are no floats, and how many bits they have."""
    if isinstance(value, int) and value.bit_length() > _WIDEST:
        yield keys, value.bit_length()
    elif isinstance(value, dict):
        for key, inner in value.items():
            yield from _wide_integers(inner, (*keys, key))
    elif isinstance(value, list):
        for inner in value:
            yield from _wide_integers(inner, keys)
