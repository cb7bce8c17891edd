"""The example of the page "Add your engine", installed as pip would, and run."""

import json
import re
import sys
import tomllib

import pytest

from engines import find_engine, list_engines
from tests.compare.command import vibrissa
from tests.documentation.blocks import ROOT

EXAMPLE = ROOT / "docs" / "examples" / "engine"


@pytest.fixture
def installed(tmp_path, install):
    """Its module on the path, and its entry points beside it."""
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    points = project["entry-points"]["vibrissa.engines"]
    lines = ["[vibrissa.engines]", *(f"{name} = {target}" for name, target in points.items())]
    install(project["name"], project["version"], "\n".join(lines))
    (tmp_path / "shooting_engine.py").write_text((EXAMPLE / "shooting_engine.py").read_text())
    yield tmp_path
    sys.modules.pop("shooting_engine", None)


def test_it_is_found(installed):
    (found,) = (one for one in list_engines() if one.name == "shooting")
    project = tomllib.loads((EXAMPLE / "pyproject.toml").read_text())["project"]
    assert (found.engine, found.trouble) == (find_engine("shooting"), None)
    assert found.version == project["version"]  # not SciPy's, which it needs


@pytest.mark.slow
def test_it_is_as_good_as_the_page_says(installed):
    page = (EXAMPLE / "README.md").read_text()
    case = re.search(r"```toml\n(\[profile\].*?)```", page, re.S)
    (installed / "circle.toml").write_text(case[1])
    command = ("run", "circle.toml", "--engine", "shooting,mujoco", "--segments", 20)
    vibrissa(*command, "--out", "out", cwd=installed).ended(0)
    rows = json.loads((installed / "out" / "engines.json").read_text())["engines"]
    assert max(rows[0]["rms"].values()) < 1e-8
    assert abs(rows[0]["snap_off_apart"]) < 1e-6
    assert rows[1]["agrees"]


@pytest.mark.slow
def test_it_refuses_what_it_cannot(installed, tmp_path):
    command = ("run", "catenary", "--stations", 10, "--engine", "shooting")
    vibrissa(*command, cwd=tmp_path).refused("object for shooting")
