"""The mean of passes: what is the same in all is no difference between them."""

import numpy as np
import pytest

from analytic import CLAMP_READINGS, SENSED, Readings
from compare import compare
from compare.measure.repeats import repeats
from tests.conftest import exact_sweep


@pytest.mark.parametrize("name", ["catenary", "parabola"])
@pytest.mark.parametrize("noise", [1e-6, 1e-2])
def test_passes_alike_are_not_displaced_and_their_mean_is_the_sweep(name, noise):
    """Four stations are averaged, over bends and next to the snap-off: neither may show."""
    exact, rng, passes = exact_sweep(name), np.random.default_rng(1), []
    for _ in range(6):
        table = exact.table[list(SENSED)].fillna(0.0)
        for reading in CLAMP_READINGS:
            largest = table[reading].abs().max()
            table[reading] += noise * largest * rng.standard_normal(len(table))
        passes.append(Readings(table, exact.beam))
    found = repeats(passes)
    shifts = found.shifts.numbers.ravel()
    assert abs(shifts.mean()) < 0.1 * noise
    assert (np.abs(shifts) < 4 * found.uncertainty).all()
    compared = compare(exact, found.mean, noise="auto")
    assert compared.agrees, compared
