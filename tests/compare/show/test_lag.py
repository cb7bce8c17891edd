"""What is said of passes both ways: a lag, what looks like it, or both."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from analytic.from_clamp.calibration.calibrate import Estimate
from analytic.from_clamp.object.lag import Lag
from compare.show.passes import lag_remembered, lag_summary, with_lag
from tests.conftest import exact_sweep

WAY, LENGTH = Estimate(0.004, 0.003, 0.005), Estimate(1.01, 1.009, 1.012)
LATE, LONGER = "the readings come after the positions: 0.004", "a vibrissa of 1.01 times [beam]'s"


@pytest.mark.parametrize(
    ("way", "otherwise", "said", "unsaid"),
    [
        (WAY, {}, [LATE, "lag = 0.004"], "either"),
        (WAY, {"length": LENGTH}, [f"either {LATE}", f"; or {LONGER} length (95 %"], "no lag"),
        (None, {"length": LENGTH}, [f"no lag, but {LONGER}"], "come after"),
        (None, {"lever": WAY}, ["about a point +0.004 L along the vibrissa off"], "come after"),
    ],
)
def test_the_causes_are_said_and_remembered(way, otherwise, said, unsaid):
    left = exact_sweep("catenary")
    right = replace(left, table=left.table[::-1].reset_index(drop=True))
    found = Lag(way, Estimate(1.0, 0.99, 1.01), "circle", otherwise)
    passes = [
        SimpleNamespace(direction=way, readings=one)
        for way, one in (("left", left), ("right", right))
    ]
    text = " ".join(map(str, lag_summary(passes, found, 0.0)))
    remembered = lag_remembered([with_lag(one, found) for one in (left, right)])
    for words in said:
        assert words in text
    assert unsaid not in text
    assert unsaid not in remembered
    assert (LONGER in remembered) == ("length" in otherwise)
