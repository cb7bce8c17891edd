"""The command line in this process, for tests of it."""

import contextlib
import io
import sys
from dataclasses import dataclass
from pathlib import Path

import pytest

from compare.commands.main import main


@dataclass
class Done:
    returncode: int
    stdout: str
    stderr: str

    def ended(self, code: int, *said: str) -> "Done":
        """With that exit code, and saying so."""
        assert self.returncode == code, self.stdout + self.stderr
        for part in said:
            assert part in self.stdout
        return self

    def refused(self, *said: str) -> None:
        """It was bad input, in one line that says so."""
        assert self.returncode == 2, self.stdout + self.stderr
        assert self.stderr.count("\n") == 1, self.stderr
        for part in said:
            assert part in self.stderr


def vibrissa(*arguments, cwd) -> Done:
    """The command in this process: a fresh one would take longer to import than to run."""
    out, err = io.StringIO(), io.StringIO()
    words = ["vibrissa", *map(str, arguments)]
    with (
        pytest.MonkeyPatch.context() as patch,
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
    ):
        patch.setattr(sys, "argv", words)
        patch.chdir(cwd)
        with pytest.raises(SystemExit) as ended:
            main()
    return Done(ended.value.code, out.getvalue(), err.getvalue())


def reported_again(run: Done, folder: Path, *gone: str) -> Done:
    """`report` makes what a run wrote again, but for its date and its command."""
    before = {path.name: path.read_bytes() for path in folder.iterdir()}
    for name in gone:
        (folder / name).unlink()
    done = vibrissa("report", folder.name, cwd=folder.parent)
    assert (done.returncode, done.stderr) == (run.returncode, "")
    after = {path.name: path.read_bytes() for path in folder.iterdir()}
    page, other = (set(files.pop("report.html").splitlines()) for files in (before, after))
    allowed = (b">date<", b"command<", b"report out")
    assert all(any(word in line for word in allowed) for line in page ^ other), page ^ other
    assert after == before
    return done
