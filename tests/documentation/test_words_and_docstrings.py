"""Every public function says what it takes and returns, in words of today.

``left.json`` counts what is still to be done, room by room; it may only shrink, and a room that is
not in it has nothing left.
"""

import json
from collections import Counter
from pathlib import Path

import pytest

from tests import docstrings, words

LEFT = json.loads(Path(__file__).with_name("left.json").read_text(encoding="utf-8"))


@pytest.mark.slow  # imports everything
def test_docstrings():
    _only_those_left(docstrings.offences(), docstrings.room, "docstrings")


def test_words():
    _only_those_left(words.offences(), words.room, "words")


def _only_those_left(lines, room, kind):
    counts = Counter(map(room, lines))
    new = {where: n for where, n in counts.items() if n > LEFT[kind].get(where, 0)}
    assert not new, "\n".join(line for line in lines if room(line) in new)
