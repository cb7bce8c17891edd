"""At rest only springs and contacts count: nothing of the way there, nor of MuJoCo's steps."""

from dataclasses import replace
from functools import cache
from itertools import pairwise

import mujoco
import numpy as np
import pytest

from analytic import CLAMP_READINGS, named_case
from mujoco_models import Settings, available_beams, simulate_sweep
from mujoco_models.model.model import ROUNDING
from mujoco_models.sweep.numerics import Numerics
from mujoco_models.sweep.sweep import run_sweep, set_out
from tests.conftest import simulated_sweep


def changed(quantity, factor):
    """`add_options`, with the time step, all masses or all armatures changed by a factor."""
    from mujoco_models.model import spec as specs

    usual = specs.add_options

    def add_options(spec):
        usual(spec)
        if quantity == "time step":
            spec.option.timestep *= factor
        elif quantity == "mass":
            for geom in spec.geoms:
                geom.mass *= factor
        else:
            for joint in spec.joints:
                joint.armature *= factor

    return add_options


@pytest.fixture
def usual(request):
    return swept(request.param)


@cache  # a fixture of the module would be made again for each constant
def swept(beam):
    case = named_case("parabola")
    case = replace(case, sweep=replace(case.sweep, stations=25))
    settings = Settings(beam=beam, segments=20)
    return case, settings, simulate_sweep(case, settings)


def assert_same(found, expected, settings, end):
    """All at rest, in the same states: out of balance by the tolerance, with levers of order L."""
    assert (found.table["status"] == "ok").all()
    for name in CLAMP_READINGS:
        scale = 1 + np.abs(expected.values(name)).max()
        error = np.abs(found.values(name) - expected.values(name))
        assert error.max() < 10 * settings.tolerance * scale, name
    assert abs(found.snap_off - expected.snap_off) < end


@pytest.mark.slow
@pytest.mark.parametrize("usual", available_beams(), indirect=True)
@pytest.mark.parametrize("factor", [0.1, 10])
@pytest.mark.parametrize("quantity", ["time step", "mass", "armature"])
def test_readings_do_not_depend_on(quantity, factor, usual, monkeypatch):
    case, settings, expected = usual
    monkeypatch.setattr("mujoco_models.model.spec.add_options", changed(quantity, factor))
    found = simulate_sweep(case, settings)
    assert_same(found, expected, settings, 2e-5)  # two of the smallest steps


VARIED = {
    "stiffening_of_facets": (1e2, 1e5),
    "nearly": (1e2, 1e4),
    "forecasts": (0, 10),
    "foreseen": (1e-8, 1e-4),
    "largest_turn": (0.1, 0.5),
    "smallest_step": (1e-6, 3e-5),
    "same_normal": (1e-10, 1e-7),
    "ahead": (3, 8),
    "margin": (1, 3),
    "branch_turn": (0.1, 0.7),
    "largest_shift": (0.3, 2.0),
    "confirm_step": (3e-5, 1e-3),
    "reach": (8, 32),
    "gentle_turn": (1e-3, 2e-2),
    "inertia": (10.0, 1000.0),
    "descent_steps": (200, 2000),
    "unloaded_steps": (5, 50),
    "fallen": (1e-11, 1e-9),
    "load_held": (1e-3, 0.1),
}
FAST = ("stiffening_of_facets", "forecasts")


# Either side of every constant, and every constant with every beam.
@pytest.mark.parametrize(
    ("usual", "constant", "side"),
    [
        pytest.param(name, constant, side, marks=() if constant in FAST else pytest.mark.slow)
        for beam, name in enumerate(available_beams())
        for i, constant in enumerate(VARIED)
        for side in (0, 1)
        if (i + beam + side) % 2 == 0
    ],
    indirect=["usual"],
)
def test_no_constant_of_the_way_shows(usual, constant, side):
    """Each constant varied on either side: the same states at rest, the same snap-off."""
    case, settings, expected = usual
    varied = replace(Numerics(), **{constant: VARIED[constant][side]})
    found = run_sweep(case, settings, numerics=varied)
    # Observed: 6e-5 by the stiffening, 1.3e-5 by the smallest step, 0 by all others.
    assert_same(found, expected, settings, 1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("stiffening", [1e3, 1e4, 1e6])
def test_how_convex_the_step_is_past_a_smooth_contour_does_not_show(stiffening):
    """Short of the fold the model of 1e3 is not convex; all come to rest in the same states."""
    case, settings = named_case("parabola"), Settings(obstacle="primitive")
    expected = simulated_sweep("parabola", settings)
    found = run_sweep(case, settings, numerics=Numerics(stiffening=stiffening))
    assert_same(found, expected, settings, 1e-4)  # observed 4e-5


@pytest.mark.parametrize("contact_stiffness", [1e4, 1e5, 1e7])
def test_newtons_method_is_quadratic_however_soft_the_contact(contact_stiffness):
    """Of a soft contact, too, all of the force is that of the next depth, not of the last one."""
    settings = Settings(segments=20, contact_stiffness=contact_stiffness)
    walk = set_out(named_case("catenary"), settings, Numerics(forecasts=0))
    model, found = walk.model, []
    imbalance = model.imbalance

    def noted(pose, angles):
        moments = imbalance(pose, angles)
        found.append(np.abs(moments).max())
        return moments

    model.imbalance = noted
    ratios = []
    for foot_x in named_case("catenary").foot_x[20:120]:
        found.clear()
        walk.go_to(float(foot_x))
        # Once it is that near, a step is short against what turns about it; 1e-10 is rounding.
        ratios += [b / a for a, b in pairwise(found) if 1e-7 < a < 1e-4]
        # Forces next to rest are those of the depths: what is left is the last step's.
        depth = np.minimum(model.contacts().distance, 0).sum()
        assert walk._state.load == pytest.approx(-contact_stiffness * depth, rel=1e-3, abs=1e-3)
    assert len(ratios) > 15
    # With the old force instead it is 1e3 / contact_stiffness: 0.1 with the softest.
    assert np.median(ratios) < 1e-3


@pytest.fixture(scope="module", params=available_beams())
def resting(request):
    """A model at rest in contact, its state, and the joint angles that it then has."""
    case = named_case("catenary")
    walk = set_out(case, Settings(beam=request.param, segments=20))
    for foot_x in case.foot_x[20:90:5]:
        walk.go_to(float(foot_x))
    model = walk.model
    angles = model.beam.angles(model.data)
    assert walk.doubt is None
    assert model.contacts().loaded.any()
    return model, model.pose, angles


@pytest.mark.parametrize("turn", [0.0, 1e-6])
def test_the_balance_is_that_of_mujocos_inverse_dynamics(resting, turn):
    """Without accelerations; `mj_inverse` says what else would have to act."""
    model, pose, angles = resting
    found = model.imbalance(pose, angles - turn)
    moments, sensed = model.moments().copy(), model.data.sensordata.copy()
    assert (turn > 0) == (np.abs(found).max() > 1e-3)  # not a comparison of zeros
    model.data.qacc[:] = 0
    mujoco.mj_inverse(model.model, model.data)
    scale = np.abs(model.elastic_moments()).max() + np.abs(found).max()
    np.testing.assert_allclose(-model.data.qfrc_inverse, moments, atol=1e-13 * scale)
    np.testing.assert_allclose(model.data.sensordata, sensed, atol=1e-12 * np.abs(sensed).max())


def test_what_is_relieved_is_rounding_of_depths_and_no_more(resting):
    """What turns by rounding make of depths is relieved; of a thousand times as much, that part."""
    model, pose, angles = resting
    most = model.contact_stiffness * ROUNDING
    for turn, hidden in (1e-14, True), (1e-11, False):
        model.imbalance(pose, angles - turn)
        static = model.moments()
        pressed, sensed = model.data.efc_force.copy(), model.data.sensordata.copy()
        found = model.relieved()
        assert (np.abs(found).max() < 1e-8) == hidden
        loaded = model.data.efc_force > 0
        assert (loaded == (pressed > 0)).all()
        given = model.data.efc_force - pressed
        assert np.abs(given).max() <= most * (1 + 1e-9) + 1e-15 * pressed.max()
        pulled = given @ model.data.efc_J.reshape(len(given), -1)
        np.testing.assert_allclose(model.moments(), static + pulled, atol=1e-12)
        # The clamp's forces are those of the relieved contacts.
        assert 0 < np.abs(model.data.sensordata - sensed)[:2].max() <= most * loaded.sum()
        assert model.discrepancy() < 1e-8 + len(angles) * np.abs(found).max()


def test_mujocos_forward_dynamics_relieves_the_same(resting):
    """It lets contacts give way to accelerations: what is out of balance at rest is no more."""
    model, pose, angles = resting
    model.imbalance(pose, angles - 1e-14)
    static = np.abs(model.moments()).max()
    mujoco.mj_forward(model.model, model.data)
    assert np.abs(model.moments()).max() < static
    forces = model.data.sensordata.copy()
    model.imbalance(pose, angles - 1e-14)
    model.relieved()
    np.testing.assert_allclose(model.data.sensordata, forces, atol=static)
