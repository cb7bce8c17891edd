"""The span's integrals against quadrature, and their derivatives against differences."""

import numpy as np
import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from mpmath import mp, mpf

from analytic.solver.elastica import (
    frame,
    span,
    span_by_alpha,
    span_by_excess,
    span_by_excess_twice,
    span_of_moment,
    tangent_span,
)
from analytic.solver.equilibria import greatest_height, tip_state

ANGLES = st.floats(-1.5, 1.5)
FRACTIONS = st.floats(1e-6, 1.0)


def tip_height(excess, alpha):
    loaded = span(excess, alpha)
    return frame(loaded, alpha).up / loaded.q


def excess_at(alpha, fraction):
    return np.array([fraction * (np.pi / 2 - abs(alpha))])


def quadrature(excess, alpha):
    """q, C, S by 30-digit quadrature in theta = theta_1 + (theta_0 - theta_1) v^2."""
    with mp.workdps(30):
        top = mp.pi / 2 - mpf(alpha)
        bottom = top - mpf(excess) - max(mpf(0), -2 * mpf(alpha))
        width = top - bottom

        def weight(v):
            rise = 2 * mp.cos((2 * bottom + width * v * v) / 2) * mp.sin(width * v * v / 2)
            return 2 * width * v / mp.sqrt(2 * rise)

        def integral(kind):
            return mp.quad(lambda v: weight(v) * kind(bottom + width * v * v), [0, 0.5, 1])

        return tuple(float(integral(kind)) for kind in (lambda _: 1, mp.cos, mp.sin))


@pytest.mark.parametrize("alpha", [-1.2, -0.5, -1e-3, 1e-9, 0.1, 0.6, 1.5])
@pytest.mark.parametrize("fraction", [1e-5, 0.01, 0.5, 1.0])
def test_span_is_the_integral(alpha, fraction):
    excess = excess_at(alpha, fraction)
    found = [float(x[0]) for x in span(excess, np.array([alpha]))]
    # Absolute: S may vanish. q is at most 4.
    np.testing.assert_allclose(found, quadrature(float(excess[0]), alpha), atol=4e-15, rtol=4e-15)


@pytest.mark.parametrize("alpha", [-1.55, -1.2, -0.5, -1e-3, -0.0, 1e-9, 0.1, 0.6, 1.5, 1.5707])
@pytest.mark.parametrize("fraction", [0.0, 1e-5, 0.01, 0.5, 1.0])
def test_many_spans_at_once_are_those_of_one(alpha, fraction):
    """Many take another way to the elliptic integrals."""
    one = span(excess_at(alpha, fraction), np.array([alpha]))
    many = span(np.repeat(excess_at(alpha, fraction), 1000), np.full(1000, alpha))
    for alone, among in zip(one, many, strict=True):
        np.testing.assert_allclose(among, np.repeat(alone, 1000), atol=2e-14, rtol=2e-15)


@pytest.mark.parametrize("moment", [-0.7, -1e-9, 0.0, 1e-9, 0.7, 1.4, 1.9, 1.999, 2.1])
def test_many_spans_of_a_moment_are_those_of_one(moment):
    """Also beyond what a contact can have: readings are noisy."""
    for alpha in (-0.9, -1e-3, 1e-3, 0.4, 1.2):
        one = span_of_moment(np.array([moment]), np.array([alpha]))
        many = span_of_moment(np.full(1000, moment), np.full(1000, alpha))
        for alone, among in zip(one, many, strict=True):
            np.testing.assert_allclose(among, np.repeat(alone, 1000), atol=2e-14, rtol=1e-14)


@pytest.mark.parametrize("alpha", [-1.57, -1.2, -0.5, -1e-9, 0.0, 0.1, 0.6, 1.5, 1.5707])
def test_tangential_span_is_the_integral(alpha):
    found = [float(x[0]) for x in tangent_span(np.array([alpha]))]
    exact = quadrature(float(excess_at(alpha, 1.0)[0]), alpha)
    np.testing.assert_allclose(found, exact, rtol=2e-15, atol=1e-15)


@given(ANGLES, st.floats(0.05, 0.95))
def test_derivatives(alpha, fraction):
    assume(abs(alpha) > 1e-3)  # the excess is counted from another rotation on either side of 0
    w, a = excess_at(alpha, fraction), np.array([alpha])
    h = 1e-4 * min(float(w[0]), abs(alpha), 0.1)

    def by_excess(excess):
        return span_by_excess(span(excess, a), excess, a)

    first = by_excess(w)
    for derivative, ahead, behind, rounding in (
        (first, span(w + h, a), span(w - h, a), 1e-14),
        (span_by_alpha(span(w, a), first, a), span(w, a + h), span(w, a - h), 1e-14),
        (span_by_excess_twice(span(w, a), first, w, a), by_excess(w + h), by_excess(w - h), 1e-13),
    ):
        for found, high, low in zip(derivative, ahead, behind, strict=True):
            # Central difference: h^2 truncation, eps/h round-off.
            error = abs(found[0] - (high - low)[0] / (2 * h))
            assert error < (1 + abs(found[0])) * (1e-6 + rounding / h)


def test_tip_excess_of_many_inverts_the_height():
    alpha = np.random.default_rng(1).uniform(-1.5, 1.5, 5000)
    w = (np.pi / 2 - np.abs(alpha)) * np.random.default_rng(2).uniform(0, 1, 5000) ** 2
    eta = tip_height(w, alpha)
    inside = (eta > 0) & (eta < greatest_height(alpha) - 1e-14)
    found, loaded = tip_state(alpha[inside], eta[inside])
    for values, again in zip(loaded, span(found, alpha[inside]), strict=True):
        assert np.abs(values - again).max() < 2e-14  # of so many at once, each is good to 1e-14
    assert np.abs(tip_height(found, alpha[inside]) - eta[inside]).max() < 4e-14


@example(0.0, 1 - 1e-16)
@given(ANGLES, st.floats(0.0, 1.0))
def test_tip_excess_inverts_the_height(alpha, fraction):
    a = np.array([alpha])
    lowest = tip_height(excess_at(alpha, 1.0), a)
    eta = lowest + fraction * (greatest_height(a) - lowest)
    excess, _ = tip_state(a, eta)
    if np.isnan(excess[0]):
        assert fraction > 1 - 1e-14
    else:
        assert abs(tip_height(excess, a) - eta)[0] < 4e-15


def test_out_of_reach_is_not_a_number():
    alpha = np.array([0.3, 0.0, -0.5])
    assert np.isnan(tip_state(alpha, greatest_height(alpha) + 1e-9)[0]).all()
