"""The solver's own surrogate for beam and polygon, which the engine confirms; its minima."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import Beam, Case, Sweep, ellipse, named_case
from mujoco_models import Settings, available_beams
from mujoco_models.sweep.minimum import minimum
from mujoco_models.sweep.newton import levers, of_links
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.surrogate import Surrogate
from mujoco_models.sweep.sweep import set_out

CONE = Beam(tip_radius=0.002)


def stations(case, settings, numerics=None):
    """A walk at each of some stations before the snap-off."""
    walk = set_out(case, settings, numerics)
    for foot_x in case.foot_x[15:120]:
        walk.go_to(float(foot_x))
        yield walk


@pytest.mark.parametrize("points", [400, pytest.param(3200, marks=pytest.mark.slow), 50_000])
@pytest.mark.parametrize("beam", [Beam(), CONE], ids=["uniform", "cone"])
def test_the_picture_is_mujocos(points, beam):
    """Places, distances, normals and springs, to rounding: also where single precision rounds."""
    case = replace(named_case("catenary"), beam=beam)
    settings = Settings(segments=20, contour_points=points)
    for number, walk in enumerate(stations(case, settings)):
        contacts = walk.model.contacts()
        if number % 20 or not contacts.loaded.any():
            continue
        order = np.argsort(contacts.touch)
        surrogate = Surrogate(walk.model, contacts.touch.tolist())
        seen = surrogate.look(walk.model.pose, walk.model.beam.angles(walk.model.data))
        loaded = contacts.loaded[order]
        np.testing.assert_array_equal(seen.touch, contacts.touch[order])
        np.testing.assert_allclose(seen.point, contacts.point[order], atol=4e-15)
        np.testing.assert_allclose(
            seen.distance[loaded], contacts.distance[order][loaded], rtol=0, atol=4e-15
        )
        np.testing.assert_allclose(seen.normal[loaded], contacts.normal[order][loaded], atol=1e-12)
        np.testing.assert_allclose(
            surrogate.elastic_moments(), walk.model.elastic_moments(), rtol=0, atol=1e-12
        )


@pytest.mark.parametrize("kind", [name for name in available_beams() if name != "chain"])
def test_the_springs_of_other_beams(kind):
    """By quadrature of their stiffness; observed 2e-13 with the rod's tangents."""
    case = named_case("catenary")
    *_, walk = stations(case, Settings(beam=kind, segments=20))
    surrogate = Surrogate(walk.model, [0])
    surrogate.look(walk.model.pose, walk.model.beam.angles(walk.model.data))
    moments = walk.model.elastic_moments()
    np.testing.assert_allclose(
        surrogate.elastic_moments(), moments, atol=1e-9 * np.abs(moments).max()
    )


@pytest.mark.parametrize("name", ["catenary", "parabola"])
def test_one_evaluation_confirms_it(name):
    """Observed 1.05 and 1.02 a station; 3.6 and 3.4 with the last states carried on alone."""
    counts = []
    for numerics in (Numerics(), Numerics(forecasts=0)):
        spent = []
        for walk in stations(named_case(name), Settings(segments=20), numerics):
            assert walk.doubt is None
            spent.append(walk.model.evaluations)
        counts.append((spent[-1] - spent[4]) / 100)  # the first contact takes more
    assert counts[0] < 1.5 < 3 < counts[1]


def test_a_wrong_forecast_does_no_harm(monkeypatch):
    """With springs half as stiff in the surrogate, MuJoCo's balance decides all the same."""
    case, settings = named_case("parabola"), Settings(segments=20, contour_points=800)
    expected = [walk.row() for walk in stations(case, settings)]
    moments = Surrogate.elastic_moments
    monkeypatch.setattr(Surrogate, "elastic_moments", lambda self: moments(self) / 2)
    found = [walk.row() for walk in stations(case, settings)]
    assert all(row["status"] == "ok" for row in found)
    error = [a["force_y"] - b["force_y"] for a, b in zip(found, expected, strict=True)]
    assert np.abs(error).max() < 1e-6


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
