"""The wheel, installed in an environment of its own, does all that it should elsewhere."""

import json
import os
import re
import subprocess
import sys
import sysconfig
import venv
from itertools import groupby
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
COMMANDS = (
    (0, "list"),
    (2, "inspect mine.toml --float32"),  # MuJoCo Warp is an extra
    (0, "inspect sound-chain --out inspected"),
    (0, "run mine.toml --engine exact --certified --out exact"),
    (0, "run space.toml --out space"),
    (1, "run mine.toml --film --out a"),
    (1, "compare a/analytic.parquet a/mujoco-chain.parquet"),
    (1, "compare a/analytic.parquet exact/analytic.parquet a/mujoco-chain.parquet --out side"),
    (0, "reconstruct a/analytic.parquet space/analytic.parquet --out found"),
    (0, "calibrate a/analytic.parquet mine.toml --fit flexural_rigidity --out a"),
    (0, "rig rig.csv --rig rig.toml --out passes"),
    (1, "report a"),
    (2, "view mine.toml"),  # there is no display
    (1, "run mine.toml --budget --out runs/mine"),
    (0, "study grid.toml --out grid --workers 1"),
    (0, "report grid"),
    (0, "report runs --out page"),
    (0, "verify --out verified"),
    (0, "export mine.toml --error 0.3"),
)
# Those that start processes of their own are started as users do, which takes one process each.
STARTED = ("--budget", "study ")
IN_TURN = """
import contextlib, io, json, sys
from compare.commands.main import main

for words in json.load(sys.stdin):
    said = io.StringIO()
    sys.argv = ["vibrissa", *words]
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            main()
        except SystemExit as ended:
            code = ended.code
    print(json.dumps([code, said.getvalue()]))
"""


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

    def done(*words: str | Path, said: str = "") -> subprocess.CompletedProcess:
        return subprocess.run(
            words, input=said, cwd=tmp_path, env=variables, capture_output=True, text=True,
            check=False,
        )  # fmt: skip

    def vibrissa(*arguments: str) -> tuple[int, str]:
        started = done(environment / "vibrissa", *arguments)
        return started.returncode, started.stdout + started.stderr

    def in_turn(*commands: str) -> list[tuple[int, str]]:
        words = json.dumps([command.split() for command in commands])
        one = done(environment / "python", "-P", "-c", IN_TURN, said=words)
        assert one.returncode == 0, one.stderr
        return [json.loads(line) for line in one.stdout.splitlines()]

    _, page = vibrissa("--help")
    listed = re.findall(r"^  ([a-z][a-z0-9-]+)  ", page, re.M)
    assert set(listed) == {command.split()[0] for _, command in COMMANDS}
    for started, some in groupby(COMMANDS, lambda c: any(word in c[1] for word in STARTED)):
        asked = [*some]
        commands = [command for _, command in asked]
        ends = [vibrissa(*c.split()) for c in commands] if started else in_turn(*commands)
        for (code, command), (ended, said) in zip(asked, ends, strict=True):
            assert ended == code, f"{command}\n{said}"
            assert "Traceback" not in said
    for written in ("runs/mine/report.html", "page/report.html", "grid/report.html"):
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
