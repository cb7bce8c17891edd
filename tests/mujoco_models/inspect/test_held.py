"""A vibrissa whose foot is held, is loaded and put back to rest."""

import numpy as np
import pytest

from mujoco_models import available_beams
from mujoco_models.inspect.load import load
from mujoco_models.inspect.measure import hold
from mujoco_models.inspect.parts import Names, find
from tests.mujoco_models.inspect.chains import Chain
from tests.mujoco_models.inspect.rods import Rod

LOAD = np.array([0.5, 0.0, 0.0])  # EI/L^2: a sixth of a length at the tip


def held(planted, folder):
    model = load(planted.write(folder), None)
    return hold(model, find(model, Names()))


def test_a_chain_is_at_rest_to_rounding(tmp_path):
    """Sensors are probed by loads so small that what is left out of balance would show."""
    chain = held(Chain(curvature=0.5), tmp_path)
    for force in (0 * LOAD, LOAD, 0.3 * LOAD):
        chain.load(force, np.zeros(3))
        chain.rest()
        assert np.abs(chain.evaluate()).max() < 1e-12  # EI/L


@pytest.mark.skipif("rod" not in available_beams(), reason="a rod bends since MuJoCo 4")
def test_a_rod_that_is_unloaded_is_where_it_was_at_rest(tmp_path):
    """Not where it was drawn: here gravity bends it."""
    rod = held(Rod(length=1.0, rigidity=1.0, radius=0.005), tmp_path)
    drawn = rod.tip
    rod.model.opt.gravity[0] = 1e3
    rod.unload()
    sagged = rod.tip
    assert np.linalg.norm(sagged - drawn) > 1e-3
    rod.load(LOAD, np.zeros(3))
    rod.rest()
    rod.unload()
    np.testing.assert_array_equal(rod.tip, sagged)
