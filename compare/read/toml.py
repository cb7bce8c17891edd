"""A TOML file whose errors name the line they are on."""

import re
import tomllib
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, TypeAlias

from analytic.problem.errors import InputError, called
from analytic.problem.files import regular_file

KeyPlace: TypeAlias = Callable[[Sequence[str]], str]
"""What an error calls a key: where it is, and its name."""

_LARGEST = 2_000_000  # bytes: some 50,000 points; what is slower to parse than to compute
_SHOWN = 60  # characters of a key
_LOOKED_AT = 200  # lines that may state a key
_WITH_UNIT = re.compile(r"[-+]?[\d.]\S* \S")
_NO_FLOAT = re.compile(r"\d{309}|0[xob][\da-f_]{256}", re.IGNORECASE)


@dataclass(frozen=True)
class TomlFile:
    path: Path  # where it is
    text: str  # what is in it
    tables: dict[str, Any]  # the same, parsed
    # Of which of several tables of a name `tables` has only this one: their name, and its number.
    one_of: tuple[str, int] | None = None

    @classmethod
    def read(cls, path: Path, what: str) -> "TomlFile":
        regular_file(path, what, _LARGEST)
        try:
            text = path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n")
        except OSError as error:
            reason = error.strerror or type(error).__name__
            raise InputError(what, path, "readable", f"check the path ({reason})") from error
        except UnicodeDecodeError as error:
            raise InputError(what, path, "text in UTF-8", f"save it so ({error.reason})") from error
        if number := _NO_FLOAT.search(text):
            line = text.count("\n", 0, number.start()) + 1
            raise InputError(f"{path}, line {line}", "a number of 309 digits or more",
                             "less than 1e308", "correct it")  # fmt: skip
        try:
            tables = tomllib.loads(text)
            repr(tables)  # what is too deep for that is too deep for all that reads it
        except RecursionError as error:
            raise InputError(what, path, "fewer levels deep", "take brackets away") from error
        except ValueError as error:
            remedy = f"correct it: {error}; a text, or a number with a unit, stands in quotes"
            raise InputError(what, path, "valid TOML", remedy) from error
        return cls(path, text, tables)

    def each(self, name: str) -> "list[TomlFile]":
        """The file once for each table of a name, as if it had no other one of that name."""
        given = self.tables.get(name)
        if not isinstance(given, list) or not given:
            return [self]
        return [
            replace(self, tables={**self.tables, name: one}, one_of=(name, number))
            for number, one in enumerate(given)
        ]

    def table(self, name: str) -> Any:  # noqa: ANN401  # whatever it is
        if name not in self.tables:
            raise InputError(f"{self.path}: [{name}]", "missing", "given", "add the table")
        return self.tables[name]

    def place(self, keys: Sequence[str]) -> str:
        """Where a key is, as ``"grid.toml, line 7: axes.mujoco.segments"``."""
        known = (self._line(keys[:depth]) for depth in range(len(keys), 0, -1))
        line = next((f", line {one}" for one in known if one), "")
        name = ".".join(key if len(key) <= _SHOWN else f"{key[:_SHOWN]}..." for key in keys)
        return f"{self.path}{line}: {name}"

    @contextmanager
    def naming(self) -> Iterator[None]:
        """Errors of what is built from the file name the line of their key."""
        try:
            yield
        except InputError as error:
            table, _, key = error.name.partition("[")[0].partition(".")
            stated = self.tables.get(table)
            if not isinstance(stated, dict):
                raise
            unit = " in SI units" if _WITH_UNIT.match(str(stated.get(key))) else ""
            raise called(error, self.place([table, key] if key else [table]) + unit) from error

    def _line(self, keys: Sequence[str]) -> int | None:
        """The line that states a key: the last one with its name before which there is none."""
        lines = self.text.split("\n")
        name, number = self.one_of or ("", 0)
        in_file: list[str | int] = [keys[0], *([number] if keys[0] == name else []), *keys[1:]]
        named = re.compile(rf"\b{re.escape(keys[-1])}\b[\"']?\s*[.=\]]")
        found = [at for at, line in enumerate(lines) if named.search(line)]
        for at in reversed(found[:_LOOKED_AT] if _holds(self.tables, keys) else []):
            with suppress(ValueError):  # amid a value of several lines
                if not _holds(tomllib.loads("\n".join(lines[:at])), in_file):
                    return at + 1
        return None


def _holds(tables: Any, keys: Sequence[str | int]) -> bool:  # noqa: ANN401  # whatever there is
    for key in keys:
        try:
            tables = tables[key]
        except (KeyError, IndexError, TypeError):
            return False
    return True
