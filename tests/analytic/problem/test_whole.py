"""A count may be of any numeric type, as long as it is whole."""

import numpy as np
import pytest

from analytic import InputError, Sweep
from mujoco_models import Settings

COUNTS = lambda x: Sweep(stations=x).stations, lambda x: Settings(segments=x).segments


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize("given", [30, 30.0, np.int64(30), np.float32(30), np.array(30.0)])
def test_a_whole_number_of_any_type_is_an_integer(count, given):
    found = count(given)
    assert found == 30
    assert type(found) is int


@pytest.mark.parametrize("count", COUNTS)
@pytest.mark.parametrize(
    "given",
    [30.5, True, np.array(True), np.nan, np.inf, -np.inf, 1e300, "30", np.array([30]), 30j, None],
)
def test_what_is_not_whole_is_refused(count, given):
    with pytest.raises(InputError, match="a whole number"):
        count(given)
