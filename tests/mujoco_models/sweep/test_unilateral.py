"""Contact forces push or are zero, and minimise the energy, however many contacts there are."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import nnls

from mujoco_models.sweep.unilateral import _active_set, _Few, _Many, unilateral

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


@given(st.integers(0, 10**6), st.integers(1, 60), st.integers(2, 20))
@settings(max_examples=100)
def test_active_set_finds_the_forces_of_another_program(seed, contacts, links):
    comes, turns, soft, gap = drawn(seed, contacts, links)
    compliance = _Many(comes, turns, soft)
    root = np.linalg.cholesky(compliance.whole)
    expected = nnls(root.T, -np.linalg.solve(root, gap))[0]
    given = compliance if contacts > links else _Few(compliance.whole)
    # Soft contacts share what stiff links cannot move: rounding grows with stiffness.
    np.testing.assert_allclose(_active_set(given, gap), expected, atol=1e-11 * STIFF)


@pytest.mark.parametrize("guessed", [False, True])
def test_any_guess_leads_to_the_forces_of_another_method(guessed):
    comes, turns, soft, gap = drawn(1, 40, 6)
    root = np.linalg.cholesky(_Many(comes, turns, soft).whole)
    expected = nnls(root.T, -np.linalg.solve(root, gap))[0]
    found = unilateral(comes, turns, soft, gap, np.full(40, guessed))
    np.testing.assert_allclose(found, expected, atol=1e-8 * expected.max())


def test_many_contacts_are_reckoned_with_as_few_are():
    comes, turns, soft, gap = drawn(2, 30, 5)
    many, held = _Many(comes, turns, soft), np.arange(0, 30, 2)
    few = _Few(many.whole)
    force = few.forces(held, gap[held])
    # Soft contacts share what stiff links cannot move: rounding grows with stiffness.
    np.testing.assert_allclose(many.forces(held, gap[held]), force, rtol=1e-8, atol=1e-12 * STIFF)
    everywhere = np.zeros(30)
    everywhere[held] = force
    np.testing.assert_allclose(many.moved(everywhere), few.moved(everywhere), atol=1e-9)
