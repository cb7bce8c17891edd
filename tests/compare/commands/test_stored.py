"""Commands on what is stored: the report of a run written again, files of rigs side by side."""

import json

import numpy as np
import pytest

from analytic import Beam, Case, Readings, Sweep, circle, solve_sweep
from compare.judge.tolerances import Tolerances
from compare.read.run_folder import read_run
from tests.compare.case_files import CASE, RIG_COLUMNS, as_a_rig
from tests.compare.command import reported_again, vibrissa


@pytest.fixture(scope="module")
def sweep() -> Readings:
    vibrissa_of_50_mm = Beam(length=0.05, flexural_rigidity=2e-6, radius=0.25e-3)
    case = Case(vibrissa_of_50_mm, circle(0.04, lowest=(0.0, 0.02)), Sweep(stations=60))
    return solve_sweep(case)


@pytest.mark.slow
@pytest.mark.usefixtures("in_turn")
def test_the_report_of_a_run_again(tmp_path):
    """All that `run` writes after its sweeps: limits, budget and animation are the same."""
    limits = '[tolerances]\nrms = { limit = 3e-2, reason = "eight segments" }\n'
    limits += 'max = { limit = 0.2, reason = "as few" }\n'
    limits += 'force_x.tip.max = { limit = 0.1, reason = "for the controller" }\n'
    (tmp_path / "case.toml").write_text(
        '[profile]\nkind = "catenary"\na = 0.5\nc = -0.8\n' + limits
    )
    words = ("case.toml", "--stations", 30, "--segments", 8, "--out", "out")
    done = vibrissa("run", *words, "--budget", "--film", "--frames", "6", cwd=tmp_path)
    reported_again(done, tmp_path / "out", "report.html", "readings.png")
    assert "The largest part is discretisation" in done.stdout
    stored = read_run(tmp_path / "out")
    assert stored.tolerances.special["force_x.tip.max"].reason == "for the controller"
    assert stored.budget.convergence.keys() == {8, 16, 32}


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_a_report_of_two_sweeps_that_nobody_compared_yet(tmp_path, sweep):
    sweep.write(tmp_path / "analytic.parquet")
    sweep.write(tmp_path / "mujoco-rod.parquet")
    sweep.write(tmp_path / "mujoco-rod.partial.parquet")
    vibrissa("report", ".", cwd=tmp_path).ended(0)
    assert (tmp_path / "report.html").exists()
    assert read_run(tmp_path).tolerances == Tolerances().suited_to(sweep)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("comparison.json", b'{"tolerances": {"rms": "x"}}', "comparison.json"),
        ("budget.json", b"[" * 100_000, "budget.json"),
        ("mujoco-chain.parquet", None, "(analytic.parquet)"),
        ("mujoco-rod.parquet", b"", "one mujoco-BEAM.parquet"),
        ("analytic.parquet", b"PAR1", "analytic.parquet"),
    ],
)
def test_a_run_that_is_damaged_is_one_line(tmp_path, sweep, name, content, said):
    sweep.write(tmp_path / "analytic.parquet")
    sweep.write(tmp_path / "mujoco-chain.parquet")
    if content is None:
        (tmp_path / name).unlink()
    else:
        (tmp_path / name).write_bytes(content)
    there = set(tmp_path.iterdir())
    vibrissa("report", tmp_path, cwd=tmp_path).refused(said)
    assert set(tmp_path.iterdir()) == there


@pytest.mark.slow
def test_rigs_side_by_side(tmp_path, sweep):
    """Columns, units, decimal commas, rows out of order; the engine's file beside them as it is."""
    sweep.write(tmp_path / "analytic.parquet")
    sweep.write(tmp_path / "engine.csv")
    rig = as_a_rig(sweep)
    rig.to_csv(tmp_path / "one.csv", index=False)
    rig.iloc[::-1].to_csv(tmp_path / "two.txt", sep=";", decimal=",", index=False)
    shuffled = rig.sample(frac=1, random_state=1).reset_index(drop=True)
    shuffled.to_parquet(tmp_path / "three.parquet")
    files = ("engine.csv", "one.csv", "two.txt", "three.parquet")
    words = (*RIG_COLUMNS, "--direction", "left", "--out", "out")
    done = vibrissa("compare", "analytic.parquet", *files, *words, cwd=tmp_path)
    assert "three.parquet" in done.stderr or "out of order" in done.stderr
    found = json.loads((tmp_path / "out" / "side-by-side.json").read_text())["comparisons"]
    assert [one["names"][1] for one in found[:4]] == ["engine", "one", "two", "three"]
    rms = [
        one["disagreement"][name]["rms"] for one in found[:4] for name in ("force_x", "moment_z")
    ]
    assert np.max(rms) < 1e-12
    assert done.returncode in (0, 1)
    assert (tmp_path / "out" / "side-by-side.png").stat().st_size > 10_000


@pytest.mark.slow
def test_an_engines_files_keep_their_beam(tmp_path, sweep):
    for name in ("analytic", "one", "two"):
        sweep.write(tmp_path / f"{name}.parquet")
    (tmp_path / "other.toml").write_text("[beam]\nlength = 7.0\n")
    words = ("compare", "analytic.parquet", "one.parquet", "two.parquet", "--out", "out")
    vibrissa(*words, cwd=tmp_path).ended(0)
    done = vibrissa(*words, "--beam", "other.toml", cwd=tmp_path)
    done.refused("--beam = other.toml: must be beside a file that no engine wrote")


@pytest.mark.parametrize("page", ["report.html", "engines.html", "side-by-side.html"])
def test_a_page_of_somebody_else_is_not_replaced(tmp_path, page):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / page).write_text("<p>my own</p>")
    for words in (("run", "catenary", "--engine", "exact"), ("verify",)):
        done = vibrissa(*words, "--out", "out", cwd=tmp_path)
        done.refused(f"output = out/{page}: must be free, or from an earlier run")
    assert [path.name for path in (tmp_path / "out").iterdir()] == [page]


@pytest.mark.slow
def test_no_result_replaces_a_file_of_somebody_else(tmp_path):
    """Whatever its kind, and whichever command; a second run replaces the files of the first."""
    (tmp_path / "case.toml").write_text(CASE)
    run = ("run", "case.toml", "--engine", "exact", "--out", "out")
    find = ("reconstruct", "out/analytic.parquet", "--fit", "circle", "--out", "out")
    for words in (run, find, run, find):
        assert vibrissa(*words, cwd=tmp_path).returncode < 2
    for name, content, words in (
        ("analytic.parquet", b"PAR1 of a rig PAR1", run),
        ("points.csv", b"x,y\n1,2\n", find),
        ("object.json", b'{"name": "mine"}', find),
        ("reconstruction.png", b"PNG, Software Matplotlib", find),
    ):
        file = tmp_path / "out" / name
        own = file.read_bytes()
        file.write_bytes(content)
        done = vibrissa(*words, cwd=tmp_path)
        done.refused(f"output = out/{name}: must be free, or from an earlier run")
        assert file.read_bytes() == content
        file.write_bytes(own)


@pytest.mark.slow
@pytest.mark.usefixtures("unpictured")
def test_a_film_of_somebody_else_stays(tmp_path):
    run = ("run", "catenary", "--stations", "12", "--segments", "6", "--out", "out")
    film = tmp_path / "out" / "animation.gif"
    film.parent.mkdir()
    film.write_bytes(b"GIF89a of a holiday")
    assert vibrissa(*run, cwd=tmp_path).returncode < 2
    vibrissa(*run, "--film", cwd=tmp_path).refused("output = out/animation.gif: must be free")
    assert film.read_bytes() == b"GIF89a of a holiday"
    film.unlink()
    for _ in range(2):
        assert vibrissa(*run, "--film", "--frames", "4", cwd=tmp_path).returncode < 2
        assert film.is_file()
    assert vibrissa(*run, cwd=tmp_path).returncode < 2
    assert not film.exists()  # it would be of another sweep


@pytest.mark.slow
def test_contacts_are_written_though_no_family_explains_them(tmp_path):
    (tmp_path / "wedge.toml").write_text(
        '[profile]\nkind = "polygon"\npoints = [[-1, 1.2], [0, 0.4], [1, 1.2]]\n'
        "[sweep]\nstations = 12\n"
    )
    vibrissa("run", "wedge.toml", "--engine", "exact", "--out", "w", cwd=tmp_path).ended(0)
    words = ("reconstruct", "w/analytic.parquet", "--fit", "auto", "--out", "o")
    done = vibrissa(*words, cwd=tmp_path)
    done.ended(1, "family = none of them", "a vibrissa or clamp that is not as stated")
    assert (tmp_path / "o" / "points.csv").is_file()
