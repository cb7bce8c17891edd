"""What is loaded before help and complaints: they must not wait for what does the work."""

import json
import os
import subprocess
import sys

import pytest

HEAVY = ("matplotlib", "mujoco", "pandas", "pint", "pyarrow", "scipy", "trimesh")
# Each command in a process of its own, that has imported no more than the command line.
CODE = """
import contextlib, io, json, os, sys
from compare.commands.main import main
for words in json.loads(sys.argv[1]):
    if os.fork():
        os.wait()
        continue
    sys.argv = ["vibrissa", *words]
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            main()
    except SystemExit as end:
        print(end.code, *sorted(set(sys.modules) & {*json.loads(os.environ["HEAVY"])}), flush=True)
    os._exit(0)
"""
CASE = """
[beam]
length = -1.0
[profile]
kind = "circle"
radius = 1.0
lowest = [0.0, 0.4]
"""
STUDY = """
[study]
case = "catenary"
[axes]
profile.a = "wide"
"""


COMMANDS = {
    "--help": 0,
    "run --help": 0,
    "list studies": 0,  # the cases that whisk have a first contact, found by scipy
    "run catenry": 2,
    "run catenary --stations 1": 2,
    "run case.toml": 2,
    "study study.toml": 2,
    "view nowhere.toml": 2,
    "compare catenary nowhere.csv": 2,
    "reconstruct nowhere.parquet": 2,
    "inspect nowhere.xml": 2,
    "report nowhere": 2,
}


def test_help_and_complaints_load_nothing_heavy(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    (tmp_path / "study.toml").write_text(STUDY)
    given = json.dumps([command.split() for command in COMMANDS])
    done = subprocess.run(
        [sys.executable, "-c", CODE, given],
        cwd=tmp_path, env={**os.environ, "HEAVY": json.dumps(HEAVY)}, capture_output=True,
        text=True, check=True,
    )  # fmt: skip
    assert dict(zip(COMMANDS, done.stdout.splitlines(), strict=True)) == {
        command: str(code) for command, code in COMMANDS.items()
    }, done.stderr


SWEEP = """
import pickle, sys
from analytic import Case, Sweep, circle
from mujoco_models import Settings, simulate_sweep
case = Case(profile=circle(1.0, (0.0, 0.4)), sweep=Sweep(40))
found = simulate_sweep(case, Settings(segments=10))
assert found.snap_off is not None
sent = pickle.dumps(found)
print("loaded", *sorted(set(sys.modules) & {"pandas", "pyarrow"}))
assert pickle.loads(sent).table.equals(found.table)
"""


@pytest.mark.slow
def test_workers_sweep_without_what_tables_take():
    done = subprocess.run([sys.executable, "-c", SWEEP], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["loaded"], done.stderr
