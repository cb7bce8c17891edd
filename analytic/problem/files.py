"""Files that appear whole or not at all."""

import os
import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Write to the yielded path; it becomes `path` when the block ends without an error.

    Whatever happens nothing unfinished stays behind, unless the process is killed. The name is
    unique, so that two processes may write the same file at the same time: the last one wins.

    Parameters
    ----------
    path : Path
        The file that is to appear; one that is there is replaced.

    Raises
    ------
    OSError
        If the file cannot be written; `path` is then as it was.
    """
    unfinished = path.with_name(f".{path.name}.{os.getpid()}-{uuid.uuid4().hex[:8]}.partial")
    try:
        yield unfinished
        unfinished.replace(path)
    finally:
        unfinished.unlink(missing_ok=True)


def write_whole(path: Path, content: str | bytes) -> Path:
    """Write a text (as UTF-8) or bytes to `path`, whole or not at all.

    Parameters
    ----------
    path : Path
        The file.
    content : str or bytes
        All of it.

    Returns
    -------
    Path
        `path`.
    """
    with whole_file(path) as unfinished:
        unfinished.write_bytes(content.encode() if isinstance(content, str) else content)
    return path
