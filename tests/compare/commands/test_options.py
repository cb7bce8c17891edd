"""Every option beside every kind of what a command takes: it does something, or it is refused."""

import re
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, get_type_hints

import pandas as pd
import pytest
import typer

from analytic import SENSED, Sweep, solve_sweep
from analytic.space import solve_space
from analytic.space.problem.readings import SENSED_IN_SPACE
from compare import load_case
from compare.commands.calibrate import KNOWN
from compare.commands.compare import ONE, SEVERAL
from compare.commands.inspect import FILE, SINGLE
from compare.commands.main import app
from compare.commands.options import ANY_CASE, For
from compare.commands.reconstruct import SWEEP
from compare.commands.study import COUNTED, HERE, ON_A_CLUSTER
from compare.read.kinds import MODEL, MOTION, PLANE, SPACE
from tests.compare.case_files import BALL
from tests.compare.command import vibrissa

SMALL = """
[beam]
length = 1.0
[profile]
kind = "circle"
radius = 1.0
lowest = [0.0, 0.4]
[sweep]
stations = 12
"""
COARSE = '[mujoco]\nsegments = 6\nobstacle = "primitive"\n'
OWN = """
[beam]
length = 0.1
flexural_rigidity = 6.44e-4
radius = 2.5e-4
[profile]
kind = "circle"
radius = 0.08
lowest = [0.0, 0.04]
[sweep]
stations = 12
[mujoco]
contour_points = 400
[model]
file = "sound-chain"
[motion]
speed = 0.4
"""
SPHERE = f"""
{BALL}[path]
points = [[1.1, 0.3], [0.2, 0.3]]
tangent = [0.1, 1, 0]
stations = 12
[mujoco]
segments = 6
"""
LIMITS = '[tolerances]\nrms = { limit = 1e-9, reason = "to see it fail" }\n'
UNCERTAIN = SMALL + "[uncertainty]\nradius = { standard = 0.01 }\n"
GRID = '[study]\ncase = "catenary"\nbeams = []\n[axes]\nbeam.radius = [0.001, 0.002]\n'

# What a command takes of each kind.
TAKES: dict[str, dict[str, tuple[str, ...]]] = {
    "run": {PLANE: ("plane.toml",), MOTION: ("moving.toml",), MODEL: ("model.toml",),
            SPACE: ("space.toml",)},
    "view": {PLANE: ("plane.toml",), MOTION: ("moving.toml",), MODEL: ("model.toml",),
             SPACE: ("space.toml",)},
    "compare": {ONE: ("rig.csv", "near.csv"), SEVERAL: ("rig.csv", "near.csv", "ours.parquet"),
                SPACE: ("space.toml", "space.csv")},
    "reconstruct": {SWEEP: ("rig.csv",), SPACE: ("space.csv", "--beam", "space.toml")},
    "calibrate": {KNOWN: ("rig.csv", "plane.toml")},
    "inspect": {FILE: ("sound-chain",), MODEL: ("model.toml",),
                SINGLE: ("plane.toml", "--float32")},
    "study": {HERE: ("grid.toml",), COUNTED: ("grid.toml", "--dry-run"),
              ON_A_CLUSTER: ("grid.toml", "--scheduler", "tcp://nowhere.invalid:1")},
}  # fmt: skip
VALUES = {
    "--stations": "9", "--segments": "8", "--beam": "rod", "--obstacle": "mesh", "--speed": "0.5",
    "--timestep": "0.004", "--engine": "exact", "--target": "0.5", "--frames": "5",
    "--frame": "clamp", "--noise": "0.02", "--offset": "0.01", "--direction": "right",
    "--column": "force_x=other", "--reference-column": "force_x=other",
    "--reference-beam": "other.toml", "--tolerances": "limits.toml", "--friction": "0.1",
    "--uncertainty": "uncertain.toml", "--budget": "budget.json", "--method": "kaneko",
    "--fit": "offset", "--foot": "nobody", "--force": "nothing",
    "--torque": "nothing", "--geoms": "nothing", "--site": "nothing", "--workers": "2",
    "--contact-stiffness": "1e5", "--write": "fixed.xml", "--out": "out", "--scheduler": "tcp://nowhere.invalid:1",
}  # fmt: skip
# Where an option needs another start than the rest of its kind.
INSTEAD = {
    ("compare", ONE, "--direction"): ("ours.parquet", "both.csv"),
    ("compare", SEVERAL, "--direction"): ("ours.parquet", "both.csv", "near.csv"),
    ("reconstruct", SWEEP, "--direction"): ("both.csv",),
    ("calibrate", KNOWN, "--direction"): ("both.csv", "plane.toml"),
    ("compare", ONE, "--budget"): ("rig.csv", "near.csv", "--uncertainty", "uncertain.toml"),
    ("run", MOTION, "--motion"): ("plane.toml",),
}
BESIDE = {"--budget": ("--budget",), "--film": ("--film",)}
# What makes another kind of it.
OTHERWISE = {
    PLANE: ("--motion", "--speed", "--timestep"),
    HERE: ("--scheduler",),
}
# Beside MuJoCo's window, MuJoCo Warp and a cluster, which are not here; and where results are as
# they were: in another folder, or sooner.
NOT_SHOWN = {("view", PLANE), ("inspect", SINGLE), ("study", ON_A_CLUSTER)}
UNSEEN = {"--out", "--workers", "--help"}
COMMANDS: Any = typer.main.get_command(app).commands  # typer's own type


def combinations() -> Iterator[tuple[str, str, str, list[For]]]:
    for command, kinds in TAKES.items():
        hints = get_type_hints(COMMANDS[command].callback, include_extras=True)
        for option in COMMANDS[command].params:
            if option.param_type_name == "option":
                marks = getattr(hints.get(option.name), "__metadata__", ())
                uses = [mark for mark in marks if isinstance(mark, For)]
                for kind in kinds:
                    yield command, kind, option.opts[0], uses


ALL = list(combinations())
HELD = [
    (command, kind, option, uses)
    for command, kind, option, uses in ALL
    if not uses or any(kind in use.kinds for use in uses)
]
REFUSED = [one[:3] for one in ALL if one not in HELD and one[2] not in OTHERWISE.get(one[1], ())]
ALONE = [
    (command, kind, option)
    for command, kind, option, uses in HELD
    if uses and all(set(use.beside) & set(BESIDE) for use in uses if kind in use.kinds)
]


@cache
def is_flag(command: str, option: str) -> bool:
    (found,) = (one for one in COMMANDS[command].params if option in one.opts)
    return found.is_flag


def words(command: str, kind: str, option: str) -> tuple[list[str], list[str]]:
    """The command without the option, and the option."""
    start = INSTEAD.get((command, kind, option), TAKES[command][kind])
    value = "other.toml" if option == "--beam" and command not in ("run", "view") else None
    if (command, option) == ("reconstruct", "--fit"):
        value = "sphere" if kind == SPACE else "circle"
    given = [option] if is_flag(command, option) else [option, value or VALUES[option]]
    return [command, *start], given


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("files")
    written = {
        "plane.toml": SMALL + COARSE,
        "moving.toml": SMALL + COARSE + "[motion]\nspeed = 0.4\n",
        "model.toml": OWN,
        "space.toml": SPHERE,
        "limits.toml": LIMITS,
        "uncertain.toml": UNCERTAIN,
        "other.toml": "[beam]\nlength = 1.1\n",
        "grid.toml": GRID,
        "budget.json": "{}",
    }
    for name, text in written.items():
        (folder / name).write_text(text)
    case = load_case(folder / "plane.toml").case
    sweep = solve_sweep(replace(case, sweep=Sweep(60)))
    sweep.write(folder / "ours.parquet")
    sensed = sweep.table[[*SENSED]]
    sensed.assign(other=1.1 * sensed["force_x"]).to_csv(folder / "rig.csv", index=False)
    near = sensed.assign(force_x=1.001 * sensed["force_x"])
    near.assign(other=1.1 * sensed["force_x"]).to_csv(folder / "near.csv", index=False)
    back = 1.01 * sensed[::-1].assign(foot_x=sensed["foot_x"][::-1] / 1.01)
    pd.concat([sensed, back]).to_csv(folder / "both.csv", index=False)
    swept = solve_space(load_case(folder / "space.toml").case).table[[*SENSED_IN_SPACE]]
    swept.assign(other=1.1 * swept["force_x"]).to_csv(folder / "space.csv", index=False)
    return folder


def test_every_kind_and_option_is_tried():
    for command, _, _, uses in ALL:
        assert {kind for use in uses for kind in use.kinds} <= set(TAKES[command])
    for name, command in COMMANDS.items():
        hints = get_type_hints(command.callback, include_extras=True).values()
        marked = [mark for hint in hints for mark in getattr(hint, "__metadata__", ())]
        assert name in TAKES or not any(isinstance(mark, For) for mark in marked)
    assert {option for *_, option in REFUSED} | {option for _, _, option, _ in HELD} <= (
        VALUES.keys() | UNSEEN | {"--beam"} | {o for c, _, o, _ in ALL if is_flag(c, o)}
    )
    assert set(TAKES["run"]) == set(ANY_CASE)


@pytest.mark.parametrize(("command", "kind", "option"), REFUSED)
def test_what_would_be_ignored_is_refused(command, kind, option, files, tmp_path):
    start, given = words(command, kind, option)
    done = vibrissa(*absolute(files, [*start, *given]), cwd=tmp_path)
    assert done.returncode == 2
    assert re.fullmatch(
        rf"vibrissa: ({option} = .*: must be left out but for|CASE = .*: must be) .*\n",
        done.stderr,
    )
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(("command", "kind", "option"), ALONE)
def test_what_needs_another_option_is_refused_without(command, kind, option, files, tmp_path):
    start, given = words(command, kind, option)
    done = vibrissa(*absolute(files, [*start, *given]), cwd=tmp_path)
    assert done.returncode == 2
    assert re.fullmatch(rf"vibrissa: {option} = .*: must be beside --.*\n", done.stderr)


@pytest.fixture
def filmed(undrawn, monkeypatch):
    """A film is a text that says of how many frames it is."""

    def drawn(*given):
        place, frames = given[2], given[-2]
        (place / "animation.gif").write_text(str(frames))

    for module, name in (("plane", "write_animation"), ("space", "write_space_animation")):
        monkeypatch.setattr(f"compare.show.animation.{module}.{name}", drawn)


@pytest.mark.slow
@pytest.mark.usefixtures("filmed", "in_turn")
@pytest.mark.parametrize(
    ("command", "kind", "option", "uses"),
    [one for one in HELD if one[:2] not in NOT_SHOWN and one[2] not in UNSEEN],
)
def test_what_is_not_refused_does_something(command, kind, option, uses, files, alone, tmp_path):
    start, given = words(command, kind, option)
    if option in start:
        pytest.skip("the start has it")
    if command == "view":
        pytest.skip("there is no display")
    needed = [word for use in uses for other in use.beside for word in BESIDE.get(other, ())]
    start += needed
    without = alone(*start)
    having = outcome([*start, *given], files, tmp_path / "having")
    assert "left out but for" not in having[1] and "must be beside" not in having[1]
    assert having != without


@pytest.fixture(scope="module")
def alone(files, tmp_path_factory):
    """What a command does without the option: the same each time."""

    @cache
    def outcomes(*start: str) -> tuple[int, str, dict[str, Any]]:
        folder = tmp_path_factory.mktemp("alone")
        first, again = (outcome([*start], files, folder / name) for name in ("first", "again"))
        assert first == again
        return first

    return outcomes


def absolute(files: Path, given: list[str]) -> list[str]:
    return [str(files / word) if (files / word).exists() else word for word in given]


def outcome(given: list[str], files: Path, folder: Path) -> tuple[int, str, dict[str, Any]]:
    """Exit code, what was said but for times, and what was written but for times."""
    folder.mkdir()
    out = [] if "--dry-run" in given else ["--out", "out"]
    done = vibrissa(*absolute(files, given), *out, cwd=folder)
    said = re.sub(r"[\d.]+ (ms|s)\b|\d+ *│", "", done.stdout) + done.stderr
    if "contacts per s" in said:  # the last column
        said = re.sub(r"[ \d]*$|─", "", said, flags=re.M)
    written: dict[str, Any] = {}
    for path in sorted((folder / "out").rglob("*")):
        if path.suffix == ".parquet":
            table = pd.read_parquet(path)
            timed = [name for name in table if "seconds" in str(name)]
            written[path.name] = table.drop(columns=timed).to_csv()
        elif path.suffix == ".json":
            written[path.name] = re.sub(r'"[^"]*(seconds|date)[^"]*": [^\n]*', "", path.read_text())
        else:
            is_text = path.name in ("points.csv", "animation.gif")
            written[path.name] = path.read_text() if is_text else None
    return done.returncode, said, written
