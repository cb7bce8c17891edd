"""Readings survive the file they are written to."""

import pandas as pd
import pytest

from analytic import Beam, Readings, named_case, solve_sweep


@pytest.mark.parametrize("suffix", ["parquet", "csv"])
def test_round_trip(tmp_path, suffix):
    sweep = solve_sweep(named_case("catenary"))
    back = Readings.read(sweep.write(tmp_path / f"sweep.{suffix}"))
    pd.testing.assert_frame_equal(back.table, sweep.table, check_exact=True)
    assert back.beam == sweep.beam
    assert back.source == sweep.source
    assert back.provenance == sweep.provenance
    assert [path.name for path in tmp_path.iterdir()] == [f"sweep.{suffix}"]


def test_measured_data_need_four_columns_only(tmp_path):
    path = tmp_path / "rig.csv"
    path.write_text("foot_x,force_x,force_y,moment_z\n1,0,0,0\n0.9,-0.1,0.2,0.3\n0.8,,0.3,0.4\n")
    rig = Readings.read(path)
    assert rig.beam == Beam()
    assert rig.trusted.tolist() == [True, True, False]
    assert pd.isna(rig.values("contact_x")).all()


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
