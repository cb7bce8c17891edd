"""Minima of the energy in the solver's own picture, where beads share a sharp contour's load."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Beam, Case, Sweep, ellipse
from mujoco_models import Settings
from mujoco_models.obstacles.prism import Prism
from mujoco_models.sweep.minimum import minimum
from mujoco_models.sweep.newton import levers, of_links
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.picture import Picture
from mujoco_models.sweep.sweep import set_out

NEEDLE = Case(Beam(radius=0.002), ellipse((0.09, 3.2), (0.0, 0.25)), Sweep(stations=40))
SOFT = Settings(segments=20, contour_points=1600, contact_stiffness=1e5)


@pytest.fixture(scope="module")
def at_the_tip():
    """The walk with the needle's tip on several beads, and where its foot is."""
    walk = set_out(NEEDLE, SOFT)
    for foot_x in NEEDLE.foot_x[:22]:
        walk.go_to(float(foot_x))
    assert walk.doubt is None
    assert len(walk._state.forces) > 2
    return walk, float(foot_x)


def test_the_nearest_facet_of_a_needle(at_the_tip):
    """Beside a tip that is sharper than a bead: against all facets, one by one."""
    obstacle = Prism.of(NEEDLE, 1600)
    low = obstacle.lowest
    draw = np.random.default_rng(3)
    out = np.array([np.sin(a := draw.uniform(-1.2, 1.2, 400)), -np.cos(a)]).T
    points = low + 0.004 * draw.uniform(0.2, 2, (400, 1)) * out
    begin, run = obstacle.vertices[:-1], np.diff(obstacle.vertices, axis=0)
    off = points[:, None] - begin
    along = np.clip((off * run).sum(axis=2) / (run**2).sum(axis=1), 0, 1)
    exact = np.hypot(*np.moveaxis(off - along[..., None] * run, 2, 0)).min(axis=1)
    window = obstacle.window_of(float(obstacle.place(np.zeros(1))[0]))
    found, _ = obstacle.gap(window, points)
    np.testing.assert_allclose(found, exact, atol=1e-9)  # single precision from the tip on


def test_the_distance_of_a_needle_from_far_away():
    """Far off, what rounds vertices is more than what one facet is nearer than the next one."""
    obstacle = Prism.of(NEEDLE, 1600)
    draw = np.random.default_rng(4)
    points = np.column_stack([draw.uniform(-0.3, 0.3, 200), draw.uniform(0, 0.24, 200)])
    exact = [obstacle.clearance(point)[0] for point in points]
    for window in range(0, obstacle.windows, 10):
        np.testing.assert_allclose(obstacle.gap(window, points)[0], exact, atol=1e-6)


def test_forces_are_the_slope_of_the_energy(at_the_tip):
    walk, foot_x = at_the_tip
    state = walk._state
    picture = Picture(walk.model, state.forces, 4)
    contacts = picture.look(foot_x, state.angles)
    force = np.maximum(-picture.contact_stiffness * contacts.distance, 0)
    down = (
        of_links(picture.elastic_moments()) + force @ levers(contacts, picture.joint_positions())[0]
    )
    for link, turn in enumerate(1e-8 * np.eye(len(down))):
        turn[1:] -= turn[:-1].copy()  # of one link alone
        up, below = (picture.energy(picture.look(foot_x, state.angles + s * turn)) for s in (1, -1))
        assert (below - up) / 2e-8 == pytest.approx(down[link], abs=2e-6)  # rounding over 1e-8


def test_a_minimum_is_at_rest_for_mujoco_too(at_the_tip):
    """From far too far ahead; Newton's method on MuJoCo's balance needs dozens of steps there."""
    walk, foot_x = at_the_tip
    model, state = walk.model, walk._state
    ahead = replace(state, angles=state.angles + 1e-4)
    found = minimum(model, foot_x, ahead, Numerics())
    assert np.abs(model.imbalance(foot_x, found.angles)).max() < 1e-8


@pytest.mark.parametrize("beads", [0, 30, -60])
def test_a_contact_is_followed_from_bead_to_bead(at_the_tip, beads):
    """It may have slid on by many since it was seen last."""
    walk, foot_x = at_the_tip
    model, state = walk.model, walk._state
    one = replace(state, forces={min(state.forces) + beads: state.load})
    found = minimum(model, foot_x, one, Numerics())
    assert set(found.forces) == set(state.forces)
    assert np.abs(model.imbalance(foot_x, found.angles)).max() < 1e-8
