"""What MuJoCo refuses only while it runs is a line, and not the end of a command."""

import mujoco
import pytest

from analytic import InputError
from mujoco_models.quiet import unlogged


def test_what_the_engine_refuses_while_it_runs_is_bad_input():
    ball = '<body pos="0 0 .05"><freejoint/><geom size=".1"/></body>'
    text = f'<mujoco><worldbody><geom type="plane" size="1 1 1"/>{ball}</worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(text)
    model.geom_condim[:] = 0  # which no compiler allows, and some flexes have
    refused = r"refused by MuJoCo while it runs.*condim value: 0"
    with pytest.raises(InputError, match=refused), unlogged():
        mujoco.mj_step(model, mujoco.MjData(model))
