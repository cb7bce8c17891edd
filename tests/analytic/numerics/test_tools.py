from typing import NamedTuple

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline

from analytic.numerics.batches import put, take
from analytic.numerics.hermite import hermite, least_of_hermite
from analytic.numerics.vectors import cross

NUMBERS = st.lists(st.floats(-10, 10), min_size=4, max_size=4)


class Inner(NamedTuple):
    x: np.ndarray
    name: str


class Outer(NamedTuple):
    inner: Inner
    y: np.ndarray
    nothing: float | None


def batch(begin):
    return Outer(Inner(begin + np.arange(4.0), "a"), begin + np.arange(8.0).reshape(4, 2), None)


def test_some_of_a_batch_and_others_in_their_place():
    whole = batch(0.0)
    some = take(whole, np.array([False, True, False, True]))
    assert isinstance(some.inner, Inner) and some.inner.name == "a" and some.nothing is None
    assert some.inner.x.tolist() == [1, 3] and some.y.tolist() == [[2, 3], [6, 7]]
    put(whole, np.array([0, 2]), take(batch(10.0), np.array([3, 1])))
    assert whole.inner.x.tolist() == [13, 1, 11, 3]
    assert whole.y.tolist() == [[16, 17], [2, 3], [12, 13], [6, 7]]


@given(NUMBERS, st.floats(0, 1))
def test_hermites_cubic_is_that_of_scipy(given_, share):
    begin, rate, end, end_rate = given_
    expected = CubicHermiteSpline([0, 1], [begin, end], [rate, end_rate])(share)
    assert abs(hermite(share, begin, rate, end, end_rate) - expected) < 1e-13


@given(st.floats(-10, 10), st.floats(0.01, 10), st.floats(-10, 10), st.floats(0.01, 10))
def test_the_least_of_a_cubic_that_falls_and_rises_is_where_its_rate_vanishes(
    begin, fall, end, rise
):
    share = least_of_hermite(*map(np.array, (begin, -fall, end, rise)))
    cubic = CubicHermiteSpline([0, 1], [begin, end], [-fall, rise])
    assert 0 < share < 1
    assert abs(cubic(share, 1)) < 1e-8
    assert cubic(share, 2) > -1e-6


def test_cross_product_of_rows_of_components():
    a, b = np.random.default_rng(0).normal(size=(2, 3, 5))
    np.testing.assert_allclose(cross(a, b), np.cross(a, b, axis=0), rtol=0, atol=1e-15)
    np.testing.assert_allclose(cross(a[:, 0], b[:, 0]), np.cross(a[:, 0], b[:, 0]), atol=1e-15)
