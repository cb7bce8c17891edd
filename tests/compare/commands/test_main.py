"""The command line as a user meets it."""

import io
import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from analytic import REAL_CASE_NAMES, Readings, named_case, solve_sweep
from tests.compare.command import vibrissa

CASE = """
name = "small object"
[beam]
length = 1.0
[profile]
kind = "circle"
radius = 1.0
lowest = [0.0, 0.4]
[sweep]
stations = 30
[mujoco]
segments = 10
"""

UNITS = """
[beam]
length = "50 mm"
flexural_rigidity = "2e-6 N m^2"
radius = "0.25 mm"
[profile]
kind = "catenary"
a = 0.5
c = -0.8
scale = "5 cm"
[sweep]
stations = 30
"""


@pytest.mark.slow
def test_run_writes_what_it_promises(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    done = vibrissa("run", "case.toml", "--out", "out", "--segments", 40, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
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
    assert "<b>The two agree.</b>" in report
    again = vibrissa("compare", "out/analytic.parquet", "out/mujoco-chain.parquet", cwd=tmp_path)
    assert again.returncode == 0


@pytest.mark.slow
def test_a_coarse_beam_disagrees(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    done = vibrissa("run", "case.toml", cwd=tmp_path)
    assert done.returncode == 1
    assert "allowed" in done.stdout
    assert (tmp_path / "results" / "small object" / "report.html").exists()


@pytest.mark.slow
def test_a_run_with_its_budget(tmp_path):
    (tmp_path / "case.toml").write_text(CASE)
    done = vibrissa("run", "case.toml", "--budget", "--out", "runs/it", cwd=tmp_path)
    assert done.returncode == 1, done.stderr
    assert "The largest part is discretisation" in done.stdout
    found = json.loads((tmp_path / "runs" / "it" / "budget.json").read_text())
    assert found["blame"] == "discretisation"
    assert list(found["convergence"]) == ["10", "20", "40"]
    assert 'id="budget"' in (tmp_path / "runs" / "it" / "report.html").read_text()
    done = vibrissa("findings", "runs", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "| small object | chain | 10 |" in (tmp_path / "runs" / "README.md").read_text()
    assert vibrissa("findings", "nowhere", cwd=tmp_path).returncode == 2


def test_units(tmp_path):
    (tmp_path / "case.toml").write_text(UNITS)
    done = vibrissa("analytic", "case.toml", "--out", ".", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    from analytic import named_case, solve_sweep

    sweep = Readings.read(tmp_path / "analytic.parquet")
    assert sweep.beam.length == pytest.approx(0.05)
    from dataclasses import replace

    from analytic import Sweep

    dimensionless = solve_sweep(replace(named_case("catenary"), sweep=Sweep(stations=30)))
    ratio = sweep.values("force_y").max() / dimensionless.values("force_y").max()
    assert ratio == pytest.approx(2e-6 / 0.05**2, rel=1e-9)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (("length = 1.0", "length = -1.0"), "beam.length = -1.0"),
        (("length = 1.0", 'length = "1 parsnip"'), "'1 parsnip'"),
        (("length = 1.0", 'length = "1 kg"'), "'1 kg'"),
        (("length = 1.0", 'length = "1 m"'), "without a unit"),
        (("length = 1.0", "lenght = 1.0"), "did you mean length?"),
        (("radius = 1.0", "radius = 1.0\na = 3"), "profile.a"),
        (("radius = 1.0", ""), "profile.radius = missing"),
        (('kind = "circle"', 'kind = "square"'), "profile.kind = 'square'"),
        (('kind = "circle"', ""), "profile.kind = missing"),
        (("segments = 10", "segments = 1"), "mujoco.segments"),
        (("segments = 10", "segmens = 10"), "did you mean segments?"),
        (("segments = 10", 'beam = "rope"'), "mujoco.beam = 'rope'"),
        (("stations = 30", "stations = 1"), "sweep.stations = 1"),
        (("[sweep]", '[sweep]\ndirection = "up"'), "sweep.direction = 'up': must be one of 'left'"),
        (("[sweep]", "[sweeep]"), "did you mean sweep?"),
        (("0.4]", "1.4]"), "below 1 L"),
        (("0.4]", "0.001]"), "above the foot line"),
        (("[beam]", "[beam"), "TOML"),
    ],
)
def test_bad_case_files(tmp_path, change, said):
    (tmp_path / "case.toml").write_text(CASE.replace(*change))
    done = vibrissa("run", "case.toml", "--out", "out", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1, done.stderr
    assert said in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["run", "catenry"], "did you mean catenary?"),
        (["run", "nowhere.toml"], "nowhere.toml"),
        (["run", "catenary", "--beam", "rope"], "rope"),
        (["run", "catenary", "--segments", "0"], "segments = 0"),
        (["run", "catenary", "--stations", "x"], "stations"),
        (["compare", "a.parquet", "b.parquet"], "a.parquet"),
        (["fly"], "fly"),
        (["run"], "CASE"),
    ],
)
def test_bad_commands(tmp_path, arguments, said):
    done = vibrissa(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1, done.stderr
    assert said in done.stderr
    assert list(tmp_path.iterdir()) == []


def test_an_output_folder_that_cannot_be(tmp_path):
    (tmp_path / "file").write_text("")
    done = vibrissa("analytic", "parabola", "--out", "file", cwd=tmp_path)
    assert done.returncode == 2
    assert done.stderr.count("\n") == 1


def test_cases_are_listed(tmp_path):
    done = vibrissa("cases", cwd=tmp_path)
    assert done.returncode == 0
    assert "two-circles" in done.stdout


def test_alone_it_prints_its_help_and_is_no_success(tmp_path):
    done = vibrissa(cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout.count("\n") > 10
    assert "side-by-side" in done.stdout
    assert done.stderr == ""


def test_points_and_counts_have_the_phases_of_a_comparison(tmp_path):
    from analytic import CLAMP_READINGS, Sweep, named_case, solve_sweep
    from compare import classify
    from compare.sense.noise import with_noise

    exact = solve_sweep(replace(named_case("catenary"), sweep=Sweep(stations=60)))
    noisy = with_noise(exact, dict.fromkeys(CLAMP_READINGS, 1e-3), 3)
    noisy.table.loc[30, "status"] = "unsettled"
    noisy.write(tmp_path / "noisy.csv")
    done = vibrissa("reconstruct", "noisy.csv", "--out", "out", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    points = pd.read_csv(tmp_path / "out" / "points.csv")
    judged = classify(noisy).phase
    explained = (points["phase"] != "unexplained").to_numpy()
    here = explained & (judged != "")
    assert (points["phase"].to_numpy()[here] == judged[here]).all()
    assert points["phase"][30] == "gap"
    for phase in ("tip", "tangent"):
        assert f"{(points['phase'] == phase).sum()} {phase}" in done.stdout
    assert "1 not used" in done.stdout


def test_a_terminal_shows_what_is_being_done(monkeypatch):
    from compare.commands.waiting import waiting

    for terminal in (True, False):
        out = io.StringIO()
        out.isatty = lambda terminal=terminal: terminal
        monkeypatch.setattr("sys.stderr", out)
        with waiting("comparing"):
            pass
        assert ("comparing" in out.getvalue()) == terminal


def test_reconstruction_of_a_rigs_file(tmp_path):
    """Own column names, millimetres and millinewtons, and the vibrissa given by a file."""
    (tmp_path / "case.toml").write_text(UNITS)
    vibrissa("analytic", "case.toml", "--out", ".", cwd=tmp_path)
    sweep = Readings.read(tmp_path / "analytic.parquet")
    rig = sweep.table[["foot_x"]] * 1e3
    rig.columns = ["stage"]
    rig["Fx"], rig["Fy"] = sweep.values("force_x") * 1e3, sweep.values("force_y") * 1e3
    rig["Mz"] = sweep.values("moment_z") * 1e6
    rig.to_csv(tmp_path / "rig.csv", index=False)
    columns = ["foot_x=stage:mm", "force_x=Fx:mN", "force_y=Fy:mN", "moment_z=Mz:mN mm"]
    words = [word for column in columns for word in ("--column", column)]
    done = vibrissa(
        "reconstruct", "rig.csv", "--beam", "case.toml", *words, "--out", "out", cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    points = pd.read_csv(tmp_path / "out" / "points.csv")
    np.testing.assert_allclose(points["contact_x"], sweep.values("contact_x"), atol=1e-12)
    assert (tmp_path / "out" / "reconstruction.png").exists()
    for words, said in (
        (["--column", "foot_x"], "NAME=COLUMN"),
        (["--column", "foot_x=stagee"], "stagee"),
        (["--column", "foot_x=stage:parsec s"], "parsec s"),
        (["--beam", "rig.csv"], "rig.csv"),
    ):
        done = vibrissa("reconstruct", "rig.csv", *words, cwd=tmp_path)
        assert done.returncode == 2
        assert said in done.stderr
        assert done.stderr.count("\n") == 1


RIG = ("foot_x=stage:mm", "force_x=Fx:mN", "force_y=Fy:mN", "moment_z=Mz:mN mm")
RIG_COLUMNS = tuple(word for column in RIG for word in ("--column", column))


@pytest.fixture
def rig(tmp_path) -> Path:
    """A folder with a sweep in SI units and the same from a rig: mm, mN, 2 mm off, 0.3 % noise."""
    (tmp_path / "case.toml").write_text(UNITS.replace("stations = 30", "stations = 120"))
    vibrissa("analytic", "case.toml", "--out", ".", cwd=tmp_path)
    sweep = Readings.read(tmp_path / "analytic.parquet")
    rng = np.random.default_rng(1)
    columns = {"stage": sweep.values("foot_x") * 1e3 + 2.0}
    for column, name, unit in (
        ("Fx", "force_x", 1e3),
        ("Fy", "force_y", 1e3),
        ("Mz", "moment_z", 1e6),
    ):
        values = sweep.values(name) * unit
        noise = 3e-3 * np.abs(values).max() * rng.standard_normal(len(values))
        columns[column] = values + noise
    pd.DataFrame(columns).to_csv(tmp_path / "rig.csv", index=False)
    return tmp_path


@pytest.mark.slow
def test_compare_with_a_rig(rig):
    """Own columns, units, an unknown offset, noise; without stating the last two it fails."""
    words = ("compare", "analytic.parquet", "rig.csv", *RIG_COLUMNS, "--out", "out")
    done = vibrissa(*words, "--offset", "auto", "--noise", "0.003", cwd=rig)
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads((rig / "out" / "comparison.json").read_text())
    assert found["offset"]["value"] == pytest.approx(2e-3, abs=found["offset"]["uncertainty"])
    assert found["offset"]["uncertainty"] < 1e-4
    assert "offset" in done.stdout
    assert "noise" in done.stdout
    estimated = vibrissa(*words, "--offset", "auto", "--noise", "auto", cwd=rig)
    assert estimated.returncode == 0, estimated.stdout
    assert vibrissa(*words, "--offset", "0.002", "--noise", "0.003", cwd=rig).returncode == 0
    assert vibrissa(*words, "--noise", "0.003", cwd=rig).returncode == 1
    # The other way round: the rig as the reference, whose vibrissa a file states.
    columns = [word.replace("--column", "--reference-column") for word in RIG_COLUMNS]
    beam = ("--reference-beam", "case.toml")
    words = ("compare", "rig.csv", "analytic.parquet", *columns, *beam, "--out", "back")
    vibrissa(*words, "--offset", "auto", "--noise", "auto", cwd=rig)
    found = json.loads((rig / "back" / "comparison.json").read_text())
    assert found["offset"]["value"] == pytest.approx(-2e-3, abs=2e-4)


@pytest.mark.slow
def test_a_case_is_a_reference_and_its_offset_is_applied(rig):
    """The vibrissa, the limits and the name are the case's."""
    (rig / "own").mkdir()
    (rig / "own" / "analytic.parquet").write_bytes((rig / "analytic.parquet").read_bytes())
    words = ("rig.csv", *RIG_COLUMNS, "--noise", "0.003", "--offset", "auto")
    done = vibrissa("compare", "case.toml", *words, cwd=rig)
    assert done.returncode == 0, done.stdout + done.stderr
    for reference in ("analytic.parquet", "own/analytic.parquet"):
        vibrissa("compare", reference, *words, cwd=rig)
    names = {path.name for path in (rig / "results").iterdir()}
    assert names == {"case-rig", "analytic-rig", "own-analytic-rig"}
    found = json.loads((rig / "results" / "case-rig" / "comparison.json").read_text())
    given = ("--beam", "case.toml", *RIG_COLUMNS, "--offset", found["offset"]["value"])
    done = vibrissa("reconstruct", "rig.csv", *given, "--out", "out", cwd=rig)
    assert done.returncode == 0, done.stderr
    points = pd.read_csv(rig / "out" / "points.csv")
    foot_x = Readings.read(rig / "analytic.parquet").values("foot_x")
    np.testing.assert_allclose(points["foot_x"], foot_x, atol=1e-4)


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("reconstruct", "rig.csv", *RIG_COLUMNS), "vibrissa = none given"),
        (("reconstruct", "rig.csv"), "--column foot_x="),
        (("compare", "rig.csv", "rig.csv", *RIG_COLUMNS), "--column foot_x="),
        (("compare", "nowhere.toml", "rig.csv"), "nowhere.toml"),
        (("compare", "case.toml", "rig.csv", "--reference-beam", "case.toml"), "reference"),
        (("reconstruct", "analytic.parquet", "--offset", "nan"), "offset = nan"),
    ],
)
def test_what_is_missing_is_asked_for(rig, words, said):
    done = vibrissa(*words, cwd=rig)
    assert done.returncode == 2
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (rig / "results").exists()


def test_that_length_and_rigidity_are_one_is_said(tmp_path):
    from analytic import SENSED, named_case, solve_sweep

    sweep = solve_sweep(named_case("parabola"))
    sweep.table[list(SENSED)].to_csv(tmp_path / "bare.csv", index=False)
    done = vibrissa("reconstruct", "bare.csv", "--out", "out", cwd=tmp_path)
    assert done.returncode == 0
    assert "L = EI = 1 is assumed" in done.stderr


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("--offset", "some"), "--offset = 'some'"),
        (("--offset", "nan"), "--offset = 'nan'"),
        (("--noise", "2"), "noise = 2.0"),
        (("--tolerances", "none.toml"), "none.toml"),
        (("--tolerances", "case.toml"), "[tolerances]"),
        (("--beam", "rig.csv"), "rig.csv"),
    ],
)
def test_compare_refuses(rig, words, said):
    given = ("compare", "analytic.parquet", "rig.csv", *RIG_COLUMNS, "--out", "out", *words)
    done = vibrissa(*given, cwd=rig)
    assert done.returncode == 2
    assert said in done.stderr
    assert done.stderr.count("\n") == 1
    assert not (rig / "out").exists()


def test_an_offset_that_nothing_determines_is_one_line(rig):
    lines = (rig / "rig.csv").read_text().splitlines()
    (rig / "rig.csv").write_text("\n".join(lines[:6]))
    words = ("compare", "analytic.parquet", "rig.csv", *RIG_COLUMNS, "--offset", "auto")
    done = vibrissa(*words, cwd=rig)
    assert done.returncode == 2
    assert "offset = ambiguous" in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.slow
def test_tolerances_from_files(tmp_path):
    """A case file's are those of its runs, a file's those of a comparison."""
    limits = '[tolerances]\nrms = { limit = 1e-9, reason = "to see it fail" }\n'
    (tmp_path / "case.toml").write_text(CASE + limits)
    done = vibrissa("run", "case.toml", "--out", "out", "--segments", 40, cwd=tmp_path)
    assert done.returncode == 1
    assert "allowed 1.00e-09 (to see it fail)" in done.stdout
    assert "to see it fail" in (tmp_path / "out" / "report.html").read_text()
    (tmp_path / "limits.toml").write_text(limits)
    both = ("out/analytic.parquet", "out/mujoco-chain.parquet")
    assert vibrissa("compare", *both, "--out", "again", cwd=tmp_path).returncode == 0
    words = ("--tolerances", "limits.toml", "--out", "again")
    assert vibrissa("compare", *both, *words, cwd=tmp_path).returncode == 1


def test_the_papers_figures(tmp_path):
    done = vibrissa(
        "analytic", "shallow-catenary", "--figures", "--certified", "--out", ".", cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    drawn = {path.name for path in tmp_path.glob("*.png")}
    assert drawn == {"shapes.png"} | {f"figure-{n}.png" for n in (12, 14, 15, 16)}


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in REAL_CASE_NAMES if name != "whisker"])
def test_cases_beyond_the_paper(tmp_path, name):
    done = vibrissa("analytic", name, "--figures", "--certified", "--out", ".", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "200 of 200 stations ok" in done.stdout
    drawn = {path.name for path in tmp_path.glob("*.png")}
    assert drawn == {"shapes.png"} | {f"figure-{n}.png" for n in (14, 15, 16)}
    found = vibrissa("reconstruct", "analytic.parquet", "--out", "found", cwd=tmp_path)
    assert found.returncode == 0, found.stderr
    same = vibrissa("compare", name, "analytic.parquet", "--out", "compared", cwd=tmp_path)
    assert same.returncode == 0, same.stdout + same.stderr


@pytest.mark.slow
def test_a_whisker(tmp_path):
    """A picture that holds for uniform vibrissae alone is not drawn; contacts are found."""
    done = vibrissa("analytic", "whisker", "--figures", "--certified", "--out", ".", cwd=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert {path.name for path in tmp_path.glob("*.png")} == {"figure-14.png", "figure-15.png"}
    found = vibrissa("reconstruct", "analytic.parquet", "--out", "found", cwd=tmp_path)
    assert found.returncode == 0
    assert "192 contact points from 200 stations" in found.stdout


def test_a_vibrissa_that_locks_itself_is_said(tmp_path):
    """Its tip climbs as it is straightened, which friction prevents: where, and why."""
    (tmp_path / "locks.toml").write_text(
        "[beam]\nnatural_curvature = 0.5\n[contact]\nfriction = 0.9\n"
        '[profile]\nkind = "parabola"\na = 0.5\nc = 0.5\n'
    )
    done = vibrissa("analytic", "locks.toml", "--stations", 60, "--out", "out", cwd=tmp_path)
    assert done.returncode == 1
    assert "5 sticks (foot_x 1.1757 to 0.9986 L: the contact would slide back, " in done.stdout
    assert len(done.stdout.splitlines()) == 2


def test_a_vibrissa_that_would_touch_twice_is_said(tmp_path):
    (tmp_path / "forward.toml").write_text(
        '[beam]\nnatural_curvature = 0.5\n[profile]\nkind = "catenary"\na = 0.5\nc = -0.8\n'
    )
    done = vibrissa("analytic", "forward.toml", "--out", ".", cwd=tmp_path)
    assert done.returncode == 1
    assert "touches again (foot_x" in done.stdout
    assert "another part of the vibrissa would lie in the object" in done.stdout
    table = Readings.read(tmp_path / "analytic.parquet").table
    again = table[table["status"] == "touches again"]
    assert len(again) > 10
    assert again[["force_x", "force_y", "moment_z"]].isna().all(axis=None)


@pytest.mark.parametrize(
    ("profile", "said"),
    [
        ('kind = "polygon"\npoints = [[-1, 1.2], [0, 0.4], [1, 1.2]]', None),
        ('kind = "points"\npoints = [[-1, 1.2], [-0.5, 0.5], [0, 0.4], [1, 1.2]]', None),
        ('kind = "mesh"\nfile = "ball.stl"\noffset = [0, 1.3]', None),
        ('kind = "mesh"\nfile = "none.stl"', "none.stl"),
        ('kind = "polygon"\npoints = [[-1, 1.2], [0, 0.4]]', "three or more"),
        ('kind = "points"\npoints = [[0, 1], [1, 0], [2, 0.5], [3, 0.8]]', "point 2"),
    ],
)
def test_other_contours(tmp_path, profile, said):
    import trimesh

    trimesh.creation.icosphere(subdivisions=3).export(tmp_path / "ball.stl")
    (tmp_path / "case.toml").write_text(f"[profile]\n{profile}\n[sweep]\nstations = 20\n")
    done = vibrissa("analytic", "case.toml", "--out", ".", cwd=tmp_path)
    if said is None:
        assert done.returncode == 0, done.stderr
    else:
        assert done.returncode == 2
        assert said in done.stderr
        assert done.stderr.count("\n") == 1


def test_friction_is_estimated_from_the_clamp(tmp_path):
    case = named_case("rubbing")
    solve_sweep(case).with_friction(0.0).write(tmp_path / "rig.csv")
    done = vibrissa("reconstruct", "rig.csv", "--friction", "auto", "--out", "found", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "friction coefficient 0.3000 +-" in done.stdout
    for wrong, said in (("2", "from -1 to 1"), ("much", "a number or auto")):
        done = vibrissa("reconstruct", "rig.csv", "--friction", wrong, cwd=tmp_path)
        assert done.returncode == 2 and said in done.stderr
