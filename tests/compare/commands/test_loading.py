"""What is loaded before help and complaints: they must not wait for what does the work."""

import subprocess
import sys

import pytest

HEAVY = ("matplotlib", "mujoco", "pandas", "pint", "pyarrow", "scipy", "trimesh")
CODE = """
import sys
from compare.commands.main import main
try:
    main()
except SystemExit as end:
    print("ended with", end.code)
print("loaded", *sorted(set(sys.modules) & set({heavy})))
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


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["--help"], 0),
        (["run", "--help"], 0),
        (["list", "studies"], 0),  # the cases that whisk have a first contact, found by scipy
        (["run", "catenry"], 2),
        (["run", "catenary", "--stations", "1"], 2),
        (["run", "CASE"], 2),
        (["study", "STUDY"], 2),
        (["view", "nowhere.toml"], 2),
        (["compare", "catenary", "nowhere.csv"], 2),
        (["reconstruct", "nowhere.parquet"], 2),
        (["inspect", "nowhere.xml"], 2),
        (["report", "nowhere"], 2),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_help_and_complaints_load_nothing_heavy(tmp_path, words, code):
    files = {name: tmp_path / f"{name.lower()}.toml" for name in ("CASE", "STUDY")}
    files["CASE"].write_text(CASE)
    files["STUDY"].write_text(STUDY)
    given = [str(files.get(word, word)) for word in words]
    command = [sys.executable, "-c", CODE.format(heavy=HEAVY), *given]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    *_, ended, loaded = done.stdout.splitlines()
    assert ended == f"ended with {code}", done.stderr
    assert loaded == "loaded"


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
