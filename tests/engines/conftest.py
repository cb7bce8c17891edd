"""A fault of MuJoCo's that the tests of the split plant."""

import pytest

from mujoco_models.beams.chain import Chain


@pytest.fixture
def stiffer(monkeypatch):
    """Make a joint of MuJoCo's chain two percent too stiff."""
    make = Chain.spec

    def plant(joint: int) -> None:
        def spec(self, radius, furnish):
            made = make(self, radius, furnish)
            made.joints[joint].stiffness[0] *= 1.02
            return made

        monkeypatch.setattr(Chain, "spec", spec)

    return plant
