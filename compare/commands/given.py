"""What commands are given, looked at before what works on it is loaded."""

import sys
from collections.abc import Iterable
from pathlib import Path

from analytic.problem.files import regular_file

A_RIG = "a file that no engine wrote"


def require_readings(files: Iterable[Path]) -> None:
    """Refuse files of readings that are not there."""
    for file in files:
        regular_file(file, "readings file", sys.maxsize)


def no_rigs(files: Iterable[Path]) -> bool:
    """Whether this project wrote all of these files of readings."""
    from analytic.problem.readings_file import is_ours

    return all(is_ours(file) for file in files)
