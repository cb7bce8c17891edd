"""Mistakes that people make, planted in random sweeps, are named rightly and never wrongly."""

import pytest

from tests.fuzz import hidden
from tests.fuzz.mistakes import MISTAKES, confusion, named

# Those that are cheap to name: no signature of the contour has to be solved for.
CHEAP = (
    "opposite direction",
    "reversed rows",
    "foot_x backwards",
    "shuffled rows",
    "repeated rows",
    "gap",
    "dropout",
    "spikes",
    "saturation",
    "no contact",
    "contact ends early",
)


@pytest.mark.parametrize("kind", CHEAP)
def test_a_planted_mistake_of_the_record_is_named(kind):
    assert MISTAKES[kind].named in named(MISTAKES[kind], 1)


@pytest.mark.parametrize(
    "seeds", [pytest.param(10, marks=pytest.mark.trial), pytest.param(1, marks=pytest.mark.slow)]
)
def test_planted_mistakes_are_named(seeds):
    """Asked are 95 % right and at most 2 % wrong: one of those planted once."""
    table = confusion(range(seeds))
    known = [mistake.must for mistake in MISTAKES.values()]
    assert table[known]["right"].sum() >= 0.95 * seeds * sum(known)
    assert table["wrong"].sum() <= 0.02 * seeds * len(table), table.to_string()


@pytest.mark.parametrize(
    "count", [pytest.param(300, marks=pytest.mark.trial), pytest.param(12, marks=pytest.mark.slow)]
)
def test_hidden_mistakes_are_named(count, tmp_path):
    """Their keys are no part of what is read: 85 % right and at most 2 % wrong, or one of few."""
    hidden.make(count, 20261125, tmp_path / "planted")
    keys = (tmp_path / "planted.keys.csv").rename(tmp_path / "apart.csv")
    hidden.name(tmp_path / "planted")
    keys.rename(tmp_path / "planted.keys.csv")
    found = hidden.judge(tmp_path / "planted")
    how = found["how"].value_counts()
    assert len(found) > 0.9 * count
    assert how["right"] >= 0.85 * len(found), found.to_string()
    assert how.get("wrong", 0) <= max(1, 0.02 * len(found)), found.to_string()
