"""Every exported function says what it takes and returns, in words of today."""

import pytest

from tests import docstrings, words


@pytest.mark.slow  # imports everything
def test_docstrings():
    lines = docstrings.offences()
    assert not lines, "\n".join(lines)


def test_words():
    assert not words.offences(), "\n".join(words.offences())


def test_pages_are_short():
    """So that one is read in five minutes."""
    counted = words.lengths()
    assert counted["README.md"] <= 700
    assert not {page: n for page, n in counted.items() if n > 900}
    assert sum(counted.values()) <= 14_000
