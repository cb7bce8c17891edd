"""Comparisons in space: their verdicts, and the command with its exit codes."""

import json
from dataclasses import replace

import numpy as np
import pytest

from analytic import Beam, InputError
from analytic.space import FootPath, SpatialCase, SpatialReadings, solve_space, sphere
from compare.spatial.comparison import SpatialTolerances, compare_space
from compare.spatial.parts import split
from mujoco_models import SpatialSettings, simulate_space
from tests.compare.command import vibrissa

CASE = SpatialCase(
    body=sphere(1.0, (0.0, 1.4, 0.0)), path=FootPath([[1.1, 0.3], [0.2, 0.3]], stations=20)
)


def changed(readings, **columns):
    table = readings.table.assign(**columns)
    return SpatialReadings(table, readings.beam, readings.tangent, "other", readings.provenance)


def test_a_sweep_agrees_with_itself_and_json_holds_it():
    exact = solve_space(CASE)
    found = compare_space(exact, exact)
    assert found.agrees
    assert found.contact_max == 0
    assert found.phases == 1
    assert json.loads(json.dumps(found.to_dict()))["verdict"] == "agrees"


def test_planted_differences_are_found_by_name():
    exact = solve_space(CASE)
    softer = solve_space(replace(CASE, beam=Beam(flexural_rigidity=0.98)))
    found = compare_space(exact, softer)
    assert not found.agrees
    assert max(one.max for one in found.apart.values()) == pytest.approx(0.02, rel=0.02)
    turned = changed(exact, force_z=-exact.values("force_z"))
    assert [line.split(":")[0] for line in compare_space(exact, turned).failures] == ["force_z"]
    lost = exact.table["status"].mask(exact.touching, "unsettled")
    assert any(
        "both touch" in line for line in compare_space(exact, changed(exact, status=lost)).failures
    )


def test_other_stations_and_limits_that_cannot_be_are_refused_in_one_line():
    exact = solve_space(CASE)
    moved = changed(exact, foot_x=exact.values("foot_x") + 0.1)
    with pytest.raises(InputError, match="the same foot positions"):
        compare_space(exact, moved)
    with pytest.raises(InputError, match=r"tolerances\.rms"):
        SpatialTolerances(rms=-1.0)


@pytest.mark.slow
def test_the_parts_are_mostly_the_discretisation():
    exact, settings = solve_space(CASE), SpatialSettings(segments=10)
    base = simulate_space(CASE, settings)
    parts = split(exact, base, settings, lambda chosen: simulate_space(CASE, chosen))
    assert parts.discretisation == pytest.approx(parts.whole, rel=0.3)
    assert parts.unexplained < 0.5 * parts.whole
    assert parts.softness < 1e-4


@pytest.mark.slow
def test_the_command_compares_and_ends_with_the_right_code(tmp_path):
    text = (
        '[body]\nkind = "sphere"\nradius = 1\ncentre = [0, 1.4, 0]\n'
        "[path]\npoints = [[1.1, 0.3], [0.2, 0.3]]\nstations = 20\n[mujoco]\nsegments = {}\n"
    )
    for segments, code, says in ((40, 0, "agrees with"), (3, 1, "disagrees with")):
        (tmp_path / "case.toml").write_text(text.format(segments))
        out = f"of-{segments}"
        done = vibrissa("space", "case.toml", "--engine", "mujoco", "--out", out, cwd=tmp_path)
        assert done.returncode == code, done.stdout + done.stderr
        assert says in done.stdout
    for name in ("report.html", "comparison.json", "components.png", "mujoco-chain.parquet"):
        assert (tmp_path / "of-40" / name).stat().st_size > 100
    read = SpatialReadings.read(tmp_path / "of-3" / "mujoco-chain.parquet")
    assert np.isfinite(read.values("foot_x")).all()
    for wrong in (["--engine", "drake"], ["--budget"]):
        done = vibrissa("space", "case.toml", *wrong, cwd=tmp_path)
        assert done.returncode == 2
        assert len(done.stderr.strip().splitlines()) == 1
