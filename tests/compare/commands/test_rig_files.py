"""Readings as a rig writes them, read, compared and reconstructed."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic import SENSED, Readings, named_case, solve_sweep
from compare.commands.comparing import turned
from compare.commands.sweeping import RigFiles
from compare.read.case import load_case
from tests.compare.case_files import RIG_COLUMNS, UNITS, as_a_rig
from tests.compare.command import vibrissa

COMPARED = ("compare", "analytic.parquet", "rig.csv", *RIG_COLUMNS)


def test_reconstruction_of_a_rigs_file(tmp_path):
    """Own column names, millimetres and millinewtons, and the vibrissa given by a file."""
    (tmp_path / "case.toml").write_text(UNITS)
    vibrissa("run", "case.toml", "--engine", "exact", "--out", ".", cwd=tmp_path)
    sweep = Readings.read(tmp_path / "analytic.parquet")
    as_a_rig(sweep).to_csv(tmp_path / "rig.csv", index=False)
    done = vibrissa(
        "reconstruct", "rig.csv", "--beam", "case.toml", *RIG_COLUMNS, "--out", "out", cwd=tmp_path
    )
    done.ended(0)
    points = pd.read_csv(tmp_path / "out" / "points.csv")
    np.testing.assert_allclose(points["contact_x"], sweep.values("contact_x"), atol=1e-12)
    assert (tmp_path / "out" / "reconstruction.png").exists()
    for words, said in (
        (["--column", "foot_x"], "NAME=COLUMN"),
        (["--column", "foot_x=stagee"], "stagee"),
        (["--column", "foot_x=stage:parsec s"], "parsec s"),
        (["--beam", "rig.csv"], "rig.csv"),
    ):
        vibrissa("reconstruct", "rig.csv", *words, cwd=tmp_path).refused(said)


@pytest.fixture
def rig(tmp_path) -> Path:
    """A folder with a sweep in SI units and the same from a rig: mm, mN, 2 mm off, 0.3 % noise."""
    (tmp_path / "case.toml").write_text(UNITS.replace("stations = 30", "stations = 120"))
    vibrissa("run", "case.toml", "--engine", "exact", "--out", ".", cwd=tmp_path)
    sweep = Readings.read(tmp_path / "analytic.parquet")
    table = as_a_rig(sweep)
    chance = np.random.default_rng(1).standard_normal(table.shape)
    noise = pd.DataFrame(3e-3 * chance, columns=table.columns) * table.abs().max()
    (table + noise.assign(stage=2.0)).to_csv(tmp_path / "rig.csv", index=False)
    return tmp_path


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_compare_with_a_rig(rig):
    """Own columns, units, an unknown offset, noise; without stating the last two it fails."""
    words = ("compare", "analytic.parquet", "rig.csv", *RIG_COLUMNS, "--out", "out")
    done = vibrissa(*words, "--offset", "auto", "--noise", "0.003", cwd=rig)
    done.ended(0, "offset", "noise")
    found = json.loads((rig / "out" / "comparison.json").read_text())
    assert found["offset"]["value"] == pytest.approx(2e-3, abs=found["offset"]["uncertainty"])
    assert found["offset"]["uncertainty"] < 1e-4
    vibrissa(*words, "--offset", "auto", "--noise", "auto", cwd=rig).ended(0)
    vibrissa(*words, "--offset", "0.002", "--noise", "0.003", cwd=rig).ended(0)
    vibrissa(*words, "--noise", "0.003", cwd=rig).ended(1)
    # The other way round: the rig as the reference, whose vibrissa a file states.
    columns = [word.replace("--column", "--reference-column") for word in RIG_COLUMNS]
    beam = ("--reference-beam", "case.toml")
    words = ("compare", "rig.csv", "analytic.parquet", *columns, *beam, "--out", "back")
    vibrissa(*words, "--offset", "auto", "--noise", "auto", cwd=rig)
    found = json.loads((rig / "back" / "comparison.json").read_text())
    assert found["offset"]["value"] == pytest.approx(-2e-3, abs=2e-4)


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_a_case_is_a_reference_and_its_offset_is_applied(rig):
    """The vibrissa, the limits and the name are the case's."""
    (rig / "own").mkdir()
    (rig / "own" / "analytic.parquet").write_bytes((rig / "analytic.parquet").read_bytes())
    words = ("rig.csv", *RIG_COLUMNS, "--noise", "0.003", "--offset", "auto")
    vibrissa("compare", "case.toml", *words, cwd=rig).ended(0)
    vibrissa("compare", "own/analytic.parquet", *words, cwd=rig)
    names = {path.name for path in (rig / "results").iterdir()}
    assert names == {"case-rig", "own-analytic-rig"}
    found = json.loads((rig / "results" / "case-rig" / "comparison.json").read_text())
    given = ("--beam", "case.toml", *RIG_COLUMNS, "--offset", found["offset"]["value"])
    vibrissa("reconstruct", "rig.csv", *given, "--out", "out", cwd=rig).ended(0)
    points = pd.read_csv(rig / "out" / "points.csv")
    foot_x = Readings.read(rig / "analytic.parquet").values("foot_x")
    np.testing.assert_allclose(points["foot_x"], foot_x, atol=1e-4)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("reconstruct", "rig.csv", *RIG_COLUMNS), "vibrissa = none given"),
        (("compare", "rig.csv", "rig.csv", *RIG_COLUMNS), "--column foot_x="),
        (("compare", "case.toml", "rig.csv", "--reference-beam", "case.toml"), "reference"),
        (("reconstruct", "analytic.parquet", "--offset", "nan"), "offset = nan"),
        ((*COMPARED, "--offset", "some"), "--offset = 'some'"),
        ((*COMPARED, "--noise", "2"), "noise = 2.0"),
        ((*COMPARED, "--tolerances", "case.toml"), "[tolerances]"),
    ],
)
def test_what_is_missing_or_wrong_is_said(rig, words, said):
    vibrissa(*words, cwd=rig).refused(said)
    assert not (rig / "results").exists()


@pytest.mark.parametrize("wrong", ["rows", "foot_x", "moment_z"])
def test_passes_with_the_loads_of_the_other_direction_are_held_against_the_cases(wrong, tmp_path):
    """They were held against a sweep the other way, and said to have two wrong signs."""
    exact = solve_sweep(named_case("parabola"))
    table = exact.table.iloc[::-1] if wrong == "rows" else exact.table.copy()
    if wrong != "rows":
        table[wrong] *= -1
    way = "left" if wrong == "moment_z" else "right"
    known = {**exact.provenance, "direction": way}
    replace(exact, table=table.reset_index(drop=True), provenance=known).write(
        tmp_path / "a.parquet"
    )
    rig = RigFiles((), None, None, "world")
    job = turned(load_case("parabola"), [tmp_path / "a.parquet"], rig)
    assert job.case.sweep.direction == "left"


def test_that_length_and_rigidity_are_one_is_said(tmp_path):
    sweep = solve_sweep(named_case("parabola"))
    sweep.table[list(SENSED)].to_csv(tmp_path / "bare.csv", index=False)
    done = vibrissa("reconstruct", "bare.csv", "--out", "out", cwd=tmp_path).ended(0)
    assert "L = EI = 1 is assumed" in done.stderr
