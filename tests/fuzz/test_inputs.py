"""A short run of the fuzzing that ``make fuzz`` goes on with."""

import pytest

from tests.fuzz.inputs.campaign import campaign


@pytest.mark.slow
@pytest.mark.filterwarnings("default")
def test_bad_input_ends_in_one_line():
    _, bad = campaign(range(60), seed=2026)
    assert not bad, "\n".join(bad)
