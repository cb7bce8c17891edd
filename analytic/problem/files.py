"""Files: read only if they are files of a reasonable size, written whole or not at all."""

import os
import re
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

from analytic.problem.errors import InputError, kind_of

SOFTWARE = "vibrissa testbed"  # what pictures, films and clouds of points say that they are of
_MARK = b"vibrissa"  # in what is written, but for tables, which begin with a word of their own
_AFTER_A_WORD = re.compile(rb'[":,\n]')
_NAMED_BY_A_WORD = (".csv", ".json")
_guarded: ContextVar[bool] = ContextVar("guarded", default=False)


def as_path(path: object, name: str) -> Path:
    if not isinstance(path, str | os.PathLike):
        raise InputError(name, kind_of(path), "a path", "as 'folder/name'")
    return Path(path)


def regular_file(path: str | Path, name: str, largest: int) -> Path:
    """A path that can be read without surprises: no pipe, no device, not too large."""
    path = as_path(path, name)
    try:
        size = path.stat().st_size
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        remedy = f"check the path ({reason})"
        raise InputError(name, path, "a file that is there", remedy) from error
    if not path.is_file():
        raise InputError(name, path, "a regular file", "a folder, pipe or device cannot be read")
    if size > largest:
        what, allowed = f"of {size / 1e6:.0f} MB", f"at most {largest / 1e6:.0f} MB"
        raise InputError(f"{name} {path}", what, allowed, "split it or drop what is not needed")
    return path


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Write to the yielded path; it becomes `path` when the block ends without an error.

    Among `own_files` it replaces no file of somebody else's.
    """
    unfinished = path.with_name(f".{path.name}.{os.getpid()}-{uuid.uuid4().hex[:8]}.partial")
    try:
        yield unfinished
        if _guarded.get() and path.is_file() and _foreign(path, unfinished):
            remedy = "move it, or name another"
            raise InputError("output", path, "free, or from an earlier run", remedy)
        unfinished.replace(path)
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error
    finally:
        unfinished.unlink(missing_ok=True)


@contextmanager
def own_files() -> Iterator[None]:
    """Let files that nobody named replace their like alone."""
    before = _guarded.set(True)
    try:
        yield
    finally:
        _guarded.reset(before)


def remove_own(path: Path) -> None:
    """Remove what an earlier run wrote; what is somebody else's stays."""
    if path.is_file() and _MARK in path.read_bytes():
        path.unlink()


def _foreign(path: Path, unfinished: Path) -> bool:
    """Whether a file is not of the kind that is to replace it."""
    old, new = path.read_bytes(), unfinished.read_bytes()
    if path.suffix in _NAMED_BY_A_WORD:
        was, now = (_AFTER_A_WORD.split(x.lstrip(b'{ \n"'), 1)[0] for x in (old, new))
        return was != now
    return _MARK in new and _MARK not in old


def write_whole(path: Path, content: str | bytes) -> Path:
    """Write a text (as UTF-8) or bytes to `path`, whole or not at all."""
    with whole_file(path) as unfinished:
        unfinished.write_bytes(content.encode() if isinstance(content, str) else content)
    return path
