"""Parts of MuJoCo's pipeline that a balance at rest needs, against the whole of it."""

import mujoco
import numpy as np
import pytest

from analytic import named_case
from mujoco_models import Settings, available_beams
from mujoco_models.model.model import ROUNDING
from mujoco_models.sweep.sweep import set_out


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
