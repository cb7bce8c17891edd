"""The closed form of a span against integration of the pendulum's equation."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analytic.solver.general.span import back_to_clamp

N = 300
# DOP853 at rtol 3e-14 errs by 4e-13 where an error of the start grows by e^4 along the span.
INTEGRATED = 2e-12


def integrated(theta, kappa, force, length):
    def rate(_, state):
        phi, curvature = state.reshape(4, -1)[:2]
        change = [curvature, force * np.cos(phi), -np.cos(phi), -np.sin(phi)]
        return (-length * np.array(change)).ravel()

    start = np.concatenate([theta, kappa, np.zeros(2 * theta.size)])
    found = solve_ivp(rate, (0, 1), start, method="DOP853", rtol=3e-14, atol=1e-14)
    return found.y[:, -1].reshape(4, -1)


def spans(kind):
    random = np.random.default_rng(5)
    theta, kappa = random.uniform(-1.2, 2.6, N), random.normal(0, 1, N)
    force, length = random.uniform(0.01, 20, N), random.uniform(0.05, 1, N)
    if kind == "paper's":
        kappa = np.zeros(N)
    elif kind == "no force":
        force = np.zeros(N)
    elif kind == "nearly no force":
        force = 10.0 ** random.uniform(-14, -3, N)
    elif kind == "separatrix":  # k = 1: the pendulum comes to rest upright
        aside = random.choice([0, 1e-15, -1e-12, 1e-9, 1e-6], N)
        kappa = -2 * np.sqrt(force) * np.cos(np.pi / 4 - theta / 2) * (1 + aside)
        length = np.minimum(length, 3 / np.sqrt(force))
    elif kind == "turns over":  # k > 1
        kappa = np.sign(kappa) * (2 * np.sqrt(force) + np.abs(kappa))
    return theta, kappa, force, length


@pytest.mark.parametrize(
    "kind",
    ["random", "paper's", "no force", "nearly no force", "separatrix", "turns over"],
)
def test_span_is_the_pendulum(kind):
    given = spans(kind)
    found = back_to_clamp(*given)
    theta, kappa, along, across = integrated(*given)
    turned = np.pi / 2 - 2 * np.arctan2(found.p, found.g) - theta
    np.testing.assert_allclose(np.angle(np.exp(1j * turned)), 0, atol=INTEGRATED)
    np.testing.assert_allclose(found.kappa, kappa, rtol=INTEGRATED, atol=5 * INTEGRATED)
    np.testing.assert_allclose(found.along, along, atol=INTEGRATED)
    np.testing.assert_allclose(found.across, across, atol=INTEGRATED)


def test_circle_that_a_couple_straightens():
    """A natural circle of curvature 1/R is straight under the moment EI/R, whatever its length."""
    lengths = np.linspace(0.1, 1.0, 7)
    slope, none = np.full(7, 0.4), np.zeros(7)
    found = back_to_clamp(slope, none, none, lengths)  # natural curvature and couple cancel
    np.testing.assert_allclose(found.along, lengths * np.cos(0.4), rtol=1e-15)
    np.testing.assert_allclose(found.across, lengths * np.sin(0.4), rtol=1e-15)


def test_a_span_of_no_force_may_seem_shorter_than_nothing():
    """As a step of Newton's method makes it between two contacts: a warning, before."""
    start = back_to_clamp(*(np.array([x]) for x in (0.3, 0.0, 0.0, -1e-3)))
    assert np.isfinite(start.p).all()
