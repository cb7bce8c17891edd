"""Parts of MuJoCo's pipeline that a balance at rest needs, against the whole of it."""

import mujoco
import numpy as np
import pytest

from analytic import named_case
from mujoco_models import Settings, available_beams
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
    return model, float(foot_x), angles


@pytest.mark.parametrize("turn", [0.0, 1e-6])
def test_the_balance_is_that_of_mujocos_inverse_dynamics(resting, turn):
    """Without accelerations; `mj_inverse` says what else would have to act."""
    model, foot_x, angles = resting
    found = model.imbalance(foot_x, angles - turn)
    moments, sensed = model.moments().copy(), model.data.sensordata.copy()
    assert (turn > 0) == (np.abs(found).max() > 1e-3)  # not a comparison of zeros
    model.data.qacc[:] = 0
    mujoco.mj_inverse(model.model, model.data)
    scale = np.abs(model.elastic_moments()).max() + np.abs(found).max()
    np.testing.assert_allclose(-model.data.qfrc_inverse, moments, atol=1e-13 * scale)
    np.testing.assert_allclose(model.data.sensordata, sensed, atol=1e-12 * np.abs(sensed).max())


def test_what_is_relieved_is_what_mujocos_forward_dynamics_leaves(resting):
    model, foot_x, angles = resting
    static = np.abs(model.imbalance(foot_x, angles - 1e-12)).max()
    found, sensed = model.relieved().copy(), model.data.sensordata.copy()
    assert np.abs(found).max() < static
    mujoco.mj_forward(model.model, model.data)
    np.testing.assert_allclose(model.beam.moments(model.moments()), found, atol=1e-12)
    np.testing.assert_allclose(model.data.sensordata, sensed, atol=1e-11)
