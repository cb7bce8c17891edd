"""`vibrissa calibrate`: what is printed, written, and refused."""

import json
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from analytic import SENSED, Case, Readings, Sweep, calibrate, circle, relative_noise, solve_sweep
from compare import load_case
from compare.read.case import case_tables
from compare.show.case_file import calibrated_case
from compare.show.fits import calibration_summary
from tests.analytic.noisy import noisy
from tests.compare.command import vibrissa

OBJECT = '[profile]\nkind = "circle"\nradius = 1.0\nlowest = [0.0, 0.4]\n'


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    folder = tmp_path_factory.mktemp("calibrate")
    case = Case(profile=circle(1.0, lowest=(0, 0.4)), sweep=Sweep(40), clamp_stiffness=8.0)
    readings = solve_sweep(case)
    readings.write(folder / "swept.parquet")
    sensed = readings.table[["foot_x", "force_x", "force_y", "moment_z"]]
    sensed.to_csv(folder / "rig.csv", index=False)
    sensed.assign(force_x=0.0, force_y=0.0, moment_z=0.0).to_csv(folder / "idle.csv", index=False)
    (folder / "object.toml").write_text(OBJECT)
    (folder / "rubs.toml").write_text(f"{OBJECT}[contact]\nfriction = 0.4\n")
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("file", ["swept.parquet", "rig.csv"])
def test_the_clamp_is_found_and_written(file, folder, tmp_path):
    done = vibrissa(
        "calibrate", folder / file, folder / "object.toml",
        "--fit", "clamp_stiffness, flexural_rigidity", "--noise", "0.01", "--out", "found",
        cwd=tmp_path,
    )  # fmt: skip
    done.ended(0)
    rows = [line.split() for line in done.stdout.splitlines()]
    (stiffness,) = (row for row in rows if row[:1] == ["clamp_stiffness"])
    assert stiffness[1] == "8"
    assert stiffness[2].startswith("7.")
    assert "trading off most: clamp_stiffness and flexural_rigidity, corr" in done.stdout
    written = json.loads((tmp_path / "found" / "calibration.json").read_text())
    assert written["found"]["clamp_stiffness"]["value"] == pytest.approx(8.0)
    assert written["stations"] > 30


def test_what_varies_along_a_vibrissa_is_stretched_with_its_length(tmp_path):
    """The case that is written is the case found, in any unit, and keeps its radius."""
    text = (
        '[beam]\nlength = "5 cm"\n'
        'flexural_rigidity = [["0 mm", "2 N mm^2"], ["50 mm", "1 N mm^2"]]\n'
        '[profile]\nkind = "circle"\nradius = "40 mm"\nlowest = ["0 mm", "20 mm"]\n'
    )
    (tmp_path / "known.toml").write_text(text)
    known = load_case(tmp_path / "known.toml").case
    longer = replace(known, beam=known.beam.scaled(length=1.02), sweep=Sweep(30))
    found = calibrate(solve_sweep(longer), known, ["length"])
    written = calibrated_case(*case_tables(tmp_path / "known.toml"), found, known.beam)
    (tmp_path / "found.toml").write_text(written)
    beam = load_case(tmp_path / "found.toml").case.beam
    assert (beam.length, beam.radius) == pytest.approx((0.051, 0.25e-3), rel=1e-8)
    assert beam.rigidity_at(0.0255) == pytest.approx(1.5e-6, rel=1e-8)


STRAIGHT = Case(profile=circle(1.0, lowest=(0, 0.4)), sweep=Sweep(60))


@pytest.mark.slow
def test_what_explains_the_readings_if_it_is_fitted_too_is_named(tmp_path):
    """Of a clamp that leaned it was "a sign, a unit, the object's place", and a lag."""
    leant = solve_sweep(replace(STRAIGHT, clamp_angle=0.03))
    size, rng = relative_noise(leant, 1e-3), np.random.default_rng(2)
    noise = {n: leant.values(n) + x * white(rng, 60) for n, x in size.items()}
    leant.table.assign(**noise)[[*SENSED]].to_csv(tmp_path / "leant.csv", index=False)
    (tmp_path / "object.toml").write_text(OBJECT)
    done = vibrissa("calibrate", "leant.csv", "object.toml", cwd=tmp_path)
    done.ended(1)
    (line,) = (x for x in done.stdout.splitlines() if x.startswith("fitted too, "))
    assert line.split()[2] == "clamp_angle"
    assert float(line.split()[3]) == pytest.approx(0.03, abs=3e-4)
    assert "--fit flexural_rigidity,clamp_angle" in done.stdout


def said_of(count, noise, stated):
    """Lines of a calibration from passes with noise, known to be of another size."""
    exact, rng = solve_sweep(STRAIGHT), np.random.default_rng(2)
    size = relative_noise(exact, 0.01)
    passes = []
    for _ in range(count):
        columns = {n: exact.values(n) + x * noise(rng, 60) for n, x in size.items()}
        passes.append(replace(exact, table=exact.table.assign(**columns)))
    known = {name: stated * x for name, x in size.items()}
    return " ".join(str(x) for x in calibration_summary(calibrate(passes, STRAIGHT, noise=known)))


def white(rng, n):
    return rng.standard_normal(n)


def remembers(rng, n):
    return lfilter([1], [1, -0.9], rng.standard_normal(n + 99) * np.sqrt(0.19))[99:]


@pytest.mark.slow
def test_noise_that_is_stated_too_large_is_said():
    """Of five times the noise passes had p = 1 and "say the same", and no word of it."""
    found = said_of(8, white, 5)
    assert "they differ by less: noise, or zeros, are taken for larger" in found
    assert "the noise is less than it was taken for" in found
    right = said_of(3, white, 1)
    assert "3 passes say the same" in right
    assert "less" not in right


@pytest.mark.parametrize(
    ("count", "said"),
    [
        pytest.param(1, True, marks=pytest.mark.slow),
        (2, True),
        pytest.param(3, False, marks=pytest.mark.slow),
    ],
)
def test_what_one_pass_does_not_distinguish_is_said(count, said):
    """A circle 3 % off under noise that remembers was called right, of one pass, without a word."""
    assert ("do not distinguish noise that remembers" in said_of(count, remembers, 1)) == said
    assert "do not distinguish" not in said_of(count, white, 1)


@pytest.mark.slow
def test_ten_passes_of_6000_rows_take_less_than_300_mb(folder, tmp_path):
    """Peak of a process of its own: 250 to 275 MB, of which Python and libraries have 200."""
    exact = solve_sweep(Case(profile=circle(1.0, lowest=(0, 0.4)), sweep=Sweep(200)))
    places = np.linspace(*exact.values("foot_x")[[0, -1]], 6000)
    columns = [np.interp(-places, -exact.values("foot_x"), exact.values(name)) for name in SENSED]
    columns[1] += 0.02 * np.sin(2 * np.pi * np.arange(6000) / 20)  # hum has columns too
    dense = Readings.of(dict(zip(SENSED, columns, strict=True)), exact.beam)
    for i in range(10):
        noisy(dense, relative_noise(dense, 0.01), i).write(tmp_path / f"{i}.parquet")
    # Not `ru_maxrss`, which begins with that of the process that started it.
    code = (
        "from compare.commands.main import app; app(standalone_mode=False); "
        "print(open('/proc/self/status').read().split('VmHWM:')[1].split()[0])"
    )
    files = [*(f"{i}.parquet" for i in range(10)), folder / "object.toml"]
    done = subprocess.run(
        [sys.executable, "-c", code, "calibrate", *files],
        cwd=tmp_path, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert "From 5" in done.stdout  # 5x,xxx stations
    assert int(done.stdout.split()[-1]) * 1024 < 300e6


@pytest.mark.slow
def test_a_fit_that_is_bad_because_forces_are_swapped_says_so(folder, tmp_path):
    case = Case(profile=circle(1.0, lowest=(0, 0.4)), sweep=Sweep(60))
    swapped = solve_sweep(case).table.rename(columns={"force_x": "force_y", "force_y": "force_x"})
    swapped[list(SENSED)].to_csv(tmp_path / "rig.csv", index=False)
    done = vibrissa("calibrate", "rig.csv", folder / "object.toml", cwd=tmp_path)
    done.refused("likely force_x and force_y, swapped")


def test_a_folder_that_is_none_of_passes_is_one_line(folder, tmp_path):
    for words in (("calibrate", folder, folder / "object.toml"), ("reconstruct", folder)):
        vibrissa(*words, cwd=tmp_path).refused("a folder that `rig` wrote")


@pytest.mark.parametrize(
    ("file", "options", "message"),
    [
        ("rig.csv", ["--fit", "stiffness"], "unknowns = 'stiffness': must be of flexural_rigidity"),
        ("rig.csv", ["--fit", ""], "unknowns"),
        ("rig.csv", ["--noise", "much"], "--noise = 'much': must be a number or auto"),
        ("rig.csv", ["--noise", "2"], "noise"),
        ("idle.csv", [], "zero at all stations"),
        ("nowhere.csv", [], "nowhere.csv"),
    ],
)
def test_bad_input_is_one_line(file, options, message, folder, tmp_path):
    done = vibrissa("calibrate", folder / file, folder / "object.toml", *options, cwd=tmp_path)
    done.refused(message)
    assert not (tmp_path / "results").exists()
