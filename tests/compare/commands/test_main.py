"""The command line as a user meets it."""

import io
import json

import pytest

from tests.compare.case_files import CASE
from tests.compare.command import vibrissa


@pytest.mark.slow
def test_run_writes_what_it_promises(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    vibrissa("run", "case.toml", "--film", "--out", "out", "--segments", 40, cwd=tmp_path).ended(0)
    assert {path.name for path in (tmp_path / "out").iterdir()} == {
        "analytic.parquet",
        "mujoco-chain.parquet",
        "comparison.json",
        "report.html",
        "geometry.png",
        "readings.png",
        "phases.png",
        "animation.gif",
        *(f"still-{n}.png" for n in (1, 2, 3, 4)),
    }
    found = json.loads((tmp_path / "out" / "comparison.json").read_text())
    assert found["verdict"] == "agrees"
    report = (tmp_path / "out" / "report.html").read_text()
    assert "<b>mujoco chain agrees with analytic.</b>" in report
    vibrissa("compare", "out/analytic.parquet", "out/mujoco-chain.parquet", cwd=tmp_path).ended(0)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["run", "catenry"], "did you mean catenary?"),
        (["run", "catenary", "--beam", "rope"], "rope"),
        (["run", "catenary", "--stations", "x"], "'--stations': must be a whole number;"),
        (["calibrate", "x.csv"], "write vibrissa calibrate FILE... CASE"),
        (["compare", "a.parquet", "b.parquet"], "a.parquet"),
        (["fly"], "fly"),
        (["run"], "CASE"),
        (["run", "parabola", "--engine", "exact", "--out", "file"], "--out = file"),
        (["run", "catenary", "--motion", "--spatial"], "--spatial"),
    ],
)
def test_bad_commands(tmp_path, arguments, said):
    (tmp_path / "file").touch()
    vibrissa(*arguments, cwd=tmp_path).refused(said)
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_alone_it_prints_its_help_and_is_no_success(tmp_path):
    done = vibrissa(cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout.count("\n") > 10
    assert "What the clamp says:" in done.stdout
    assert done.stderr == ""


def test_a_terminal_shows_what_is_being_done(monkeypatch):
    from compare.commands.output import waiting

    for terminal in (True, False):
        out = io.StringIO()
        out.isatty = lambda terminal=terminal: terminal
        monkeypatch.setattr("sys.stderr", out)
        with waiting("comparing"):
            pass
        assert ("comparing" in out.getvalue()) == terminal
