"""Minima of the energy in the solver's own surrogate, where beads share a sharp contour's load."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Beam, Case, Sweep, ellipse
from mujoco_models import Settings
from mujoco_models.sweep.minimum import minimum
from mujoco_models.sweep.newton import levers, of_links
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.surrogate import Surrogate
from mujoco_models.sweep.sweep import set_out

NEEDLE = Case(Beam(radius=0.002), ellipse((0.09, 3.2), (0.0, 0.25)), Sweep(stations=40))
SOFT = Settings(segments=20, contour_points=1600, contact_stiffness=1e5)


@pytest.fixture(scope="module")
def at_the_tip():
    """The walk with the needle's tip on several beads, and where its clamp is."""
    walk = set_out(NEEDLE, SOFT)
    for foot_x in NEEDLE.foot_x[:22]:
        walk.go_to(float(foot_x))
    assert walk.doubt is None
    assert len(walk._state.forces) > 2
    return walk, walk.model.pose


def test_forces_are_the_slope_of_the_energy(at_the_tip):
    walk, pose = at_the_tip
    state = walk._state
    surrogate = Surrogate(walk.model, state.forces, 4)
    contacts = surrogate.look(pose, state.angles)
    force = np.maximum(-surrogate.contact_stiffness * contacts.distance, 0)
    down = (
        of_links(surrogate.elastic_moments())
        + force @ levers(contacts, surrogate.joint_positions())[0]
    )
    for link, turn in enumerate(1e-8 * np.eye(len(down))):
        turn[1:] -= turn[:-1].copy()  # of one link alone
        up, below = (
            surrogate.energy(surrogate.look(pose, state.angles + s * turn)) for s in (1, -1)
        )
        assert (below - up) / 2e-8 == pytest.approx(down[link], abs=2e-6)  # rounding over 1e-8


def test_a_minimum_is_at_rest_for_mujoco_too(at_the_tip):
    """From far too far ahead; Newton's method on MuJoCo's balance needs dozens of steps there."""
    walk, pose = at_the_tip
    model, state = walk.model, walk._state
    ahead = replace(state, angles=state.angles + 1e-4)
    found = minimum(model, pose, ahead, Numerics())
    assert np.abs(model.imbalance(pose, found.angles)).max() < 1e-8


@pytest.mark.parametrize("beads", [0, 30, -60])
def test_a_contact_is_followed_from_bead_to_bead(at_the_tip, beads):
    """It may have slid on by many since it was seen last."""
    walk, pose = at_the_tip
    model, state = walk.model, walk._state
    one = replace(state, forces={min(state.forces) + beads: state.load})
    found = minimum(model, pose, one, Numerics())
    assert set(found.forces) == set(state.forces)
    assert np.abs(model.imbalance(pose, found.angles)).max() < 1e-8
