"""What is printed in a terminal of 80 columns, the width that a pipe has, and what is wider."""

from pathlib import Path

import pytest

from analytic import named_case, solve_sweep
from compare.commands import terminal
from compare.explain.parts import Part, Parted
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


def test_six_components_are_all_printed_and_the_one_that_does_not_close_is_said(
    monkeypatch, capsys
):
    """A table that no narrow terminal holds is folded by it, and loses no column."""
    monkeypatch.setenv("COLUMNS", "80")
    names = [f"{what}_{axis}" for what in ("force", "moment") for axis in "xyz"]
    sure, unsure = Part(1.5e-4, 1e-5), Part(7e-4, 8e-4)
    parts = {
        "discretisation": {name: Part(i * 1.1e-3, i * 1e-4) for i, name in enumerate(names, 1)},
        "unexplained": dict.fromkeys(names, unsure) | {"moment_x": sure},
    }
    whole = {name: i * 1.2e-3 for i, name in enumerate(names, 1)}
    found = Parted(parts, whole, 2.0, closes=False, blame="discretisation", stations=9)
    assert found.left == sure
    terminal.show(*budget_summary(found))
    said = capsys.readouterr().out
    for i, name in enumerate(names, 1):
        assert name in said
        assert f"{i * 1.1e-3:.1e}".replace("e-0", "e-") in said
