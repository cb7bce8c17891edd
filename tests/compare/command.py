"""The command line in this process, for tests of it."""

import contextlib
import io
import sys
from dataclasses import dataclass

import pytest

from compare.commands.main import main


@dataclass
class Done:
    returncode: int
    stdout: str
    stderr: str

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
