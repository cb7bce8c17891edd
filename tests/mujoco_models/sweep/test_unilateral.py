"""Contact forces push or are zero, and minimise the energy, however many contacts there are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

from mujoco_models.sweep.unilateral import unilateral

STIFF = 1e4


def drawn(seed, contacts, links):
    draw = np.random.default_rng(seed)
    comes = draw.normal(size=(contacts, links))
    root = draw.normal(size=(links, links))
    turns = comes @ np.linalg.inv(root @ root.T + np.eye(links))
    return comes, turns, np.full(contacts, 1 / STIFF), draw.normal(size=contacts)


@given(st.integers(0, 10**6), st.integers(1, 60), st.integers(2, 20))
@settings(max_examples=100)
def test_what_pushes_closes_its_gap_and_the_others_stay_open(seed, contacts, links):
    comes, turns, soft, gap = drawn(seed, contacts, links)
    force = unilateral(comes, turns, soft, gap, gap < 0)
    left = comes @ (force @ turns) + soft * force + gap
    near = 1e-9 * (1 + np.abs(left).max())
    assert (force >= 0).all()
    assert (left > -near).all()
    assert np.abs(force * left).max() < near * (1 + force.max())


@pytest.mark.parametrize("guessed", [False, True])
def test_any_guess_leads_to_the_forces_of_another_method(guessed):
    comes, turns, soft, gap = drawn(1, 40, 6)
    root = np.linalg.cholesky(comes @ turns.T + np.diag(soft))
    expected = nnls(root.T, -np.linalg.solve(root, gap))[0]
    found = unilateral(comes, turns, soft, gap, np.full(40, guessed))
    np.testing.assert_allclose(found, expected, atol=1e-8 * expected.max())
