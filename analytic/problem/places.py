"""Where rows of a table stand, in words."""

from collections.abc import Callable

Place = Callable[[int], str]
"""Where a row of a table stands, in words: ``"line 17 of rig.csv"``."""


def row_number(row: int) -> str:
    return f"row {row}"
