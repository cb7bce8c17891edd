"""What pictures are made with: curves between stations, thinned sweeps, names of any kind."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.cbook import is_math_text

from analytic import CLAMP_READINGS, Readings, named_case, solve_sweep
from compare import compare
from compare.sense.phases import classify
from compare.show.figures.over_foot import foot, with_fold
from compare.show.figures.readings import phase_criterion
from compare.show.report import write_report
from compare.show.style import label
from tests.compare.show import sweeps
from tests.conftest import exact_sweep


@pytest.mark.parametrize("name", ["catenary", "two-circles", "tip-only"])
def test_curve_between_the_last_stations(name):
    sweep, case = exact_sweep(name), named_case(name)
    phase, x = classify(sweep).phase, foot(sweep)
    dense = solve_sweep(
        replace(case, sweep=replace(case.sweep, stop=sweep.snap_off + 1e-6, stations=3000))
    )
    near = (foot(dense) > sweep.snap_off) & (foot(dense) < sweep.snap_off + 3 * (x[0] - x[1]))
    there = foot(dense)[near]
    for reading in CLAMP_READINGS:
        y = sweep.values(reading)
        curve_x, curve_y = with_fold(sweep, phase, x, y)
        drawn = np.isfinite(curve_y)
        expected, largest = dense.values(reading)[near], np.abs(y).max()
        curve = np.interp(there, curve_x[drawn][::-1], curve_y[drawn][::-1])
        straight = np.interp(there, x[::-1], y[::-1])
        # A hundredth of the picture's height is about the width of the line.
        assert np.abs(curve - expected).max() < 1e-2 * largest
        assert np.abs(straight - expected).max() > 1e-2 * largest
        at = np.searchsorted(-curve_x[drawn], -x[x > sweep.snap_off])
        np.testing.assert_allclose(
            curve_y[drawn][at], y[x > sweep.snap_off], atol=1e-9 * largest
        )  # through the stations


def test_no_curve_where_the_stations_do_not_determine_it():
    sweep = sweeps.exact("shallow-catenary")
    phase, x, y = classify(sweep).phase, foot(sweep), sweep.values("force_x")
    curve_x, curve_y = with_fold(sweep, phase, x, y)
    last = curve_x[np.isfinite(curve_y) & (curve_x > sweep.snap_off)].min()
    assert last == pytest.approx(x[x > sweep.snap_off].min())
    assert with_fold(replace(sweep, provenance={}), phase, x, y) == (x, y)


def test_a_mirrored_sweep_has_the_mirrored_curve():
    sweep = exact_sweep("parabola")
    (x, y), (other_x, other_y) = (
        with_fold(one, classify(sweep).phase, foot(one), one.values("force_y"))
        for one in (sweep, sweep.mirrored())
    )
    np.testing.assert_allclose(other_x, -x, atol=1e-12)
    np.testing.assert_allclose(other_y, y, atol=1e-9)


def test_all_text_is_on_the_picture(comparison):
    judged = {
        side: replace(one, criterion=4e-3 * np.sin(np.arange(len(one.criterion))))
        for side, one in comparison.judged.items()
    }
    figure = phase_criterion(replace(comparison, judged=judged))
    FigureCanvasAgg(figure)
    box = figure.get_tightbbox()
    assert 0 <= box.x0 < box.x1 <= figure.bbox_inches.x1
    assert 0 <= box.y0 < box.y1 <= figure.bbox_inches.y1


@settings(max_examples=30)
@given(st.text())
def test_any_name_can_be_drawn(text):
    drawn = label(text)
    assert not is_math_text(drawn)
    assert not drawn.startswith("_")
    assert len(drawn.replace(r"\$", "$")) <= 61
    assert all(c.isprintable() for c in drawn)


@pytest.mark.slow
def test_twenty_thousand_rows_make_a_small_page(tmp_path):
    exact = exact_sweep("catenary")
    x = np.linspace(*foot(exact)[[0, -1]], 20_000)
    rng = np.random.default_rng(1)
    columns = {"foot_x": x}
    for name in CLAMP_READINGS:
        values = exact.values(name)
        noise = 0.01 * np.abs(values).max() * rng.standard_normal(len(x))
        columns[name] = np.interp(-x, -foot(exact), values) + noise
    rig = Readings(pd.DataFrame(columns), exact.beam)
    for found in (compare(exact, rig, noise=0.01), compare(rig, exact, noise=0.01)):
        assert write_report(found, tmp_path).stat().st_size < 3e6
