"""``vibrissa study`` and ``vibrissa report`` as a user meets them."""

import re
import shutil
from functools import partial

import numpy as np
import pandas as pd
import pytest

from analytic import CLAMP_READINGS
from compare.align.frames import COMPONENTS
from compare.study.grid.file import shipped_studies
from compare.study.keep.store import TABLE_FILE
from tests.compare.command import vibrissa
from tests.compare.study.studies import EVENTS_ONLY, SIMULATED_IN_SPACE

SIMULATED = """
[study]
case = "catenary"
[axes]
mujoco.segments = [10, 20]
mujoco.contour_points = [400, 800]
[sweep]
stations = 20
"""


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "grid.toml").write_text(EVENTS_ONLY)
    return tmp_path


@pytest.fixture
def study(command):
    return partial(command, "study", "grid.toml", "--out", "out")


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The folder of the study when all of it is done."""
    place = tmp_path_factory.mktemp("finished")
    (place / "grid.toml").write_text(EVENTS_ONLY)
    done = vibrissa("study", "grid.toml", "--out", "out", cwd=place).ended(0, "40 done")
    assert done.stderr == ""
    return place / "out"


@pytest.mark.parametrize(
    ("text", "code", "said"),
    [
        (EVENTS_ONLY, 0, ("40 runs, 40 of them done already", "nothing to do")),
        pytest.param(
            EVENTS_ONLY.replace("0.01]", "0.01, 0.015]"),
            0,
            ("50 runs, 40 of them", "10 done"),
            marks=pytest.mark.slow,
        ),
        # A row that was done without the axis gets the value that it had.
        (EVENTS_ONLY + "profile.c = [-0.8, -0.7]\n", 0, ("80 runs, 40 of them", "40 done")),
        (EVENTS_ONLY + "profile.c = [-0.8, 0.5]\n[beam]\n", 1, ("40 of them", "40 bad-input")),
    ],
    ids=["same", "longer", "further", "failing"],
)
def test_what_is_done_is_not_done_again(folder, finished, study, text, code, said):
    shutil.copytree(finished, folder / "out")
    written = (folder / "out" / TABLE_FILE).stat().st_mtime_ns
    (folder / "grid.toml").write_text(text)
    second = study()
    assert second.returncode == code
    assert all(words in second.stdout for words in said)
    assert ((folder / "out" / TABLE_FILE).stat().st_mtime_ns == written) == (text == EVENTS_ONLY)
    runs = pd.read_parquet(folder / "out" / TABLE_FILE)
    if "profile.c" in runs:
        assert set(runs["profile.c"].value_counts()) == {40}


@pytest.mark.slow
def test_another_base_leaves_only_its_own_rows(folder, finished, study):
    shutil.copytree(finished, folder / "out")
    before = pd.read_parquet(folder / "out" / TABLE_FILE)
    (folder / "grid.toml").write_text(EVENTS_ONLY + "[profile]\nc = -0.75\n")
    changed = study()
    assert "40 runs, 0 of them done already" in changed.stdout
    assert "40 runs of another plan are kept" in changed.stderr
    after = pd.read_parquet(folder / "out" / TABLE_FILE)
    assert len(after) == 40
    assert not set(after["run"]) & set(before["run"])
    (folder / "grid.toml").write_text(EVENTS_ONLY)
    back = study()
    assert "40 of them done already" in back.stdout
    again = pd.read_parquet(folder / "out" / TABLE_FILE)
    assert set(again["run"]) == set(before["run"])
    pd.testing.assert_frame_equal(
        again.sort_values("run", ignore_index=True), before.sort_values("run", ignore_index=True)
    )


@pytest.mark.parametrize("dry", [(), ("--dry-run",)])
def test_a_huge_product_of_axes_is_refused(folder, study, dry):
    axis = "{ from = 0.1, to = 0.2, count = 10000 }"
    many = EVENTS_ONLY.replace("count = 10", "count = 1000")
    (folder / "grid.toml").write_text(many + f"profile.c = {axis}\n")
    done = study(*dry)
    assert done.returncode == 2
    assert "4e+07 runs" in done.stderr
    assert not (folder / "out").exists()


def test_a_dry_run_stores_nothing(folder, study):
    done = study("--dry-run")
    assert "40 runs" in done.stdout
    assert "MB" in done.stdout
    assert not (folder / "out").exists()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "least", "readings", "picture"),
    [
        (SIMULATED, 10, CLAMP_READINGS, "error-against-time"),
        (SIMULATED_IN_SPACE, 8, COMPONENTS, "disagreement-mujoco.segments"),
    ],
)
def test_a_simulated_study_and_its_report(folder, study, command, text, least, readings, picture):
    (folder / "grid.toml").write_text(text)
    study("--workers", "1").ended(0)
    runs = pd.read_parquet(folder / "out" / TABLE_FILE)
    assert len(runs) == 4
    worst = runs.groupby("mujoco.segments")["disagreement_moment_z_rms"].mean()
    assert 1.5 < np.log2(worst[least] / worst[2 * least]) < 2.5  # the chain is of second order
    assert command("report", "out").ended(0).stderr == ""
    page = (folder / "out" / "report.html").read_text()
    assert "Observed orders" in page and "falls from" in page and "mujoco.segments" in page
    assert 'src="http' not in page  # works offline
    orders = pd.read_csv(folder / "out" / "report" / "orders.csv")
    assert set(orders["reading"]) == set(readings)
    assert (folder / "out" / "report" / f"{picture}.png").stat().st_size > 10_000


@pytest.mark.parametrize("where", ["out", "out/runs.sqlite/x"])
def test_a_folder_that_cannot_be_written_to(folder, study, where):
    path = folder / where
    path.parent.mkdir(exist_ok=True, parents=True)
    path.write_text("a file")
    done = study()
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert "--out" in line


@pytest.mark.slow
@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense://"])
def test_no_scheduler_is_one_line(folder, study, address):
    done = study("--scheduler", address)
    assert not (folder / "out").exists()
    assert done.returncode == 2
    assert "--scheduler" in done.stderr.splitlines()[-1]
    assert "Traceback" not in done.stderr


def test_a_folder_without_a_study(command):
    done = command("report", ".")
    assert done.returncode == 2
    assert "vibrissa study" in done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("name", shipped_studies())
def test_shipped_studies_at_small_size(command, tmp_path, name):
    """Every range cut to its two ends; a report of the runs.

    Contacts as stiff as 1e9 EI/L^3 feel the rounding of the mesh, so a station may not settle
    there: that is what this study is to find, and an outcome of its own.
    """
    text = shipped_studies()[name].read_text()
    (tmp_path / "small.toml").write_text(re.sub(r"count = \d+", "count = 2", text))
    done = command("study", "small.toml", "--out", "out")
    runs = pd.read_parquet(tmp_path / "out" / TABLE_FILE)
    assert len(runs) >= 4
    allowed = {"done", "unsettled"} if name in ("contact-stiffness", "motion") else {"done"}
    outcomes = set(runs["outcome"])
    assert "done" in outcomes <= allowed
    assert done.returncode == (0 if outcomes == {"done"} else 1), done.stderr
    command("report", "out").ended(0)
    assert (tmp_path / "out" / "report.html").exists()
