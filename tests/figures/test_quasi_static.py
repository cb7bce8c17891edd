"""The page on quasi-static sweeps: its numbers are those of its sweeps."""

from pathlib import Path

import pandas as pd
import pytest

from docs.figures.quasi_static import measure, variants
from docs.figures.quasi_static_picture import quasi_static

TABLE = pd.read_csv(Path(__file__).parents[2] / "results" / "quasi-static.csv")


def test_every_variant_stands_in_the_table_once():
    asked = [(name, value) for name, value, _, _ in variants()]
    assert len(set(asked)) == len(asked)
    assert asked == [*zip(TABLE["setting"], TABLE["value"], strict=True)]


def test_the_picture_shows_every_setting():
    figure = quasi_static(TABLE)
    words = {text.get_text() for ax in figure.axes for text in ax.texts}
    assert {"segments", "solver", "clamp", "98 of 100 stations chatter"} <= words
    assert len(figure.axes) == 7


@pytest.mark.slow
def test_the_numbers_are_those_of_the_sweeps():
    """A tenth for other versions of MuJoCo, whose contacts vibrate otherwise."""
    row = TABLE[(TABLE["setting"] == "segments") & (TABLE["value"] == "10")].iloc[0]
    asked = {(name, value): numerics for name, value, *numerics in variants()}
    found = measure("segments", "10", *asked["segments", "10"])
    for name in ("tip", "tangent", "late"):
        assert found[name] == pytest.approx(row[name], rel=0.1)
