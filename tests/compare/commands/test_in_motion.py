"""`vibrissa run` of a sweep in motion."""

import json

import pytest

from analytic import Readings
from tests.compare.command import vibrissa

FAST = ("--segments", "10", "--obstacle", "primitive", "--stations", "40", "--speed", "0.4")


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_run_compares_with_the_closed_form_and_with_rest(tmp_path):
    done = vibrissa("run", "catenary", *FAST, "--out", "out", cwd=tmp_path)
    assert done.returncode == 1
    assert "what the motion adds to that: force_x" in done.stdout
    moved = Readings.read(tmp_path / "out" / "mujoco-chain-in-motion.parquet")
    assert {"time", "kinetic_share", "contact_losses", "force_x_raw"} <= set(moved.table)
    assert moved.provenance["motion"]["speed"] == 0.4
    # The stiffest contact that does not chatter, 4/dt^2, in motion and at rest.
    rest = Readings.read(tmp_path / "out" / "at-rest.parquet")
    assert rest.provenance["settings"]["contact_stiffness"] == pytest.approx(1e4)
    found = json.loads((tmp_path / "out" / "comparison.json").read_text())
    # Too fast to agree, whatever it reads: its limits grow with the speed up to a hundredth only.
    assert found["tolerances"]["rms"] == 1e-2
    assert "a faster motion is not quasi-static" in found["tolerance_reasons"]["rms"]
    assert found["tolerances"]["lateness"] > 0.1
    assert vibrissa("report", "out", cwd=tmp_path).returncode == 1


def test_simulate_says_what_moved(tmp_path):
    done = vibrissa("run", "catenary", "--sweep-only", *FAST, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "kinetic share in contact at most" in done.stdout
    folder = "catenary-primitive-10-segments-40-stations-speed-0.4"
    assert (tmp_path / "results" / folder / "mujoco-chain-in-motion.parquet").is_file()


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--speed", "0"), "motion.speed"),
        (("--motion", "--spatial"), "--spatial"),
        (("--timestep", "9"), "motion.timestep"),
    ],
)
def test_bad_motions_are_refused(tmp_path, words, said):
    done = vibrissa("run", "catenary", "--sweep-only", *words, cwd=tmp_path)
    done.refused(said)


def test_what_knows_no_motion_says_so(tmp_path):
    (tmp_path / "case.toml").write_text(
        '[profile]\nkind = "circle"\nradius = 1.0\nlowest = [0.0, 0.4]\n[motion]\nspeed = 0.1\n'
    )
    done = vibrissa("view", "case.toml", cwd=tmp_path)
    assert done.returncode == 2
    assert "motion" in done.stderr
