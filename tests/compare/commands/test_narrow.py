"""What is printed in a terminal of 80 columns, the width that a pipe has."""

from pathlib import Path

import pytest

from tests.compare.command import vibrissa

RIG = Path(__file__).parents[3] / "docs" / "examples" / "rig"
COMMANDS = [
    ("methods", "parabola", "--method", "quist-hartmann-half-cell,elastica"),
    ("rig", RIG / "data", "--rig", RIG / "rig.toml", "--out", "passes"),
    ("run", "parabola", "--stations", "20", "--segments", "10", "--budget"),
]


@pytest.mark.usefixtures("undrawn", "in_turn")
@pytest.mark.parametrize("words", COMMANDS, ids=lambda words: words[0])
def test_no_number_is_cut(words, tmp_path, monkeypatch):
    monkeypatch.setenv("COLUMNS", "80")
    done = vibrissa(*words, cwd=tmp_path)
    assert done.returncode in (0, 1), done.stderr
    assert "…" not in done.stdout
    assert max(len(line) for line in done.stdout.splitlines() if line[:1] in "┃│") <= 80
