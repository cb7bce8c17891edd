"""The worked example of a rig's files: every planted flaw is found, and the truth behind them."""

import json
import re
import runpy
import shutil
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic import CLAMP_READINGS, InputError
from compare.read.passes import look_at_passes, usable
from compare.read.rig_file import read_rig
from tests.compare.command import vibrissa
from tests.documentation.blocks import ROOT, blocks

PAGE = Path("docs/examples/rig/README.md")
EXAMPLE = ROOT / PAGE.parent
MADE = runpy.run_path(str(EXAMPLE / "make_data.py"))


@pytest.fixture(scope="module")
def passes():
    return usable(look_at_passes([EXAMPLE / "data"], read_rig(EXAMPLE / "rig.toml")))


@pytest.fixture
def folder(tmp_path):
    return shutil.copytree(EXAMPLE, tmp_path / "rig")


def test_the_data_are_what_the_program_makes(tmp_path):
    MADE["write"](tmp_path)
    for name in MADE["FILES"]:
        assert (tmp_path / name).read_text() == (EXAMPLE / "data" / name).read_text()


def test_every_flaw_is_counted(passes):
    assert [one.name for one in passes] == ["monday-1", "monday-2", "tuesday-1", "tuesday-2"]
    for one in passes:
        assert {name: n for name, n in one.dropped.items() if n} == MADE["PLANTED"]
        assert one.sorted == MADE["SWAPPED"]
        assert one.record.gaps >= 1
        assert one.direction == "left"
        assert one.kept == one.rows - sum(MADE["PLANTED"].values())


def test_zero_and_drift_are_those_planted(passes):
    for one in passes:
        for column, name in MADE["READINGS"].items():
            gain, scale = MADE["GAINS"][column], MADE["SCALES"][column]
            largest = np.nanmax(np.abs(one.readings.values(name)))
            zero = gain * scale * MADE["ZEROS"][column]
            assert one.zero[name] == pytest.approx(zero, abs=5e-3 * largest)
            # Between the middles of the two stretches, 95 % of the way.
            assert one.drift[name] / largest == pytest.approx(MADE["DRIFTS"][column], abs=4e-3)


def test_what_is_left_is_the_truth_and_noise(passes):
    exact = MADE["solve_sweep"](MADE["Case"](MADE["VIBRISSA"], MADE["OBJECT"], MADE["Sweep"](4000)))
    order = slice(None, None, -1)
    for one in passes[::2]:  # the others have the stage's play
        table = one.readings.table[one.readings.trusted]
        inside = (table["foot_x"] < 0.03) & (table["foot_x"] > -0.05)
        for name in CLAMP_READINGS:
            known = np.interp(
                table["foot_x"], exact.values("foot_x")[order], exact.values(name)[order]
            )
            off = (table[name] - known)[inside] / np.abs(known).max()
            assert np.sqrt(np.mean(off**2)) < 2 * MADE["NOISE"]


@pytest.mark.slow
def test_the_commands_of_the_page(folder):
    commands = [
        line for block in blocks(PAGE) if block.language == "sh" for line in block.text.splitlines()
    ]
    assert len(commands) == 4
    done = [vibrissa(*command.split()[1:], cwd=folder) for command in commands]
    assert [one.returncode for one in done] == [0, 1, 0, 1], [one.stderr for one in done]
    found = json.loads((folder / "passes" / "passes.json").read_text())
    (repeated,) = found["repeats"]
    late = np.array([name.endswith("-2") for name in repeated["passes"]])
    shift = np.array(repeated["shift"])
    planted = MADE["LAG"] * (late - late.mean())
    np.testing.assert_allclose(
        shift - shift.mean(), planted, atol=2 * max(repeated["shift_uncertainty"])
    )
    assert np.max(repeated["rms_without_shift"]) < 4e-3
    assert "4 passes do not say the same" in done[0].stdout
    assert "4 passes" in done[1].stdout
    calibrated = json.loads((folder / "vibrissa" / "calibration.json").read_text())
    rigidity = calibrated["found"]["flexural_rigidity"]["value"]
    assert rigidity == pytest.approx(2e-6, rel=5e-3)
    assert calibrated["passes"]["degrees"] == 6
    assert "not resolved" in done[2].stdout
    fitted = json.loads((folder / "contour" / "object.json").read_text())
    assert fitted["family"] == "circle"
    known = {"radius": 0.04, "centre_x": MADE["LAG"] / 2, "centre_y": 0.06}
    for name, true in known.items():
        assert fitted["found"][name]["value"] == pytest.approx(true, abs=1e-5)
    assert fitted["probability"] < 0.01
    points = pd.read_csv(folder / "contour" / "points.csv")
    x, y = points["contact_x"], points["contact_y"]
    off = np.abs(np.hypot(x, y - 0.06) - 0.04).dropna()
    assert len(off) > 1000
    assert np.median(off) < 0.05e-3


def flawed(folder, old, new, name="rig.toml"):
    path = folder / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ('column = "stage", unit = "mm"', 'column = "stage"', "without a unit"),
        ('unit = "mN mm"', 'unit = "mm"', r"columns\.moment_z\.unit = 'mm': must be a unit of N m"),
        ('"Fx", unit = "mN"', '"Fx", unit = "g"', r"line \d+: columns\.force_x\.unit .* gf$"),
        (
            "[passes]",
            'time = { column = "Fx", unit = "mm" }\n[passes]',
            r"columns\.time\.unit .* unit of s",
        ),
        ('column = "Fx"', 'column = "F_x"', "column 'F_x' of .*missing"),
        ("gain = 1.02", "gain = 1e200", r"force_x of the pass .*less than 1e\+40"),
        ("gain = 1.02", "gian = 1.02", "did you mean gain"),
        ('free_after = "5 mm"', 'free_after = "0.01 mm"', "5 or more"),
        ('missing = ["OVL"]', "missing = []", "column Fx, line .*'OVL'"),
    ],
)
def test_a_description_that_cannot_be_is_one_line(folder, old, new, why):
    flawed(folder, old, new)
    with pytest.raises(InputError, match=why) as found:
        usable(look_at_passes([folder / "data"], read_rig(folder / "rig.toml")))
    assert "\n" not in str(found.value)


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        (r"^(\d;.*;)[^;]*$", r"\1", "moment_z of tuesday-1 = without any number"),
        ("mN;mN;mN mm", "N;N;N mm", r"column 'Mz' of .*tuesday\.csv = in mN mm: must be in N mm"),
    ],
)
def test_a_file_that_is_not_as_the_others_is_named(folder, old, new, why):
    file = folder / "data" / "tuesday.csv"
    text = re.sub(old, new, file.read_text(encoding="utf-8"), flags=re.MULTILINE)
    file.write_text(text, encoding="utf-8")
    vibrissa("rig", "data", "--rig", "rig.toml", cwd=folder).refused()
    with pytest.raises(InputError, match=why):
        look_at_passes([folder / "data"], read_rig(folder / "rig.toml"))


def test_a_folder_without_files(folder):
    shutil.rmtree(folder / "data")
    (folder / "data").mkdir()
    done = vibrissa("rig", "data", "--rig", "rig.toml", cwd=folder)
    done.refused("a folder with files")
    assert not (folder / "results").exists()
