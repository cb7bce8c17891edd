"""Uncertainties in a case file, from the command to the report."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from analytic import Beam, Case, Sweep, circle, solve_sweep
from compare import compare, validate
from compare.measure.measurement import measure
from compare.read.case import load_job
from compare.read.run_folder import read_run
from compare.show.report import write_report
from tests.compare.case_files import POST, WIRE
from tests.compare.command import vibrissa
from tests.compare.planted import planted

CASE = f"""
{WIRE}{POST}[sweep]
stations = 100
[uncertainty]
flexural_rigidity = {{ standard = "3 %" }}
foot_x = {{ standard = "50 um" }}
[uncertainty.noise]
moment_z = "0.2 mN mm"
"""
BEAM = Beam(0.05, 2e-6, 0.25e-3, si=True)
OBJECT = circle(0.04, (0.0, 0.02))


def rig(path, rigidity):
    """A vibrissa that is stiffer than the case says, with some noise."""
    exact = solve_sweep(Case(replace(BEAM, flexural_rigidity=rigidity), OBJECT, Sweep(100)))
    rng = np.random.default_rng(0)
    noisy = {
        name: exact.values(name) + 2e-3 * exact.table[name].abs().max() * rng.standard_normal(100)
        for name in ("force_x", "force_y", "moment_z")
    }
    pd.DataFrame({"foot_x": exact.values("foot_x"), **noisy}).to_csv(path, index=False)


@pytest.mark.slow
def test_a_disagreement_within_and_beyond_what_is_uncertain(tmp_path):
    (tmp_path / "case.toml").write_text(CASE, encoding="utf-8")
    for rigidity, resolved in ((2.06e-6, False), (2.3e-6, True)):
        rig(tmp_path / "rig.csv", rigidity)
        done = vibrissa("compare", "case.toml", "rig.csv", "--beam", "case.toml", cwd=tmp_path)
        done.ended(1)
        said = "the disagreement is resolved" if resolved else "the disagreement is not resolved"
        assert said in done.stdout
        assert "flexural_rigidity dominates" in done.stdout
        assert ("may make all of E" in done.stdout) == (not resolved)
        folder = tmp_path / "results" / "case-rig"
        found = json.loads((folder / "comparison.json").read_text(encoding="utf-8"))["validation"]
        assert found["resolved"] == found["whole"]["resolved"] == resolved
        assert found["dominant"] == "flexural_rigidity"
        assert "moment_z stated" in found["noise_source"]
        table = pd.read_csv(folder / "validation.csv")
        assert len(table) == 3 * found["stations"]
        assert table["error"].pow(2).mean() ** 0.5 == found["whole"]["error"]
        assert "ASME V&amp;V 20" in (folder / "report.html").read_text(encoding="utf-8")
        assert (folder / "validation.png").exists()


def test_a_reference_that_is_a_file_takes_its_uncertainties_from_a_case(tmp_path):
    (tmp_path / "case.toml").write_text(CASE, encoding="utf-8")
    (tmp_path / "bare.toml").write_text(CASE.partition("[uncertainty]")[0], encoding="utf-8")
    solve_sweep(load_job(str(tmp_path / "case.toml")).case).write(tmp_path / "mine.parquet")
    rig(tmp_path / "rig.csv", 2.06e-6)
    for arguments, why in (
        (("case.toml", "--uncertainty", "case.toml"), "beside a reference that is a file"),
        (("mine.parquet", "--uncertainty", "bare.toml"), "add the table"),
        (("mine.parquet", "--budget", "budget.json"), "add --uncertainty"),
        (("mine.parquet", "--uncertainty", "case.toml", "--budget", "no.json"), "no.json"),
    ):
        reference, *options = arguments
        vibrissa("compare", reference, "rig.csv", *options, cwd=tmp_path).refused(why)


def test_a_budget_is_the_uncertainty_of_the_numerics(tmp_path):
    (tmp_path / "case.toml").write_text(CASE, encoding="utf-8")
    job = load_job(str(tmp_path / "case.toml"))
    exact = solve_sweep(job.case)
    other = replace(exact, table=exact.table.assign(force_x=1.01 * exact.values("force_x")))
    made = planted(size=2e-3)
    found = validate(
        measure(exact, other, 5e-3), job.case, job.uncertainties, budget=made, samples=4
    )
    sizes = [
        np.hypot(made.parts[part][name].rms, made.parts[part][name].uncertainty)
        for part in made.parts
        for name in ("force_x", "force_y", "moment_z")
        if part != "unexplained"
    ]
    assert found.numerics_source == "the budget's parts"
    assert found.whole.u_num == pytest.approx(np.sqrt(np.sum(np.square(sizes)) / 3), rel=0.05)
    assert found.whole.shares["numerics"] > 0


@pytest.mark.slow
@pytest.mark.usefixtures("undrawn")
def test_a_stored_run_keeps_its_validation(tmp_path):
    (tmp_path / "case.toml").write_text(CASE, encoding="utf-8")
    job = load_job(str(tmp_path / "case.toml"))
    exact = solve_sweep(job.case)
    other = replace(exact, table=exact.table.assign(force_x=1.01 * exact.values("force_x")))
    exact.write(tmp_path / "analytic.parquet")
    other.write(tmp_path / "mujoco-chain.parquet")
    found = compare(exact, other).validated(job.case, job.uncertainties, "candidate")
    write_report(found, tmp_path)
    stored = read_run(tmp_path).validation
    assert stored == found.validation
    np.testing.assert_allclose(stored.table["error"], found.validation.table["error"])
    done = vibrissa("report", ".", cwd=tmp_path)
    assert "stands in for an experiment" in done.stdout
    assert read_run(tmp_path).validation == found.validation
