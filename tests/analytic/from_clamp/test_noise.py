"""How large noise is, from what the readings scatter by where nothing touches."""

import numpy as np
import pytest
from scipy.signal import lfilter

from analytic.from_clamp.noise import resting_noise, scatter

SIZES = np.array([0.01, 0.02, 0.005])


def readings(memory, seed):
    """Of a load between two stretches without one, shape (3, 6000)."""
    way = np.linspace(0.0, 1.0, 6000)
    load = np.where((way > 0.3) & (way < 0.7), np.sin((way - 0.3) / 0.4 * np.pi), 0.0)
    white = np.random.default_rng(seed).standard_normal((3, 6000)) * np.sqrt(1 - memory**2)
    noise = SIZES[:, None] * lfilter([1.0], [1.0, -memory], white)
    return load * np.array([[-0.3], [1.0], [0.5]]) + noise


@pytest.mark.parametrize("memory", [0.7, 0.9])
def test_noise_that_remembers_is_as_large_as_it_is(memory):
    """Its jumps are a quarter of it; of the 3600 stations off the load, 400 are independent."""
    values = np.array([readings(memory, seed) for seed in range(5)])
    jumps = [[scatter(row) for row in one] for one in values]
    found = [resting_noise(one, np.array(seen)) for one, seen in zip(values, jumps, strict=True)]
    assert np.mean(jumps / SIZES) < 0.6
    np.testing.assert_allclose(np.mean(found / SIZES, axis=0), 1.0, atol=0.1)


def test_white_noise_is_as_its_jumps_say():
    """A tenth more is clear in 1800 stations, half as much more than is seen in it."""
    values = readings(0.0, 1)
    seen = np.array([scatter(row) for row in values])
    np.testing.assert_array_equal(resting_noise(values, seen), seen)
    np.testing.assert_allclose(resting_noise(values, SIZES / 1.15), SIZES, rtol=0.06)


def test_a_converter_hides_noise_where_few_neighbours_are_equal():
    """Fourth differences of a slope are zero; a ramp that nothing rounds has no noise."""
    ramp = 0.95 * np.arange(200.0)
    np.testing.assert_allclose(scatter(0.01 * np.round(ramp)), 0.01 / np.sqrt(12))
    assert scatter(ramp) < 1e-11
