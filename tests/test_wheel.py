"""The wheel, installed in an environment of its own, does all that it should elsewhere."""

import os
import re
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SMALL = """
[profile]
kind = "circle"
radius = 1.0
lowest = [0.0, 0.4]
[sweep]
stations = 20
[mujoco]
segments = 10
contour_points = 400
"""
RIG = """
beam = { length = 1.0 }
[columns]
foot_x = { column = "x" }
force_x = { column = "a" }
force_y = { column = "b" }
moment_z = { column = "c" }
"""
STUDY = """
[study]
case = "tip-only"
beams = ["chain"]
[axes]
mujoco.segments = [5, 10]
[sweep]
stations = 12
[mujoco]
contour_points = 400
"""
SPACE = """
[body]
kind = "sphere"
radius = 1
centre = [0, 1.4, 0]
[path]
points = [[1.1, 0.3], [0.2, 0.3]]
stations = 12
"""
# Exit code 1 is a disagreement: these sweeps are as coarse as can be.
COMMANDS = {
    "cases": (0, "cases"),
    "engines": (0, "engines"),
    "float32": (2, "float32 mine.toml"),  # MuJoCo Warp is an extra
    "analytic": (0, "analytic mine.toml --out a --certified"),
    "simulate": (0, "simulate mine.toml --out a"),
    "compare": (1, "compare a/analytic.parquet a/mujoco-chain.parquet"),
    "space": (0, "space space.toml --out space --engine mujoco"),
    "side-by-side": (1, "side-by-side a/analytic.parquet a/mujoco-chain.parquet --out side"),
    "reconstruct": (0, "reconstruct a/analytic.parquet --out a"),
    "calibrate": (0, "calibrate mine.toml a/analytic.parquet --fit clamp_stiffness --out a"),
    "rig": (0, "rig rig.csv --rig rig.toml --out passes"),
    "methods": (0, "methods mine.toml --out methods"),
    "run": (1, "run mine.toml --out runs/mine --budget"),
    "report": (1, "report runs/mine"),
    "budget": (1, "budget mine.toml --out b"),  # undecided: ten segments
    "findings": (0, "findings runs --out found"),
    "inspect": (0, "inspect sound-chain --out inspected"),
    "animate": (0, "animate mine.toml --out anim"),
    "study": (0, "study grid.toml --out grid --workers 1"),
    "study-report": (0, "study-report grid"),
    "view": (2, "view mine.toml"),  # there is no display
}


@pytest.fixture(scope="module")
def environment(tmp_path_factory) -> Path:
    """The wheel and, of the environment of the tests, what others wrote: not the editable tree."""
    folder = tmp_path_factory.mktemp("wheel")
    build = ["-m", "pip", "wheel", "--quiet", "--no-deps", "--no-build-isolation", "-w", folder]
    subprocess.run([sys.executable, *build, ROOT], check=True)
    (wheel,) = folder.glob("*.whl")
    venv.create(folder / "venv", with_pip=False)
    python = folder / "venv" / "bin" / "python"
    (packages,) = (folder / "venv" / "lib").glob("python*/site-packages")
    (packages / "others.pth").write_text(sysconfig.get_path("purelib"))
    into = ["--quiet", "--no-deps", "--prefix", folder / "venv", "--ignore-installed", wheel]
    subprocess.run([python, "-m", "pip", "install", *into], check=True)
    return folder / "venv" / "bin"


@pytest.mark.slow
def test_every_command_runs_elsewhere(environment, tmp_path):
    (tmp_path / "mine.toml").write_text(SMALL)
    (tmp_path / "grid.toml").write_text(STUDY)
    (tmp_path / "space.toml").write_text(SPACE)
    (tmp_path / "rig.toml").write_text(RIG)
    rows = [f"{1 - i / 20},{-i / 40},{i / 20},{i / 30}" for i in range(20)]
    (tmp_path / "rig.csv").write_text("\n".join(["x,a,b,c", *rows]))
    (tmp_path / "compare.py").write_text("raise RuntimeError('the user has a compare.py')")
    hidden = ("PYTHONPATH", "DISPLAY", "WAYLAND_DISPLAY")
    variables = {name: value for name, value in os.environ.items() if name not in hidden}

    def vibrissa(*arguments: str) -> subprocess.CompletedProcess:
        return subprocess.run(
            [environment / "vibrissa", *arguments],
            cwd=tmp_path,
            env=variables,
            capture_output=True,
            text=True,
            check=False,
        )

    listed = re.findall(r"^  ([a-z][a-z0-9-]+)  ", vibrissa("--help").stdout, re.M)
    assert set(listed) == set(COMMANDS)
    for code, command in COMMANDS.values():
        done = vibrissa(*command.split())
        assert done.returncode == code, f"{command}\n{done.stdout}{done.stderr}"
        assert "Traceback" not in done.stderr
    for written in ("runs/mine/report.html", "found/README.md", "grid/report.html"):
        assert (tmp_path / written).exists()


@pytest.mark.slow
def test_the_plugin_and_the_types_come_with_it(environment, tmp_path):
    where = "import analytic, compare, mujoco_models, pytest_vibrissa as p; print(p.__file__)"
    found = subprocess.run(
        [environment / "python", "-P", "-c", where],
        cwd=tmp_path,
        env={name: value for name, value in os.environ.items() if name != "PYTHONPATH"},
        capture_output=True,
        text=True,
        check=True,
    )
    packages = Path(found.stdout.strip()).parent
    assert packages.is_relative_to(environment.parent)
    for package in ("analytic", "mujoco_models", "engines", "compare"):
        assert (packages / package / "py.typed").exists()
        assert (packages / package / "__init__.pyi").exists()
    assert not (packages / "tests").exists()
    assert not list(packages.glob("compare/**/README.md"))
