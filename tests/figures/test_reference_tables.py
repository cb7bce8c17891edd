"""The reference tables: the same each time, and checkers that name what is planted."""

import importlib.util
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from docs.figures.reference_tables import write_tables

HERE = Path(__file__).parents[2] / "docs" / "examples" / "reference"
TABLES = HERE / "tables"
NAMES = (
    "contact", "friction", "sweep", "event", "curved", "leaning", "whisking", "space",
    "space-friction",
)  # fmt: skip
PLANTED = 100
FOUND = 95  # at least


@pytest.fixture(scope="module")
def python():
    spec = importlib.util.spec_from_file_location("check", HERE / "check.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return lambda *given: "\n".join(module.check(*map(Path, given[:2]), *given[2:]))


@pytest.fixture(scope="module")
def cpp(tmp_path_factory):
    if shutil.which("g++") is None:
        pytest.skip("no g++")
    program = tmp_path_factory.mktemp("cpp") / "check"
    asked = ["g++", "-std=c++17", "-Wall", "-Werror", HERE / "check.cpp", "-o", program]
    subprocess.run(asked, check=True)

    def check(*given):
        asked = [program, *map(str, given)]
        done = subprocess.run(asked, capture_output=True, text=True, check=False)
        assert done.returncode == (done.stdout != "agrees\n"), done.stderr
        return "" if done.returncode == 0 else done.stdout

    return check


@pytest.fixture(params=["python", "cpp"])
def check(request):
    return request.getfixturevalue(request.param)


@pytest.mark.slow
@pytest.mark.skipif(sys.version_info >= (3, 12), reason="NumPy's last digit is another one there")
def test_the_tables_are_made_again(tmp_path):
    """Bit for bit, but for the last digit, which is another one on some processors."""
    written = write_tables(tmp_path)
    assert {path.name for path in written} == {path.name for path in TABLES.iterdir()}
    for path in written:
        if path.read_bytes() != (TABLES / path.name).read_bytes():
            numbers = [pd.read_csv(x).select_dtypes("number") for x in (path, TABLES / path.name)]
            # A slip speed is exact to 1e-10, and at an event a last digit decides the phase.
            pd.testing.assert_frame_equal(*numbers, rtol=0, atol=1e-10)
    assert sum(path.stat().st_size for path in written) < 5e6


@pytest.mark.parametrize("name", NAMES)
def test_a_table_agrees_with_itself(name, check):
    assert check(TABLES / f"{name}.csv", TABLES / f"{name}.csv") == ""


def test_every_column_is_explained():
    known = set(pd.read_csv(TABLES / "columns.csv")["column"])
    for name in NAMES:
        assert set(pd.read_csv(TABLES / f"{name}.csv").columns) <= known


def plantings():
    """Table, what is planted, and how a complaint names it."""
    rng = np.random.default_rng(34)
    for _ in range(PLANTED):
        name = str(rng.choice(NAMES))
        table = pd.read_csv(TABLES / f"{name}.csv")
        numbers = [c for c in table.select_dtypes("float") if table[c].abs().max() > 1e-12]
        column, kind = str(rng.choice(numbers)), str(rng.choice(["sign", "unit", "stale"]))
        if kind == "sign":
            table[column] *= -1
        elif kind == "unit":
            table[column] *= float(rng.choice([1e3, 1e-3, 25.4, np.pi / 180, 180 / np.pi, 9.81]))
        else:  # the rows of another version
            table = table.drop(index=int(rng.integers(len(table))))
        said = "stale" if kind == "stale" else f"{column}: wrong {kind}"
        yield name, table, said


@pytest.mark.slow
@pytest.mark.parametrize(("noise", "tolerance"), [(0.0, 1e-6), (3e-3, 1e-2)])
def test_plantings_are_named(check, noise, tolerance, tmp_path):
    """In a file that is exact, and in one of an engine; with the line ends of Windows."""
    named, rng = 0, np.random.default_rng(1)
    written = {"index": False, "na_rep": "nan", "float_format": "%.13e", "lineterminator": "\r\n"}
    for name, table, said in plantings():
        for column in table.select_dtypes("float"):
            table[column] += noise * table[column].abs().max() * rng.uniform(-1, 1, len(table))
        table.to_csv(tmp_path / "mine.csv", **written)
        named += said in check(TABLES / f"{name}.csv", tmp_path / "mine.csv", tolerance)
    assert named >= FOUND


def test_a_reference_that_was_changed_is_stale(check, tmp_path):
    for path in TABLES.iterdir():
        shutil.copy(path, tmp_path)
    changed = tmp_path / "contact.csv"
    changed.write_text(changed.read_text().replace("1", "2", 1))
    assert "stale" in check(changed, changed)


def test_a_number_that_is_off_is_said(check, tmp_path):
    table = pd.read_csv(TABLES / "contact.csv")
    table.loc[3, "force_x"] *= 1.01
    table.to_csv(tmp_path / "mine.csv", index=False, na_rep="nan")
    assert "force_x: off" in check(TABLES / "contact.csv", tmp_path / "mine.csv")
