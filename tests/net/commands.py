"""What only the command line makes, budgets and studies, by the commands that a checkout has."""

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import analytic
from compare.study import read_rows

CHECKOUT = Path(str(analytic.__file__)).parents[1]


def call(*words: str) -> str:
    """`vibrissa` of this checkout; a disagreement is a result."""
    project = tomllib.loads((CHECKOUT / "pyproject.toml").read_text())["project"]
    module, _, function = project["scripts"]["vibrissa"].partition(":")
    code = f"from {module} import {function}; {function}()"
    environment = os.environ | {"PYTHONPATH": str(CHECKOUT)}
    command = [sys.executable, "-c", code, *words]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode not in (0, 1):
        raise RuntimeError(done.stderr.strip())
    return done.stdout


def split(case: str, *options: str) -> dict[str, Any]:
    """Both models, compared and split into parts: what the folder's JSON files hold."""
    if "[" in case:
        Path("case.toml").write_text(case)
        case = "case.toml"
    call("run", case, "--budget", "--out", "out", *options)
    return {path.stem: json.loads(path.read_text()) for path in Path("out").glob("*.json")}


def study(text: str) -> Any:
    """The rows of a study, in the order of its axes."""
    Path("small.toml").write_text(text)
    call("study", "small.toml", "--out", "out", "--workers", "1")
    rows = read_rows(Path("out"), print)
    return rows.sort_values([name for name in rows.columns if "." in name])


EGG = """
[body]
kind = "ellipsoid"
semi_axes = [1.0, 0.7, 1.6]
centre = [0.0, 1.1, 0.0]
[path]
points = [[1.5, 0.3], [-1.5, -0.1]]
tangent = [0.1, 1, 0.05]
stations = 20
[mujoco]
segments = 10
"""
POLYGON = """
profile = { kind = "polygon", points = [[-1, 1.2], [-0.5, 0.6], [0.1, 0.4], [0.7, 0.7], [1, 1.3]] }
mujoco = { segments = 10 }
"""
GRID = """
study = { case = "catenary", beams = ["chain"] }
axes = { mujoco.segments = [10, 20], beam.radius = [0.003, 0.008] }
noise = { relative = 1e-3, seed = 3 }
sweep = { stations = 40 }
mujoco = { contour_points = 400 }
"""
METHODS = """
study = { case = "parabola", beams = [], record = ["reconstruction"] }
axes = { noise.relative = [1e-4, 1e-2], reconstruction.method = ["beam-column", "elastica"] }
sweep = { stations = 40 }
"""
OBLIQUE = """
study = { beams = ["chain"] }
axes = { path.tangent.x = [-0.1, 0.1], path.turn = [0, 10] }
"""
SMALL = ("--stations", "30", "--segments", "10")
BUDGETS = (
    ("mesh", "parabola", SMALL),
    ("rod", "catenary", ("--beam", "rod", *SMALL)),
    ("primitive", "two-circles", ("--obstacle", "primitive", *SMALL)),
    ("curved", "pre-curved", SMALL),
    ("polygon", POLYGON, SMALL[:2]),
    ("motion", "tip-only", ("--speed", "0.5", *SMALL)),
    ("space", EGG, ()),
)
STUDIES = (("plane", GRID), ("methods", METHODS), ("space", OBLIQUE + EGG))
