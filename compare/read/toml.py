"""A TOML file whose errors can be told with the line they are on."""

import tomllib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeAlias

from analytic import InputError

Place: TypeAlias = Callable[[Sequence[str]], str]
"""What an error calls a key: where it is, and its name."""


@dataclass(frozen=True)
class TomlFile:
    """A TOML file, read and parsed.

    Attributes
    ----------
    path : Path
        Where it is.
    text : str
        What is in it.
    tables : dict
        The same, parsed.
    """

    path: Path
    text: str
    tables: dict[str, Any]

    @classmethod
    def read(cls, path: Path, what: str) -> "TomlFile":
        """Read `path`; errors call it `what`, as ``"case file"``.

        Raises
        ------
        InputError
            If it cannot be read or is not TOML; the parser's words name line and column.
        """
        try:
            text = path.read_text(encoding="utf-8")
            return cls(path, text, tomllib.loads(text))
        except (OSError, UnicodeDecodeError) as error:
            raise InputError(
                what, path, "readable", f"check the path ({type(error).__name__})"
            ) from error
        except tomllib.TOMLDecodeError as error:
            raise InputError(what, path, "valid TOML", f"mend it: {error}") from error

    def place(self, keys: Sequence[str]) -> str:
        """Where a key is, as ``"grid.toml, line 7: axes.mujoco.segments"``.

        The line is that of the key itself, or of the innermost table round it that there is.
        """
        line = next(
            (
                line
                for depth in range(len(keys), 0, -1)
                for line, tables in self._growing
                if _holds(tables, keys[:depth])
            ),
            None,
        )
        return f"{self.path}{'' if line is None else f', line {line}'}: {'.'.join(keys)}"

    @cached_property
    def _growing(self) -> list[tuple[int, dict[str, Any]]]:
        """What the file says up to the end of each of its statements, and the statement's line.

        A file cut off between two statements is valid TOML, so the parser itself finds them.
        """
        lines = self.text.splitlines(keepends=True)
        found, start = [], 0
        for end in range(1, len(lines) + 1):
            if start == end - 1 and lines[start].strip()[:1] in ("", "#"):
                start = end
                continue
            try:
                tables = tomllib.loads("".join(lines[:end]))
            except tomllib.TOMLDecodeError:
                continue
            found.append((start + 1, tables))
            start = end
        return found


def _holds(tables: object, keys: Sequence[str]) -> bool:
    for key in keys:
        if not isinstance(tables, dict) or key not in tables:
            return False
        tables = tables[key]
    return True
