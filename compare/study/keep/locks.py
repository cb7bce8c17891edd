"""Locks between processes, which the system frees when their holder dies."""

import os
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from analytic import InputError

if sys.platform != "win32":
    import fcntl

_PATIENCE = 300.0  # s; tidying up a million rows takes a tenth of that


@contextmanager
def lock(folder: Path) -> Iterator[None]:
    """Keep other processes from changing the set of files in a folder."""
    check_platform()
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        end = time.monotonic() + _PATIENCE
        while not _taken(descriptor):
            if time.monotonic() > end:
                raise InputError(
                    "DIR", folder, "free", "another process keeps it locked: end that and try again"
                )
            time.sleep(0.02)
        yield
    finally:
        os.close(descriptor)


def claim(file: BinaryIO) -> bool:
    """Lock an open file for as long as it stays open, unless another process has done so."""
    return _taken(file.fileno())


def check_platform() -> None:
    """Refuse to store a study where files cannot be locked."""
    if sys.platform == "win32":
        raise InputError(
            "study", "on Windows", "on Linux or macOS, which lock files by flock",
            "start it in the Windows Subsystem for Linux",
        )  # fmt: skip


def _taken(descriptor: int) -> bool:
    if sys.platform == "win32":
        return False
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True
