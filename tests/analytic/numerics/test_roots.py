"""Zeros: of smooth functions, of jumps, of a thousand, and in how many calls."""

import numpy as np
import pytest
from numpy.typing import ArrayLike

from analytic.numerics.roots import smooth_zeros, zero, zeros

EPS = float(np.finfo(float).eps)


@pytest.mark.parametrize("count", [1, 2, 7, 40, 1000])
def test_any_number_of_zeros_is_found_to_rounding(count: int) -> None:
    place = np.linspace(0.1, 0.9, count)
    found = zeros(lambda i, x: np.expm1(3 * (x - place[i])), np.zeros(count), np.ones(count))
    np.testing.assert_allclose(found, place, rtol=4 * EPS)


def test_the_place_of_a_jump_is_found_to_rounding() -> None:
    assert zero(lambda x: np.where(x < 1 / 3, -1e-3, 5.0), 0.0, 1.0) == pytest.approx(
        1 / 3, rel=4 * EPS
    )


def test_bounds_may_be_in_either_order() -> None:
    assert zero(lambda x: x - 0.25, 1.0, 0.0) == 0.25


def test_a_triple_zero_and_a_tiny_one_are_enclosed() -> None:
    assert zero(lambda x: (x - 0.7) ** 3, 0.0, 1.0) == pytest.approx(0.7, rel=1e-5)
    assert zero(lambda x: x - 1e-19, 0.0, 1.0) == pytest.approx(1e-19, rel=1e-12)


def _nearly_known(likely: ArrayLike, jump: bool = False) -> tuple[np.ndarray, int]:
    """The zeros of two functions at 0.3 and 0.6, and how many calls they took."""
    calls = []

    def function(which: np.ndarray, x: np.ndarray) -> np.ndarray:
        calls.append(x.size)
        smooth = np.expm1(x - np.array([0.3, 0.6])[which])
        return np.asarray(np.sign(smooth) - 0.5 if jump else smooth)

    found = smooth_zeros(function, np.zeros(2), np.ones(2), np.array(likely))
    return found, len(calls)


def test_zeros_that_are_nearly_known_take_one_call() -> None:
    found, calls = _nearly_known([0.32, 0.55])
    np.testing.assert_allclose(found, [0.3, 0.6], rtol=16 * EPS)
    assert calls == 1


@pytest.mark.parametrize(("likely", "jump"), [((0.9, 0.6), False), ((0.3, 0.6), True)])
@pytest.mark.parametrize("unknown", [False, True])
def test_a_wrong_guess_and_a_jump_cost_calls_and_no_digits(
    likely: tuple[float, float], jump: bool, unknown: bool
) -> None:
    found, calls = _nearly_known([np.nan, likely[1]] if unknown else likely, jump)
    np.testing.assert_allclose(found, [0.3, 0.6], rtol=16 * EPS)
    assert calls > 1
