"""Numbers with their unit, where the case has units."""

from dataclasses import replace

import pytest

from analytic import SENSED, Beam, Case, Readings, circle, solve_sweep
from compare import compare
from compare.commands import terminal
from compare.show.figures.over_foot import foot_label, reading_label
from compare.show.numbers import quantity, uncertain
from compare.show.report import summary_of
from tests.compare.show.pages import written_page
from tests.conftest import exact_sweep

SI = Beam(0.05, 2e-6, 0.25e-3, si=True)


@pytest.mark.parametrize(
    ("value", "kind", "text"),
    [
        (0.05, "length", "50 mm"),
        (-2.012e-3, "length", "-2.012 mm"),
        (1.5, "length", "1.5 m"),
        (8e-4, "force", "0.8 mN"),
        (4e-5, "moment", "40 µN m"),
        (1e-12, "length", "1e-12 m"),
        (0.0, "length", "0 m"),
    ],
)
def test_the_prefix_that_keeps_a_number_readable(value, kind, text):
    assert quantity(value, kind, SI) == text
    assert quantity(value, kind, Beam()) == f"{value:.4g}"


@pytest.mark.parametrize(
    ("value", "half", "text", "plain"),
    [
        (0.5163e-3, 6.342e-6, "0.5163 ± 0.0063 mm", "0.0005163 ± 6.3e-6"),
        (-5e-4, 6.953e-10, "-0.5 ± 7.0e-7 mm", "-0.0005 ± 7.0e-10"),
        (2e-6, 0.0214, "0 ± 21 mm", "0.000 ± 0.021"),
        (0.01, 0.0, "10 mm", "0.01"),
        (0.0, 0.0, "0 m", "0"),
    ],
)
def test_a_number_and_its_uncertainty_have_one_unit(value, half, text, plain):
    assert uncertain(value, half, "length", SI) == text
    assert uncertain(value, half, "length", Beam()) == plain


@pytest.fixture(scope="module")
def exact() -> Readings:
    return solve_sweep(Case(SI, circle(0.04, lowest=(0.0, 0.02))))


def measured(exact: Readings) -> Readings:
    """The same stations 2 mm off, without phases."""
    table = exact.table[list(SENSED)]
    return replace(exact, table=table.assign(foot_x=table["foot_x"] + 2e-3), source="rig")


def test_a_case_with_units_names_them(exact, capsys, tmp_path):
    found = compare(exact, measured(exact), offset=2e-3)
    page = written_page(found)
    assert "L = 50 mm, forces in EI/L² = 0.8 mN" in page
    assert "<dd>2 mm<small>" in page
    assert "the candidate&#39;s true ones are not known" in page
    assert reading_label(exact, "moment_z").endswith("= 40 µN m)")
    assert "50 mm" in foot_label(exact)
    units = {"force_x": "N", "force_y": "N", "moment_z": "N m"}
    assert [ax.get_ylabel() for ax in exact.plot()] == [f"{n} [{u}]" for n, u in units.items()]
    terminal.show(*summary_of(found))
    assert "2 mm" in capsys.readouterr().out
    exact.write(tmp_path / "a.parquet")
    assert Readings.read(tmp_path / "a.parquet").beam.si


def test_a_case_without_units_names_none():
    exact = exact_sweep("parabola")
    assert "of the readings&#39; own units" in written_page(compare(exact, exact))
    assert foot_label(exact) == "foot_x / $L$"
    assert exact.plot()[0].get_ylabel() == "force_x"
