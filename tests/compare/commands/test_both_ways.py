"""A rig's passes to the left and to the right, with readings that lag behind the stage."""

import json
import shlex
import tomllib

import numpy as np
import pytest

from analytic import Beam, Case, Sweep, circle, solve_sweep
from tests.compare.command import vibrissa

BEAM = Beam(0.1, 1e-4, 2e-4, si=True)
OBJECT = circle(0.02, lowest=(0.005, 0.084))
LAG, SPEED, STATED = 0.3e-3, 0.015, 1.1e-4  # m, m/s, N m^2: the rigidity that the case states
RIG = """
[beam]
length = "100 mm"
flexural_rigidity = "1e-4 N m^2"
radius = "0.2 mm"
[columns]
foot_x = { column = "Weg", unit = "mm" }
force_x = { column = "Kraft X", unit = "mN" }
force_y = { column = "Kraft Y", unit = "mN" }
moment_z = { column = "Moment", unit = "mN mm" }
time = { column = "Zeit", unit = "s" }
[passes]
free_before = "8 mm"
free_after = "8 mm"
"""
CASE = f"""
[beam]
length = "100 mm"
flexural_rigidity = "{STATED} N m^2"
radius = "0.2 mm"
[profile]
kind = "circle"
radius = "20 mm"
lowest = ["5 mm", "84 mm"]
[uncertainty]
flexural_rigidity = {{ standard = "10 %" }}
"""


def written(folder, name, way, rng, rows=500, lag=LAG, free=0.01):
    """A pass as a rig writes it, 1 % of noise and a zero on it."""
    case = Case(BEAM, OBJECT, Sweep(3000, direction=way))
    free = free if way == "left" else -free
    ends = case.foot_x[[0, -1]] + np.array([free, -free])
    dense = solve_sweep(Case(BEAM, OBJECT, Sweep(3000, *ends, direction=way)))
    order = np.argsort(dense.values("foot_x"))
    foot_x = np.linspace(*ends, rows)
    behind = foot_x - np.sign(ends[1] - ends[0]) * lag
    lines = ["Lauf 1; Prüfer K. Müller", "Zeit;Weg;Kraft X;Kraft Y;Moment", "s;mm;mN;mN;mN mm"]
    columns = [np.abs(foot_x - foot_x[0]) / SPEED, 1e3 * foot_x]
    for reading, unit in (("force_x", 1e-3), ("force_y", 1e-3), ("moment_z", 1e-6)):
        exact = np.interp(behind, dense.values("foot_x")[order], dense.values(reading)[order])
        size = np.abs(exact).max()
        columns.append((exact + size * (0.3 + 0.01 * rng.standard_normal(rows))) / unit)
    lines += [";".join(f"{x:.5f}" for x in row) for row in np.transpose(columns)]
    path = folder / "raw" / name
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(lines).replace(".", ","), encoding="cp1252")


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    folder, rng = tmp_path_factory.mktemp("rig"), np.random.default_rng(5)
    for i in range(6):
        written(folder, f"run{i}.csv", ("left", "right")[i % 2], rng)
    (folder / "rig.toml").write_text(RIG)
    (folder / "case.toml").write_text(CASE)
    folder.joinpath("said.txt").write_text(
        vibrissa("rig", "raw", "--rig", "rig.toml", "--out", "passes", cwd=folder).ended(0).stdout
    )
    return folder


@pytest.mark.slow
def test_the_lag_is_found_named_and_taken_off(rig, tmp_path):
    said = (rig / "said.txt").read_text()
    assert "the readings come after the positions: " in said
    assert "ms (95 %" in said
    way = json.loads((rig / "passes" / "passes.json").read_text())["lag"]["way"]
    assert way["lowest"] <= LAG <= way["highest"]
    assert way["lowest"] > LAG / 3
    (line,) = (x.split("lag = ")[1] for x in said.splitlines() if "under [passes]: lag = " in x)
    (tmp_path / "rig.toml").write_text(f"{RIG}lag = {line}\n")
    again = vibrissa("rig", rig / "raw", "--rig", "rig.toml", "--out", "again", cwd=tmp_path)
    again.ended(0, "no lag of the readings shows")


@pytest.mark.slow
def test_a_calibration_finds_the_lag_and_writes_the_case(rig, tmp_path):
    words = ("calibrate", rig / "passes", rig / "case.toml")
    without = vibrissa(*words, "--out", "without", cwd=tmp_path)
    without.ended(1, "the readings come after the positions", "fit lag too")
    done = vibrissa(*words, "--fit", "flexural_rigidity,lag", "--out", "found", cwd=tmp_path)
    done.ended(0, "Next: vibrissa compare found/case.toml", "reconstruct FILE... --beam found/case")
    (said,) = (line for line in done.stdout.splitlines() if line.startswith("Next: vibrissa "))
    vibrissa(*shlex.split(said)[2:], cwd=tmp_path).ended(0, "agrees")
    found = json.loads((tmp_path / "found" / "calibration.json").read_text())["found"]
    for name, true in (("flexural_rigidity", 1e-4), ("lag", LAG)):
        assert found[name]["lowest"] <= true <= found[name]["highest"], name
    case = tomllib.loads((tmp_path / "found" / "case.toml").read_text())
    value = float(case["beam"]["flexural_rigidity"].split()[0])
    assert value == pytest.approx(found["flexural_rigidity"]["value"], rel=1e-8)
    assert case["profile"] == tomllib.loads(CASE)["profile"]
    width = found["flexural_rigidity"]["highest"] - found["flexural_rigidity"]["lowest"]
    standard, unit = case["uncertainty"]["flexural_rigidity"]["standard"].split(maxsplit=1)
    assert (float(standard), unit) == (pytest.approx(width / 2 / 1.96, rel=1e-4), "N m^2")
    (tmp_path / "found" / "case.toml").write_text("# my own\n")
    vibrissa(*words, "--out", "found", cwd=tmp_path).refused("must be free, or from an earlier run")


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_passes_of_one_direction(rig, tmp_path):
    """A case to the left is swept as the passes were; each command takes those asked for."""
    (tmp_path / "case.toml").write_text(CASE.replace(str(STATED), "1e-4"))
    compare = ("compare", "case.toml", rig / "passes")
    vibrissa(*compare, cwd=tmp_path).refused("--direction left, then --direction right")
    offsets = {}
    for way in ("left", "right"):
        words = ("--direction", way, "--offset", "auto", "--noise", "auto", "--out", way)
        done = vibrissa(*compare, *words, cwd=tmp_path)
        assert done.returncode in (0, 1), done.stderr
        found = json.loads((tmp_path / way / "comparison.json").read_text())
        offsets[way] = found["offset"]["value"]
        again = ("reconstruct", rig / "passes", "--direction", way, "--out", "points")
        assert vibrissa(*again, cwd=tmp_path).stdout.count("contact points from") == 3
    assert (offsets["right"] - offsets["left"]) / 2 == pytest.approx(LAG, rel=0.2)
    other = (tmp_path / "one", tmp_path / "case.toml")
    vibrissa("rig", rig / "raw" / "run0.csv", "--rig", rig / "rig.toml", "--out", other[0],
             cwd=tmp_path)  # fmt: skip
    done = vibrissa("reconstruct", other[0], "--direction", "right", cwd=tmp_path)
    done.refused("--direction = right")


@pytest.mark.slow
def test_an_object_is_fitted_beside_the_lag(rig, tmp_path):
    done = vibrissa("reconstruct", rig / "passes", "--fit", "circle", "--out", "o", cwd=tmp_path)
    done.ended(0, "the readings come after the positions")
    found = json.loads((tmp_path / "o" / "object.json").read_text())["found"]
    for name, true in (("radius", 0.02), ("centre_x", 0.005), ("centre_y", 0.104), ("lag", LAG)):
        assert found[name]["lowest"] <= true <= found[name]["highest"], name


@pytest.mark.slow
def test_a_vibrissa_that_two_files_state_differently_is_one_short_line(rig, tmp_path):
    words = ("compare", rig / "case.toml", rig / "passes", "--direction", "left")
    done = vibrissa(*words, cwd=tmp_path)
    done.refused("of length 0.1 and EI 0.00011, and of 0.1 and 0.0001", "--beam FILE")
    assert "Beam(" not in done.stderr
