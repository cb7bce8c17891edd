"""A zero that drifts along a curve: planted, found, and known as well as is said."""

import numpy as np
import pytest
from scipy.signal import lfilter

from compare.read.drift import bent, zero_of

ROWS, NOISE, WAY = 600, 0.01, np.linspace(0.0, 1.0, 600)
FREE = {"free_before": WAY < 0.08, "free_after": WAY > 0.92}
SHAPES = {
    "line": lambda u: 0.03 * u,
    "warming": lambda u: 0.06 * (1 - np.exp(-4 * u)),
    "there and back": lambda u: 0.12 * u * (1 - u),
}
WEAK = {"hardly bent": lambda u: 0.03 * u + 0.05 * u * (1 - u)}


def passes(shape, count, seed, memory=0.0):
    """Zeros of passes without a contact, and what is off the truth in the middle of each."""
    rng, true = np.random.default_rng(seed), (SHAPES | WEAK)[shape](WAY)
    white = rng.standard_normal((count, 3, ROWS)) * np.sqrt(1 - memory**2)
    values = true + NOISE * lfilter([1.0], [1.0, -memory], white)
    zeros = [zero_of(WAY, one, FREE, "pass") for one in values]
    return zeros, bent(zeros), true


@pytest.mark.parametrize("rigs", [3, pytest.param(30, marks=pytest.mark.slow)])
@pytest.mark.parametrize("shape", SHAPES)
def test_what_is_taken_off_is_off_by_no_more_than_is_said(shape, rigs):
    """In the middle of the way, where a line misses a curve most; 10 passes a rig."""
    errors, missed = [], []
    for seed in range(rigs):
        zeros, curves, true = passes(shape, 10, seed)
        middle = ROWS // 2
        for zero, curve in zip(zeros, curves, strict=True):
            known = np.hypot(zero.uncertainty, 2 * curve.uncertainty)
            errors.append((zero.line + curve.away - true)[:, middle] / known)
            missed.append((zero.line - true)[:, middle])
    # At most what one is to expect, and of a curve that is taken off not much less.
    assert np.mean(np.square(errors)) < 1.2
    if shape != "line":
        assert all(curve.shows for curve in curves)
        assert np.sqrt(np.mean(np.square(missed))) > 0.01  # what a line leaves


@pytest.mark.slow
def test_a_bend_too_weak_to_be_seen_is_within_what_is_said():
    errors = []
    for seed in range(24):
        zeros, curves, true = passes("hardly bent", 3, seed)
        for zero, curve in zip(zeros, curves, strict=True):
            if not curve.shows:
                known = np.hypot(zero.uncertainty, 2 * curve.uncertainty)
                errors.append((zero.line - true)[:, ROWS // 2] / known)
    assert len(errors) > 30
    assert np.mean(np.square(errors)) < 1.0


@pytest.mark.parametrize("rigs", [3, pytest.param(40, marks=pytest.mark.slow)])
@pytest.mark.parametrize(
    "memory", [0.97, *(pytest.param(rho, marks=pytest.mark.slow) for rho in (0.0, 0.7, 0.99))]
)
def test_a_straight_drift_stays_a_line(memory, rigs):
    """In noise that remembers for as long as its stretches are, too: 60 of 100 seemed to bend."""
    shown = [passes("line", 10, seed, memory)[1][0].shows for seed in range(rigs)]
    assert np.mean(shown) <= 0.05


def test_few_rows_show_no_curve():
    """Some loaded ones amid noise were taken for one: 0.3 of the largest reading was taken off."""
    some, rng = np.arange(0, ROWS, 8), np.random.default_rng(0)
    values = NOISE * rng.standard_normal((3, len(some)))
    values += np.maximum(0.08 - WAY[some], 0.0)  # as if it were loaded at the beginning
    free = {which: here[some] for which, here in FREE.items()}
    (curve,) = bent([zero_of(WAY[some], values, free, "pass")])
    assert not curve.shows and not curve.away.any()
    assert np.all(curve.uncertainty > NOISE)


def test_one_stretch_that_drifts_says_so_and_noise_does_not():
    rng, only = np.random.default_rng(0), {"free_before": WAY < 0.08}
    noise = NOISE * rng.standard_normal((3, ROWS))
    still = zero_of(WAY, noise, only, "pass")
    drifting = zero_of(WAY, noise + 0.6 * WAY, only, "pass")
    assert not still.ahead.any()
    shown = drifting.ahead[drifting.ahead != 0]
    assert len(shown) >= 2  # one of three looks like noise that remembers, at 2.4 deviations
    np.testing.assert_allclose(shown, 0.6, rtol=0.3)


def test_what_rounding_leaves_is_no_curve():
    """Zeros that stand still in all their digits "drifted along a curve" by 1e-18."""
    load = np.interp(WAY, [0.2, 0.5, 0.8], [0.0, 1.0, 0.0])
    zeros = [zero_of(WAY, np.tile(load + x, (3, 1)), FREE, "pass") for x in (0.1, 0.3)]
    assert not any(one.shows for one in bent(zeros))
