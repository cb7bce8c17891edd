"""What commands are given, looked at before what works on it is loaded."""

import sys
from collections.abc import Iterable
from pathlib import Path

from analytic.problem.errors import InputError
from analytic.problem.files import regular_file


def require_readings(files: Iterable[Path]) -> None:
    """Refuse files of readings that are not there.

    Parameters
    ----------
    files : iterable of Path
        That are to be read; how large they may be, their reader says.

    Raises
    ------
    InputError
        If one is missing, or no regular file.
    """
    for file in files:
        regular_file(file, "readings file", sys.maxsize)


def require_folder(folder: Path, remedy: str) -> None:
    """Refuse a folder that is not there.

    Parameters
    ----------
    folder : Path
        That is to be read.
    remedy : str
        How to make one.

    Raises
    ------
    InputError
        If it is missing, or no folder.
    """
    if not folder.is_dir():
        raise InputError("DIR", folder, "a folder that is there", remedy)
