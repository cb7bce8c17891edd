"""``reconstruct`` of contacts that are known: how well methods find them."""

import pandas as pd
import pytest

from analytic import named_case, solve_sweep
from tests.compare.command import vibrissa


@pytest.mark.slow
def test_a_case_and_a_file_of_its_readings_are_alike(tmp_path):
    solve_sweep(named_case("parabola")).write(tmp_path / "mine.parquet")
    for given in (["parabola"], ["mine.parquet", "--errors"]):
        done = vibrissa(
            "reconstruct", *given, "--method", "kaneko,elastica", "--noise", "0,0.01", cwd=tmp_path
        )
        assert done.returncode == 0, done.stderr
        assert "kaneko" in done.stdout
    tables = [
        pd.read_csv(tmp_path / "results" / name / "methods.csv").drop(columns=["case", "seconds"])
        for name in ("parabola-methods", "mine-methods")
    ]
    pd.testing.assert_frame_equal(*tables)
    assert (tmp_path / "results" / "mine-methods" / "methods.png").exists()


def test_readings_of_other_vibrissae(tmp_path):
    done = vibrissa("reconstruct", "parabola", "--method", "binary,elastica", "--noise", "0",
        "--on", "exact,friction", "--out", "out", cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "contacts" in done.stdout
    table = pd.read_csv(tmp_path / "out" / "methods.csv")
    assert set(table["readings"]) == {"exact", "friction"}
    informed = table[table["method"] == "elastica-informed"]
    assert set(informed["readings"]) == {"friction"}
    assert informed["worst"].max() < 1e-10
    assert (tmp_path / "out" / "methods.png").exists()


@pytest.mark.parametrize(
    "arguments",
    [
        ("parabola", "--method", "elastic"),
        ("parabola", "--noise", "1%"),
        ("parabola", "--noise", "nan"),
        ("parabola", "--noise", "0,0.1,0.2,0.3"),
        ("missing.parquet",),
        ("parabole",),
        ("parabola", "--on", "smooth"),
        ("mine.parquet", "--errors"),
    ],
)
def test_bad_input_is_one_line(arguments, tmp_path):
    done = vibrissa("reconstruct", *arguments, cwd=tmp_path)
    done.refused()
    assert not list(tmp_path.iterdir())
