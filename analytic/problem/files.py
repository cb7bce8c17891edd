"""Files: read only if they are files of a reasonable size, written whole or not at all."""

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from analytic.problem.errors import InputError


def as_path(path: object, name: str) -> Path:
    if not isinstance(path, str | os.PathLike):
        raise InputError(name, f"a {type(path).__name__}", "a path", "as 'folder/name'")
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
    """Write to the yielded path; it becomes `path` when the block ends without an error."""
    unfinished = path.with_name(f".{path.name}.{os.getpid()}-{uuid.uuid4().hex[:8]}.partial")
    try:
        yield unfinished
        unfinished.replace(path)
    except OSError as error:
        raise OSError(error.errno, error.strerror or str(error), str(path)) from error
    finally:
        unfinished.unlink(missing_ok=True)


def write_whole(path: Path, content: str | bytes) -> Path:
    """Write a text (as UTF-8) or bytes to `path`, whole or not at all."""
    with whole_file(path) as unfinished:
        unfinished.write_bytes(content.encode() if isinstance(content, str) else content)
    return path
