"""Foot positions that count backwards are distinguished from rows that are reversed."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Readings
from compare import compare
from compare.align.order import in_order
from compare.sense.noise import with_noise
from tests.compare.synthetic import changed
from tests.conftest import exact_sweep


def counted_from(sweep: Readings, origin: float) -> Readings:
    return changed(sweep, foot_x=origin - sweep.values("foot_x"))


@pytest.mark.parametrize(
    ("case_name", "origin"), [("catenary", 0.7), ("two-circles", 0.0), ("tip-only", 0.7)]
)
def test_a_stage_that_counts_backwards(case_name, origin):
    """It is named, and what it would agree with is compared."""
    exact = exact_sweep(case_name)
    noisy = with_noise(exact, dict.fromkeys(CLAMP_READINGS, 1e-3), 4)
    found = compare(exact, counted_from(noisy, origin), noise=1e-3)
    assert found.order.backwards_from == pytest.approx(origin, abs=1e-3)
    assert found.failures[0].startswith("order: foot_x counts the other way")
    assert "foot_x counts the other way" in found.likely
    assert found.disagreement["force_y"].rms < 2e-2


def test_reversed_rows_are_reversed(case_name):
    """Beside an unknown origin and unit of the forces, too."""
    exact = exact_sweep(case_name)
    table = exact.table.iloc[::-1].reset_index(drop=True)
    for moved, unit in ((0.0, 1.0), (0.05, 1.0), (0.0, 1000.0)):
        columns = {name: unit * table[name] for name in CLAMP_READINGS}
        rows = replace(exact, table=table.assign(foot_x=table["foot_x"] + moved, **columns))
        assert in_order(exact, rows)[2].reversed


def test_what_neither_or_both_explain_is_taken_for_reversed_rows():
    """Readings at random, and such that rise and fall alike on either side of x = 0."""
    exact = exact_sweep("parabola")
    values = np.abs(np.random.default_rng(1).normal(size=(3, 200)))
    readings = values * np.sign(exact.values("moment_z").sum())
    columns = dict(zip(CLAMP_READINGS, readings, strict=True))
    strange = changed(exact, foot_x=-exact.values("foot_x"), **columns)
    assert in_order(exact, strange)[2].reversed
    x = np.linspace(1.0, -1.0, 101)
    hump = dict.fromkeys(CLAMP_READINGS, np.exp(-20 * x**2))
    even = Readings.of({"foot_x": x, **hump}, exact.beam)
    noisy = with_noise(even, dict.fromkeys(CLAMP_READINGS, 1e-3), 3)
    assert in_order(even, changed(noisy, slice(None, None, -1)))[2].reversed


def test_what_each_kind_of_disorder_is_put_right_to():
    """Whatever the rows went through, the sweep that comes out is the one that went in."""
    exact = exact_sweep("parabola")
    table = exact.table
    shuffled = table.iloc[np.random.default_rng(2).permutation(len(table))]
    for rows, kind in (
        (table, "none"),
        (table.iloc[::-1], "reversed"),
        (table.assign(foot_x=0.3 - table["foot_x"]), "backwards_from"),
        (shuffled, "sorted"),
    ):
        candidate, record, order = in_order(exact, replace(exact, table=rows))
        for name in ("foot_x", *CLAMP_READINGS):
            np.testing.assert_allclose(candidate.values(name), exact.values(name), atol=1e-6)
        seen = {"reversed": order.reversed, "sorted": order.sorted,
                "backwards_from": order.backwards_from is not None}  # fmt: skip
        assert [name for name, is_so in seen.items() if is_so] == [kind] * (kind != "none")
        assert not order.opposite
        assert (record.retreats > 0) == (kind == "sorted")
        if said := {"reversed": "rows reversed", "sorted": "out of order"}.get(kind):
            found = compare(exact, replace(exact, table=rows.reset_index(drop=True)))
            assert [line.split(":")[0] for line in found.failures] == ["order"]
            assert said in found.failures[0] and said in found.likely
            assert found.disagreement["force_x"].rms == found.snap_off.difference == 0
