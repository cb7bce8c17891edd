"""Peers' published cases: what is exact, what our chain makes, and engines that are missing."""

import math

import pytest

from compare.show.page import html
from compare.verify import peers


@pytest.fixture
def missing(monkeypatch):
    """No peer's engine is installed."""

    def absent(name):
        raise ModuleNotFoundError(f"No module named {name!r}", name=name.split(".")[0])

    monkeypatch.setattr(peers, "import_module", absent)


def rows(case):
    return [row for made in peers.CASES if case in made.__name__ for row in made()]


def test_cosseratbench_is_off_by_its_rigid_link(missing):
    mujoco, _ = rows("cantilever")
    assert mujoco.run is None
    assert mujoco.trouble == "cosseratbench is not installed: pip install cosseratbench"
    assert mujoco.exact == pytest.approx(4e-4, rel=0.02)  # its reference is a small deflection's
    assert mujoco.mujoco == pytest.approx(1.0e-3, rel=0.05)
    assert "our chain so has 0.07409" in mujoco.why  # published: 0.0740595


def test_greenhills_twist_is_the_root_of_its_equation(missing):
    free, pulled = rows("twist")
    assert math.tan(free.exact / 2) == pytest.approx(free.exact / 2, rel=1e-7)
    assert pulled.exact == pytest.approx(10.428856439277, rel=1e-8)  # cosseratbench's determinant


def test_the_capstan_holds_what_its_formula_says(missing):
    (row,) = rows("capstan")
    ratio = math.exp(0.3 * math.pi)
    assert row.exact == pytest.approx(ratio * 0.15 + 0.051 * 0.6 / 1.09 * (ratio + 1), rel=1e-12)


@pytest.mark.slow
def test_exudyns_printed_numbers():
    for row in rows("exudyn"):
        if row.run is not None:
            assert row.run == pytest.approx(float(row.published), rel=2e-9)
    assert float(row.published) == pytest.approx(row.exact, rel=3e-9)
    assert row.mujoco == pytest.approx(row.exact, rel=1e-3)


def test_an_engine_that_fails_is_a_line(monkeypatch):
    def broken(name):
        raise ValueError("no\ncable")

    monkeypatch.setattr(peers, "import_module", broken)
    assert rows("capstan")[0].trouble == "cosseratbench failed: no cable"


@pytest.mark.slow
def test_the_page_shows_them(missing):
    found = [row for made in peers.CASES for row in made()]
    table, absent = peers.summary(found)
    assert {row[0].partition(":")[0] for row in table.rows} >= {"cosseratbench", "Newton"}
    assert "cosseratbench is not installed: pip install cosseratbench" in absent.said
    assert "Peers&#39; own cases" in html(peers.page(found))
