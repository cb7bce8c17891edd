"""The findings in Markdown: the page of many runs, and what only our own are asked."""

from pathlib import Path

import pandas as pd
import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure

from analytic import CASE_NAMES, InputError
from compare.show.page import png
from docs.figures.findings import write_findings
from docs.figures.markdown import plain
from docs.figures.methods_record import method_sentences, read_methods
from tests.compare.show.sweeps import two_runs


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Two runs, one with a budget, one with its readings, and a table of methods."""
    made = two_runs(tmp_path_factory.mktemp("runs"))
    (made / "methods").mkdir()
    methods_table(good=1e-3, poor=0.2).to_csv(made / "methods" / "methods.csv", index=False)
    (made / "methods" / "methods.png").write_bytes(png(Figure((1, 1))))
    return made


def test_page(folder, tmp_path):
    written = write_findings(folder, tmp_path)
    names = ["README.md", "budget-parabola-chain.png", "methods-on-mine.png", "methods-on-mine.csv"]
    assert [path.name for path in written] == names
    assert {path.name for path in tmp_path.iterdir()} == set(names)
    assert written[1].stat().st_size < 40_000  # fifteen of them stay below 1 MB
    text = written[0].read_text(encoding="utf-8")
    assert "| catenary | chain | 40 |" in text
    assert text.count("](budget-") == 1  # others look alike
    assert "](budget-parabola-chain.png)" in text
    assert "![What each method survives on readings of the case mine](methods-on-mine.png)" in text
    assert "mine,exact,good,0,tip,10,1,0.001" in written[3].read_text()
    for table in text.split("\n\n"):
        cells = {line.count("|") for line in table.splitlines() if line.startswith("|")}
        assert len(cells) <= 1  # every row has all its cells


@given(st.text())
def test_any_name_is_plain_in_markdown(text):
    written = plain(text)
    assert not set("<>|\n") & set(written)


def test_a_damaged_picture_is_a_line(folder, tmp_path):
    (tmp_path / "run").mkdir()
    for file in (folder / "parabola-chain").iterdir():
        (tmp_path / "run" / file.name).write_bytes(file.read_bytes())
    (tmp_path / "run" / "budget.png").write_text("no picture")
    with pytest.raises(InputError, match=r"budget\.png = missing or damaged"):
        write_findings(tmp_path, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def methods_table(**medians):
    """A table of two methods on exact readings and with friction, in two phases."""
    rows = [
        {
            "case": "mine", "readings": readings, "method": method, "noise": noise, "phase": phase,
            "contacts": 10, "answered": 0.5 if method == "rare" else 1.0,
            "median": medians[method] * (1 if noise == 0 else 30),
        }
        for readings in ("exact", "friction")
        for method in medians
        for noise in (0.0, 0.01)
        for phase in ("tangent", "tip")
    ]  # fmt: skip
    return pd.DataFrame(rows)


def test_methods_that_survive_are_named(tmp_path):
    folder = tmp_path / "runs" / "one"
    folder.mkdir(parents=True)
    methods_table(good=1e-3, poor=0.2, rare=1e-3).to_csv(folder / "methods.csv", index=False)
    (record,) = read_methods(tmp_path / "runs")
    assert record.survivors("exact", 0.0) == ["good"]
    said = method_sentences(record)
    assert "exact: good; friction: good." in said
    assert "At 1 % of noise the best on exact readings: A good (3.0e-2), B good (3.0e-2)." in said


@pytest.mark.parametrize("damage", ["", "a,b\n1,2\n", "\x00"])
def test_a_damaged_table_of_methods_is_one_line(tmp_path, damage):
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "methods.csv").write_text(damage)
    with pytest.raises(InputError, match=r"methods\.csv"):
        read_methods(tmp_path)


def test_all_named_cases_are_made():
    makefile = (Path(__file__).parents[2] / "Makefile").read_text()
    (line,) = (line for line in makefile.splitlines() if line.startswith("CASES :="))
    assert line.removeprefix("CASES :=").split() == list(CASE_NAMES)
