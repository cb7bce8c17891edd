"""The viewer where there is no display: one line that says what to do."""

import pytest

from analytic import InputError, named_case
from mujoco_models import view_sweep


def test_without_a_display(monkeypatch):
    monkeypatch.setattr("glfw.init", lambda: False)
    with pytest.raises(InputError, match=r"display = none: .*vibrissa run CASE --film") as refused:
        view_sweep(named_case("parabola"))
    assert "\n" not in str(refused.value)
