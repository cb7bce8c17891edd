"""How well a sweep shows its own noise."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from analytic import CLAMP_READINGS, Sweep, named_case, solve_sweep
from compare.sense.noise import shown_noise


@pytest.mark.parametrize(("memory", "least", "most"), [(0.0, 0.4, 1.6), (0.9, 0.3, 2.0)])
def test_a_level_is_off_by_as_much_as_is_said(memory, least, most):
    """Mean square of 90 errors over their uncertainties."""
    exact = solve_sweep(replace(named_case("parabola"), sweep=Sweep(2000)))
    sizes = {name: 0.01 * np.abs(exact.values(name)).max() for name in CLAMP_READINGS}
    squares = []
    for seed in range(30):
        white = np.random.default_rng(seed).standard_normal((3, 2500)) * np.sqrt(1 - memory**2)
        noise = lfilter([1.0], [1.0, -memory], white)[:, 500:]
        columns = {n: exact.values(n) + sizes[n] * x for n, x in zip(sizes, noise, strict=True)}
        found = shown_noise(replace(exact, table=exact.table.assign(**columns)))
        squares += [((found.level[n] / sizes[n] - 1) / found.unsure[n]) ** 2 for n in sizes]
    assert least < np.mean(squares) < most
