"""One number for correlated differences: its quantile, its parts, and what shrinks it."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from compare.validate.spread import COVERED, NOISE, Spread


def spread(sizes, noise, correlation=None, seed=0, differences=300):
    rng = np.random.default_rng(seed)
    modes = np.array(sizes)[:, None] * rng.standard_normal((len(sizes), differences))
    names = tuple(f"input {i}" for i in range(len(sizes)))
    together = np.eye(len(sizes)) if correlation is None else np.array(correlation)
    return Spread(names, modes, together, np.full(differences, noise), np.ones(differences))


@pytest.mark.parametrize(
    ("sizes", "noise", "correlation"),
    [
        ([1.0], 0.0, None),
        ([1.0, 0.3], 0.1, None),
        ([1.0, 1.0, 1.0], 0.5, None),
        ([0.1], 1.0, None),
        ([1.0, 1.0], 0.2, [[1, 0.8], [0.8, 1]]),
    ],
)
def test_the_limit_holds_for_95_of_100_sets_of_errors(sizes, noise, correlation):
    given = spread(sizes, noise, correlation)
    rng = np.random.default_rng(1)
    root = np.linalg.cholesky(given.correlation)
    errors = (rng.standard_normal((20_000, len(sizes))) @ root.T) @ given.modes
    errors += given.noise * rng.standard_normal(errors.shape)
    rms = np.sqrt(np.mean(errors**2, axis=1))
    u_val, expand = given.limits()
    assert np.sqrt(np.mean(rms**2)) == pytest.approx(u_val, rel=0.03)
    assert np.mean(rms <= expand * u_val) == pytest.approx(COVERED, abs=0.01)
    assert 1 <= expand <= 2.001  # 95.45 % is rounded


def test_one_input_is_expanded_by_two_and_noise_hardly():
    assert spread([1.0], 0.0).limits()[1] == pytest.approx(2.0, abs=1e-3)
    assert spread([1e-6], 1.0, differences=3000).limits()[1] == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize(("rho", "as_white"), [(0.5, 0.93), (0.9, 0.8), (0.97, 0.76)])
def test_noise_that_remembers_has_fewer_degrees_of_freedom(rho, as_white):
    given = spread([0.1], 1.0)
    white = np.random.default_rng(2).standard_normal((5000, 300))
    white[:, 1:] *= np.sqrt(1 - rho**2)
    rms = np.sqrt(np.mean(lfilter([1], [1, -rho], white, axis=1) ** 2, axis=1))
    u_val, expand = replace(given, alike=given.alike * (1 + rho**2) / (1 - rho**2)).limits()
    assert np.mean(rms <= expand * u_val) == pytest.approx(COVERED, abs=0.02)
    u_val, expand = given.limits()
    assert np.mean(rms <= expand * u_val) < as_white


def test_shares_are_those_of_the_variance():
    given = spread([1.0, 2.0], 0.5)
    shares, variance = given.shares(), given.variance() + given.noise**2
    assert sum(shares.values()) == pytest.approx(1)
    assert shares["input 1"] == pytest.approx(np.sum(given.modes[1] ** 2) / np.sum(variance))
    assert shares[NOISE] == pytest.approx(300 * 0.25 / np.sum(variance))


def test_what_shrinks_so_far_lets_the_rest_of_an_error_stand_out():
    given = spread([1.0, 0.1], 0.05)
    other = np.random.default_rng(3).standard_normal(300)
    error = 0.5 * other + 0.5 * given.modes[0]
    factor, stays = given.shrink(error, ["input 0"]), given.stays(error, ["input 0"])
    assert stays == pytest.approx(0.5, rel=0.1)
    u_val, expand = given.limits({"input 0": factor})
    assert 0 < factor < 1
    assert 0.8 * stays < expand * u_val < 0.9 * stays
    assert given.shrink(0.5 * given.modes[0], ["input 0"]) is None
    assert given.shrink(0.1 * other, ["input 0"]) is None
    assert given.shrink(10.0 * other, ["input 0"]) == 1.0


def test_less_noise_is_less_of_an_error():
    """A sine of 0.5 in noise of 1 and an input of 1: all at the stated part of themselves."""
    given, rng = spread([1.0], 1.0), np.random.default_rng(5)
    sine = 0.5 * np.sqrt(2) * np.sin(np.arange(300) / 30)
    every, came_true = given.shares(), []
    for _ in range(200):
        noise = rng.standard_normal(300)
        factor = given.shrink(sine + noise, every)
        if factor is not None:
            u_val, expand = given.limits(dict.fromkeys(every, factor))
            left = sine + factor * rng.standard_normal(300)
            came_true.append(np.sqrt(np.mean(left**2)) > expand * u_val)
        assert given.shrink(noise, every) is None or given.shrink(noise, every) < 0.3
    assert len(came_true) > 150
    assert np.mean(came_true) > 0.95


def test_without_any_uncertainty_all_is_resolved():
    nothing = Spread((), np.zeros((0, 5)), np.zeros((0, 0)), np.zeros(5), np.ones(5))
    assert nothing.limits()[0] == 0.0
    assert nothing.shrink(np.full(5, 1e-12), [NOISE]) == 1.0
