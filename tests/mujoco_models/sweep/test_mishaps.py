"""A sweep that ends early: named in one line, the stations so far kept."""

import sys
from dataclasses import replace

import mujoco
import numpy as np
import pytest
import trimesh

from analytic import Case, InputError, Readings, Sweep, circle, mesh_section, named_case
from compare.commands.main import main
from mujoco_models import DivergedError, Settings, simulate_sweep
from mujoco_models.model.model import BeamModel
from mujoco_models.sweep.sweep import set_out

CASE = Case(profile=circle(1.0, lowest=(0.0, 0.4)), sweep=Sweep(stations=20))
QUICK = Settings(segments=8, obstacle="primitive")
BAD_INPUT = 2  # the command's exit code


@pytest.fixture
def vibrissa(tmp_path, monkeypatch, capsys):
    """Run the command in an empty folder; its exit code and the lines of its errors."""

    def run(*words):
        monkeypatch.chdir(tmp_path)
        monkeypatch.setattr(sys, "argv", ["vibrissa", *words])
        with pytest.raises(SystemExit) as ended:
            main()
        return ended.value.code, capsys.readouterr().err.strip().splitlines()

    return run


@pytest.fixture
def not_a_number(monkeypatch):
    """MuJoCo's springs give NaN from the 60th evaluation on."""
    sound, count = mujoco.mj_invConstraint, iter(range(10**9))

    def broken(model, data):
        sound(model, data)
        if next(count) >= 60:
            data.qfrc_passive[2] = np.nan

    monkeypatch.setattr(mujoco, "mj_invConstraint", broken)


def interrupted_after(stations):
    left = iter(range(stations - 1))

    def advance():
        if next(left, None) is None:
            raise KeyboardInterrupt

    return advance


@pytest.mark.parametrize("direction", ["left", "right"])
def test_a_divergence_names_its_station_and_keeps_the_others(not_a_number, direction):
    case = Case(profile=CASE.profile, sweep=Sweep(stations=20, direction=direction))
    kept = []
    with pytest.raises(DivergedError, match=r"diverged at station \d+ of 20, foot_x = .*: "):
        simulate_sweep(case, QUICK, keep=kept.append)
    table = kept[0].table
    assert 2 < len(table) < 20
    np.testing.assert_array_equal(table["foot_x"], case.foot_x[: len(table)])
    assert (table["status"].iloc[:-1] == "ok").all()
    assert table["status"].iloc[-1] == "diverged"
    assert table.iloc[-1][["force_x", "force_y", "moment_z"]].isna().all()
    assert kept[0].trusted.sum() == len(table) - 1
    assert kept[0].provenance["digest"] == case.digest


@pytest.mark.parametrize("direction", ["left", "right"])
def test_an_interrupted_sweep_keeps_its_stations(direction):
    case = Case(profile=CASE.profile, sweep=Sweep(stations=20, direction=direction))
    kept = []
    with pytest.raises(KeyboardInterrupt):
        simulate_sweep(case, QUICK, interrupted_after(7), kept.append)
    whole = simulate_sweep(case, QUICK).table
    np.testing.assert_array_equal(kept.pop().table["force_y"], whole["force_y"].iloc[:7])
    with pytest.raises(KeyboardInterrupt):
        simulate_sweep(case, QUICK, interrupted_after(1), kept.append)
    assert not kept  # of no stations


def test_a_motion_that_explodes_is_an_error(monkeypatch, tmp_path):
    """MuJoCo itself sets a bad state back to the straight beam and only warns."""
    monkeypatch.chdir(tmp_path)  # where MuJoCo puts its log
    model = set_out(CASE, QUICK).model
    model.data.qpos[:] = 1e12
    with pytest.raises(DivergedError, match="stay finite"):
        model.creep(1e-3)


def limited(model):
    """One joint goes no farther than 0.02 rad."""
    model.jnt_limited[3], model.jnt_range[3] = 1, (-0.02, 0.02)


def softened(model):
    """Contacts are MuJoCo's own, of 20 ms."""
    model.geom_solref[:], model.geom_solimp[:] = (0.02, 1), (0.9, 0.95, 1e-3, 0.5, 2)


@pytest.mark.slow
@pytest.mark.parametrize("fault", [limited, softened])
def test_a_fault_that_the_solver_does_not_know_costs_bounded_effort(fault, monkeypatch):
    """Observed 4 s for 30 stations; all that is not sound is unsettled, with the reason."""
    made, counted = BeamModel.__init__, []

    def spoilt(self, *parts):
        made(self, *parts)
        fault(self.model)
        counted.append(self)

    monkeypatch.setattr(BeamModel, "__init__", spoilt)
    found = simulate_sweep(CASE, QUICK)
    assert max(model.evaluations for model in counted) < 2 * 5000 + 20 * 1500
    bad = found.table["status"] != "ok"
    assert set(found.table["status"]) <= {"ok", "unsettled"}
    assert bad.sum() > 10
    assert sum(found.provenance["unsettled"].values()) == bad.sum()


def test_mujoco_has_room_for_six_thousand_contacts():
    """Of a vibrissa bent round an object: its own choice of memory ended in a fatal error."""
    case = named_case("catenary")
    case = replace(case, beam=replace(case.beam, natural_curvature=0.5))
    model = set_out(case, Settings(segments=160, contour_points=400)).model
    model.lookout.watch(set(range(len(model.layout.beads))))
    model.imbalance(case.poses.at(np.array(0.4)), np.zeros(160))
    assert model.data.ncon > 6000
    assert np.isfinite(model.relieved()).all()


def test_contacts_that_mujoco_leaves_out_are_an_error(vibrissa, monkeypatch):
    """MuJoCo only warns when its arena is full."""
    sound = mujoco.mj_invConstraint

    def full(model, data):
        sound(model, data)
        data.warning[mujoco.mjtWarning.mjWARN_CONTACTFULL].number += data.ncon > 0

    monkeypatch.setattr(mujoco, "mj_invConstraint", full)
    code, errors = vibrissa("run", "parabola", "--sweep-only", "--stations", "20", "--out", ".")
    assert code == BAD_INPUT
    assert "out of memory" in errors[-1]
    assert "fewer segments" in errors[-1]


@pytest.mark.parametrize("alone", [["--sweep-only"], []])
def test_command_line_keeps_a_diverged_sweep(vibrissa, not_a_number, tmp_path, alone):
    code, (kept, refused) = vibrissa("run", "parabola", *alone, "--stations", "20", "--out", ".")
    assert code == BAD_INPUT
    assert "stations in" in kept
    assert "diverged at station" in refused
    partial = Readings.read(tmp_path / "mujoco-chain.partial.parquet")
    assert partial.table["status"].iloc[-1] == "diverged"
    assert not (tmp_path / "mujoco-chain.parquet").exists()


def test_what_mujoco_cannot_compile_is_one_line(tmp_path):
    trimesh.creation.icosphere(subdivisions=1).export(tmp_path / "ball.stl")
    speck = mesh_section(tmp_path / "ball.stl", scale=1e-4, offset=(0.0, 0.4))
    with pytest.raises(InputError, match=r"mesh .* too small for MuJoCo") as refused:
        simulate_sweep(Case(profile=speck, sweep=Sweep(stations=5)), Settings(segments=8))
    assert "\n" not in str(refused.value)
