"""Plans and the command line, for tests of studies."""

import subprocess
import sys
from collections.abc import Callable
from functools import partial

import pytest

from compare.commands.main import main
from compare.study.grid.plan import Plan
from tests.compare.study.studies import planned


@pytest.fixture
def plan_of(tmp_path) -> Callable[[str], Plan]:
    return partial(planned, tmp_path)


@pytest.fixture
def command(tmp_path, monkeypatch, capsys) -> Callable[..., subprocess.CompletedProcess]:
    """The command line without a new process; what it starts itself is real."""

    def run(*arguments):
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", ["vibrissa", *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        said = capsys.readouterr()
        return subprocess.CompletedProcess(arguments, ended.value.code, said.out, said.err)

    return run
