"""Mistakes that people make, planted in random sweeps, are named rightly and never wrongly."""

import pytest

from tests.fuzz.mistakes import MISTAKES, confusion, named

# Those that are cheap to name: no signature of the contour has to be solved for.
CHEAP = (
    "opposite direction",
    "reversed rows",
    "foot_x backwards",
    "shuffled rows",
    "repeated rows",
    "block of rows again",
    "gap",
    "dropout",
    "spikes",
    "saturation",
    "no contact",
    "contact ends early",
    "contact ends late",
    "contact does not end",
    "readings stand still",
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
