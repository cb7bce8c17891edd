"""A fault of MuJoCo's that the tests of the split plant, and distributions as pip installs them."""

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


@pytest.fixture
def install(tmp_path, monkeypatch):
    """Put a distribution with entry points on the path."""

    def put(name: str, version: str, points: str = "") -> None:
        about = tmp_path / f"{name.replace('-', '_')}-{version}.dist-info"
        about.mkdir()
        text = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        (about / "METADATA").write_text(text)
        (about / "entry_points.txt").write_text(points)
        monkeypatch.syspath_prepend(tmp_path)

    return put
