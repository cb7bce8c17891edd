"""Readings as users give them, as files keep them, and what values show of themselves."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given, seed, settings
from hypothesis import strategies as st
from matplotlib.figure import Figure

from analytic import (
    CLAMP_READINGS,
    Beam,
    Case,
    InputError,
    Readings,
    calibrate,
    circle,
    find_events,
    named_case,
    solve_sweep,
)
from analytic.space import FootPath, SpatialCase, solve_space, sphere
from compare import compare
from tests.analytic.problem.given import refusal

RIG = "foot_x,force_x,force_y,moment_z\n"
FOUR = {
    "foot_x": [1.0, 0.9, 0.8],
    "force_x": [0.0, -0.1, -0.2],
    "force_y": [0.0, 0.2, 0.3],
    "moment_z": [0.0, 0.3, 0.4],
}


@pytest.mark.parametrize("suffix", ["parquet", "csv"])
def test_round_trip(tmp_path, suffix):
    sweep = solve_sweep(named_case("catenary"))
    back = Readings.read(sweep.write(tmp_path / f"sweep.{suffix}"))
    pd.testing.assert_frame_equal(back.table, sweep.table, check_exact=True)
    assert back.beam == sweep.beam
    assert back.source == sweep.source
    assert back.provenance == sweep.provenance
    assert [path.name for path in tmp_path.iterdir()] == [f"sweep.{suffix}"]


def test_who_changes_a_table_changes_their_own():
    """A fault planted in a sweep's table was in the sweep, too, which agreed with it to 0.0."""
    sweep = solve_sweep(named_case("parabola"))
    before, table = sweep.values("force_x").copy(), sweep.table
    table["force_x"] *= 2.0
    assert (sweep.values("force_x") == before).all()
    mine = Readings(table, sweep.beam)
    table["force_x"] = 0.0
    assert (mine.values("force_x") == 2.0 * before).all()


def test_measured_data_need_four_columns_only(tmp_path):
    """A cell may be missing; a row without a foot position is dropped and counted."""
    path = tmp_path / "rig.csv"
    path.write_text(RIG + "1,0,0,0\n,-0.1,0.2,0.3\n0.9,-0.1,0.2,0.3\n0.8,,0.3,0.4\n")
    rig = Readings.read(path)
    assert rig.beam == Beam()
    assert rig.values("foot_x").tolist() == [1.0, 0.9, 0.8]
    assert rig.trusted.tolist() == [True, True, False] and rig.gaps == 1
    assert pd.isna(rig.values("contact_x")).all()
    assert "did you mean force_y" in refusal(rig.values, "force_z")
    assert rig.provenance["rows_without_foot_x"] == 1
    assert "1 row without foot_x dropped" in repr(rig)
    assert "each with a finite foot_x" in refusal(Readings, Readings.read_table(path))


@pytest.mark.parametrize(
    ("cell", "said"),
    [("ERR", "'ERR'"), ('"0,5"', "'0,5'"), ("1_000", "'1_000'"), ("inf", "inf"), ("0 N", "'0 N'")],
)
def test_a_cell_that_is_no_number_is_named_by_line_and_column(tmp_path, cell, said):
    path = tmp_path / "rig.csv"
    path.write_text(f"# made by hand\n{RIG}1,0,0,0\n\n0.9,-0.1,{cell},0.3\n0.8,-0.2,0.3,0.4\n")
    message = refusal(Readings.read, path)
    assert f"column force_y, line 5 of {path}, = {said}" in message


@pytest.mark.parametrize(
    "column",
    [
        pd.Series([True, False, True]),
        pd.Series([1.0, 2.0, 3.0]).astype("category"),
        pd.Series([0.0, np.inf, 0.0]),
        pd.Series([1j, 2j, 3j]),
        pd.to_datetime(pd.Series([1, 2, 3])),
        pd.Series([True, 1.0, 2.0], dtype=object),
        pd.Series([[1], {}, 10**400], dtype=object),
    ],
)
def test_what_is_no_reading(column):
    assert "column force_y" in refusal(Readings.of, {**FOUR, "force_y": column})


@pytest.mark.parametrize(
    "column",
    [
        [0, 1, 2],
        np.float32([0, 0.5, 1]),
        pd.array([0, None, 2], dtype="Int64"),
        ["0", "0.5", "1e0"],
        [None, 0.5, 1],
        pd.Series([0.0, None, 1.0], dtype=pd.ArrowDtype(pa.float64())),
    ],
)
def test_whatever_holds_numbers_is_a_reading(column):
    sweep = Readings.of({**FOUR, "moment_z": column})
    assert sweep.table["moment_z"].dtype == float


@pytest.mark.parametrize(
    "text",
    [
        b"[1]",
        b"\xff",
        b"[" * 100_000,
        b'{"provenance": {"events": 3}}',
        b'{"beam": [1]}',
        b'{"beam": {"size": 1}}',
        b'{"source": 7}',
    ],
)
def test_damaged_metadata(tmp_path, text):
    path = tmp_path / "sweep.parquet"
    pq.write_table(pa.table(FOUR).replace_schema_metadata({b"vibrissa": text}), path)
    assert "sweep.parquet" in refusal(Readings.read, path)


def test_what_is_no_file_is_not_opened(tmp_path):
    pipe = tmp_path / "pipe.csv"
    os.mkfifo(pipe)
    endless = tmp_path / "endless.csv"
    endless.symlink_to("/dev/zero")
    large = tmp_path / "large.csv"
    with large.open("wb") as file:
        file.truncate(10**12)  # sparse
    folder = tmp_path / "folder.csv"
    folder.mkdir()
    for path in (pipe, endless, folder):
        assert "regular file" in refusal(Readings.read, path)
    assert "at most" in refusal(Readings.read, large)


@pytest.mark.slow
def test_a_small_file_of_too_many_cells(tmp_path):
    path = tmp_path / "same.parquet"
    columns = [pa.repeat(1.0, 1_000_000)] * 101
    pq.write_table(pa.table(columns, names=[f"c{i}" for i in range(101)]), path)
    assert path.stat().st_size < 10_000_000
    assert "cells" in refusal(Readings.read, path)


CELLS = st.one_of(st.floats(), st.integers(), st.booleans(), st.none(), st.text(max_size=5))
COLUMNS = st.sampled_from([*FOUR, "phase", "status", "tip_angle"])


@seed(3)
@settings(max_examples=50, deadline=None)
@given(st.dictionaries(COLUMNS, st.lists(CELLS, max_size=4)))
def test_any_columns_are_readings_or_one_line(columns):
    try:
        sweep = Readings.of({**FOUR, **columns})
    except InputError as error:
        assert "\n" not in str(error)
    else:
        assert not np.isinf(sweep.table.select_dtypes(float)).any().any()


def test_shown_on_one_screen():
    text = repr(solve_sweep(named_case("catenary")))
    assert len(text) < 500 and len(text.splitlines()) <= 6
    assert "200 stations" in text and "free" in text
    page = Readings.of(FOUR, source="rig <b>$$")._repr_html_()
    assert "<table" in page and "&lt;b&gt;" in page


def test_plot_draws_the_three_readings():
    sweep = Readings.of({**FOUR, "moment_z": [0, np.nan, 0.4]}, source="rig <b>$$")
    axes = sweep.plot(Figure().subplots(3))
    np.testing.assert_array_equal(axes[0].lines[0].get_ydata(), FOUR["force_x"])
    axes[0].figure.canvas.draw()


def test_a_failed_write_leaves_what_was_there(tmp_path, monkeypatch):
    sweep = solve_sweep(named_case("parabola"))
    path = sweep.write(tmp_path / "sweep.parquet")
    before = path.read_bytes()

    def full(*args, **kwargs):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pyarrow.parquet.write_table", full)
    with pytest.raises(OSError, match="No space left"):
        sweep.write(path)
    assert path.read_bytes() == before
    assert len(list(tmp_path.iterdir())) == 1


def test_threads_that_ask_at_once_get_the_same_numbers():
    """What is made when first asked for is made by whoever comes first."""
    for _ in range(20):
        readings, together = solve_sweep(named_case("catenary")), Barrier(4)

        def ask(_, readings=readings, together=together):
            together.wait()
            return readings.table, readings.provenance

        with ThreadPoolExecutor(4) as threads:
            found = list(threads.map(ask, range(4)))
        made = readings.values("force_x")  # a view
        for table, provenance in found:
            assert provenance is readings.provenance
            assert np.shares_memory(table["force_x"].to_numpy(), made)


def shown() -> list[object]:
    case = named_case("catenary")
    path = FootPath([[1, 0.2], [-1, 0.2]], stations=12)
    in_space = SpatialCase(body=sphere(1.0, centre=(0, 1.4, 0)), path=path)
    swept, spatial = solve_sweep(case), solve_space(in_space)
    fitted = calibrate(swept, case, ["flexural_rigidity", "friction"], {"force_x": 1e-2})
    found = [case, named_case("whisk-catenary"), in_space, swept, spatial]
    found += [find_events(case.profile, case.beam), fitted]
    return [*found, compare(swept, swept), compare(spatial, spatial)]


@pytest.mark.slow  # nine pictures
def test_a_line_or_a_screen_and_tiles_with_a_picture():
    for value in shown():
        assert len(repr(value)) < 1000, repr(value)
        assert "object at" not in repr(value)
        assert "functools" not in repr(value)
        page = value._repr_html_()
        assert page.startswith("<div")
        assert "data:image/png;base64," in page
        assert len(page) < 150_000


def test_a_case_shows_all_its_objects():
    both = Case(profile=[circle(0.2, (0.3, 0.5)), circle(0.1, (-0.5, 0.6))])
    assert "circle of radius 0.2" in repr(both) and "circle of radius 0.1" in repr(both)


def test_what_is_drawn_is_in_the_units_of_the_case():
    outline, way, *_ = named_case("catenary").plot(Figure().subplots()).lines
    assert outline.get_ydata().min() == pytest.approx(0.2)
    np.testing.assert_allclose(way.get_ydata(), 0.0)
    whisk = solve_sweep(named_case("whisk-catenary"))
    line = whisk.plot(Figure().subplots(3))[0].lines[0]
    np.testing.assert_array_equal(line.get_xdata(), whisk.clamp_angle)


def test_events_lie_on_the_readings():
    case = named_case("parabola")
    axes = Figure().subplots(3)
    solve_sweep(case).plot(axes)
    find_events(case.profile, case.beam).plot(axes)
    curve, *events, _ = axes[1].lines  # next to the snap-off, the last, the force has no bound
    for event in events:
        at, value = event.get_xdata()[0], event.get_ydata()[0]
        near = np.argmin(np.abs(curve.get_xdata() - at))
        beside = curve.get_ydata()[[max(near - 1, 0), near, min(near + 1, 199)]]
        assert abs(beside - value).min() < 0.02 * curve.get_ydata().max()


def test_who_only_solves_loads_no_pictures():
    code = (
        "import sys; from analytic import named_case, solve_sweep; "
        "repr(solve_sweep(named_case('parabola'))); "
        "print([name for name in ('matplotlib', 'mujoco') if name in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


@pytest.mark.parametrize(
    ("wrong", "near"),
    [
        (lambda: named_case("catenery"), "did you mean catenary?"),
        (
            lambda: Readings.of({name: [1, 0] for name in ("footx", *CLAMP_READINGS)}),
            "add foot_x (is it footx?)",
        ),
        (lambda: named_case("q"), "`compare.load_case` reads a TOML file"),
    ],
)
def test_errors_suggest_the_nearest_name(wrong, near):
    assert near in refusal(wrong)
