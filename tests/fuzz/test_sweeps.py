"""A short run of the random sweeps."""

import pytest

from tests.fuzz.sweeps import Outcome, main


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["round", "small", "smooth", "needle", "polygon"])
def test_random_sweeps_have_no_silent_error(kind):
    for made, outcome in main(2, 7_000, kind):
        assert isinstance(outcome, Outcome), (made.label, outcome)
        assert not {"silent", "lost"} & set(outcome.flags), (made.label, outcome)
