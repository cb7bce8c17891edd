"""What MuJoCo refuses only while it runs, or a viewer without a display, is a line."""

import mujoco
import pytest

from analytic import InputError, named_case
from mujoco_models import view_sweep
from mujoco_models.quiet import unlogged


def test_what_the_engine_refuses_while_it_runs_is_bad_input():
    ball = '<body pos="0 0 .05"><freejoint/><geom size=".1"/></body>'
    text = f'<mujoco><worldbody><geom type="plane" size="1 1 1"/>{ball}</worldbody></mujoco>'
    model = mujoco.MjModel.from_xml_string(text)
    model.geom_condim[:] = 0  # which no compiler allows, and some flexes have
    refused = r"refused by MuJoCo while it runs.*condim value: 0"
    with pytest.raises(InputError, match=refused), unlogged():
        mujoco.mj_step(model, mujoco.MjData(model))


def test_without_a_display(monkeypatch):
    monkeypatch.setattr("glfw.init", lambda: False)
    with pytest.raises(InputError, match=r"display = none: .*vibrissa run CASE --film") as refused:
        view_sweep(named_case("parabola"))
    assert "\n" not in str(refused.value)
