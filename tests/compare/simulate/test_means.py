"""Sweeps at rest whose stations are means, as those of a sweep in motion are."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Sweep, named_case
from compare.simulate.moving import sweep_as_means
from mujoco_models import Settings, simulate_sweep

CASE = replace(named_case("parabola"), sweep=Sweep(13))
SETTINGS = Settings(segments=5, contour_points=200)


@pytest.mark.slow
@pytest.mark.parametrize("average", [1.0, 0.5])
def test_they_are_means_over_the_way_round_each_station(average):
    found = sweep_as_means(CASE, SETTINGS, average)
    x = CASE.foot_x
    dense = replace(CASE, sweep=Sweep(12 * 8 + 1, float(x[0]), float(x[-1])))
    all_ = simulate_sweep(dense, SETTINGS)
    np.testing.assert_allclose(found.values("foot_x"), x, rtol=0, atol=1e-12)
    half = round(4 * average)
    weights = np.ones(2 * half + 1)
    weights[[0, -1]] = 0.5
    for name in CLAMP_READINGS:
        values = all_.values(name)
        middle = values[8 * 6 - half : 8 * 6 + half + 1]
        expected = (weights @ middle) / weights.sum()
        # A way's half is cut into eight parts again, between which it is linear.
        assert found.values(name)[6] == pytest.approx(expected, rel=1e-9)
