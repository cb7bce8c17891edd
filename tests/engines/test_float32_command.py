"""``inspect --float32`` where nothing of it can be done."""

import pytest

from tests.compare.command import vibrissa

FLOAT32 = ("inspect", "catenary", "--float32")


@pytest.mark.parametrize("stiffnesses", ["", "1e7,", "many", "1e12", "nan"])
def test_odd_stiffnesses_are_a_line(tmp_path, stiffnesses):
    done = vibrissa(*FLOAT32, "--contact-stiffness", stiffnesses, cwd=tmp_path)
    done.refused("numbers between commas")


def test_a_wrong_version_of_the_extra_is_a_line(tmp_path, install):
    install("mujoco-warp", "1.0")
    vibrissa(*FLOAT32, cwd=tmp_path).refused("mujoco-warp 1.0 is not", "pip install")
