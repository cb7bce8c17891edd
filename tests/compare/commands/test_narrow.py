"""What is printed in a terminal of 80 columns, the width that a pipe has."""

from pathlib import Path

import pytest

from analytic import named_case, solve_sweep
from compare.commands import terminal
from compare.read.passes import look_at_passes, usable
from compare.read.rig_file import read_rig
from compare.show.budgets import budget_summary
from compare.show.passes import passes_summary
from docs.figures.methods import method_errors, print_methods
from tests.compare.planted import planted

RIG = Path(__file__).parents[3] / "docs" / "examples" / "rig"


def methods():
    sweep = solve_sweep(named_case("parabola"))
    found = method_errors(sweep, ("quist-hartmann-half-cell", "elastica"), (0.0, 1e-3, 1e-2))
    print_methods(found, "parabola (exact)")


def passes():
    terminal.show(
        *passes_summary(usable(look_at_passes([RIG / "data"], read_rig(RIG / "rig.toml"))), [])
    )


def budget():
    terminal.show(*budget_summary(planted()))


@pytest.mark.parametrize("prints", [methods, passes, budget])
def test_no_number_is_cut(prints, monkeypatch, capsys):
    monkeypatch.setenv("COLUMNS", "80")
    prints()
    tables = [line for line in capsys.readouterr().out.splitlines() if line.startswith(" ")]
    assert len(tables) > 3
    assert "…" not in "".join(tables)
    assert max(map(len, tables)) <= 80
