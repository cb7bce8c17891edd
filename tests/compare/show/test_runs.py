"""The page of many runs: planted numbers, and the sentences that they must lead to."""

import json
import math
import shutil
from pathlib import Path

import pytest

from analytic import CLAMP_READINGS, InputError
from compare.align.frames import COMPONENTS
from compare.explain.split import Split
from compare.read.runs import EngineOutcome, read_runs
from compare.show.page import write_all
from compare.study.report import write_report
from tests.compare.planted import planted
from tests.compare.show.pages import Page
from tests.compare.show.sweeps import two_runs


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Two runs as `write_report` leaves them, one with a budget."""
    return two_runs(tmp_path_factory.mktemp("runs"))


@pytest.fixture
def runs(folder, tmp_path) -> Path:
    """A copy that a test may spoil; without sweeps, so that the page is made fast."""
    shutil.copytree(folder, tmp_path / "runs", ignore=shutil.ignore_patterns("*.parquet"))
    return tmp_path / "runs"


def test_page(folder, tmp_path):
    written = write_report(folder, tmp_path).path
    assert [path.name for path in tmp_path.iterdir()] == ["report.html"]
    text = written.read_text(encoding="utf-8")
    page = Page(text)
    assert page.faults == []
    assert len(page.ids) == len(set(page.ids))
    rms = read_runs(folder)[0].rms
    row = next(line for line in text.splitlines() if '<th scope="row">catenary</th>' in line)
    assert '<td class="text">chain</td><td>40</td>' in row
    assert f"{rms['force_x']:.1e}".replace("e-0", "e-") in row
    assert "not measured" in row
    assert row.endswith("<td>17</td></tr>")  # ms a station: a second for 60
    assert text.index(">catenary</h2>") < text.index(">parabola</h2>")
    (picture,) = page.all("img")
    assert picture["alt"].startswith("Budget of the chain: discretisation")


def test_names_settings_and_blame_are_no_markup(runs):
    nasty = "a|b <script>alert(1)</script>\n# *c* $x$"
    run = runs / "parabola-chain"
    comparison = json.loads((run / "comparison.json").read_text())
    provenance = comparison["candidate"]["provenance"]
    provenance |= {"case": nasty, "settings": {"segments": nasty, "beam": nasty}}
    (run / "comparison.json").write_text(json.dumps(comparison))
    budget = planted().to_dict() | {"blame": nasty}
    (run / "budget.json").write_text(json.dumps(budget))
    text = write_report(runs).path.read_text(encoding="utf-8")
    assert "<td>a|b &lt;script&gt;" in text
    assert "<script" not in text


@pytest.mark.parametrize(
    ("file", "content"),
    [
        ("comparison.json", '{"verdict": '),
        ("comparison.json", "[" * 100_000),
        ("comparison.json", '{"verdict": "agrees", "disagreement": {"force_x": 1}}'),
        ("engines.json", '{"case": "catenary"}'),
    ],
)
def test_damaged_runs_are_named(runs, tmp_path, file, content):
    (runs / "parabola-chain" / file).write_text(content)
    with pytest.raises(InputError, match=f"parabola-chain/{file}.*a run") as caught:
        write_report(runs, tmp_path / "out")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400
    with pytest.raises(InputError, match="a folder with runs in it"):
        write_report(tmp_path, tmp_path / "out")
    assert not (tmp_path / "out").exists()


def engines_left(folder, implementation=1e-9):
    """What a run in MuJoCo and a twin of it leaves, of which one has no readings."""
    rms, apart = (dict.fromkeys(CLAMP_READINGS, x) for x in (2e-3, implementation))
    others = {"exudyn": dict.fromkeys(CLAMP_READINGS, 5e-5)}
    split = Split("mujoco", "drake", rms, apart, rms, others, None)
    swept = [EngineOutcome(name, "twin", "1.0", "as it is", None, rms, None, 0.01, agrees=True)
             for name in ("mujoco", "drake")]  # fmt: skip
    slow = EngineOutcome("slow", "twin", "1.0", trouble="not finished after 20 s")
    never = EngineOutcome("never", rms=dict.fromkeys(CLAMP_READINGS, math.nan))
    content = {"case": "catenary", "engines": [*swept, slow, never], "split": split}
    write_all(folder, {"engines.json": content})


def test_runs_in_many_engines_are_split(tmp_path):
    """Without any run in MuJoCo alone, too."""
    engines_left(tmp_path / "runs" / "one")
    written = write_report(tmp_path / "runs", tmp_path / "out").path
    text = " ".join(written.read_text().split())
    for said in (
        "mujoco computes this model right",
        '<th scope="row">slow 1.0, twin</th><td class="text">no readings</td><td>none</td>',
        "not finished after 20 s",
        '<th scope="row">never</th><td class="text">disagrees</td><td>none</td>',
        "implementation: mujoco against drake",
    ):
        assert said in text


def test_a_run_in_space_is_a_row(tmp_path):
    """Its six components, and its own parts; no phases, and as of a whisk a snap-off in rad."""
    egg = {"source": "mujoco chain", "stations": 12, "beam": {"length": 2.0}}
    egg |= {"provenance": {"case": "egg", "body": "sphere", "settings": {"segments": 6}}}
    content = {"verdict": "agrees", "phases": {"agreement": None}, "candidate": egg}
    content["disagreement"] = {name: {"rms": 4e-3} for name in COMPONENTS}
    content |= {"running": "clamp_angle", "snap_off": {"difference": 0.1}}
    run = tmp_path / "runs" / "egg"
    run.mkdir(parents=True)
    (run / "comparison.json").write_text(json.dumps(content))
    (run / "budget.json").write_text(json.dumps(planted().to_dict()))
    (run / "budget.png").touch()
    text = write_report(tmp_path / "runs", tmp_path / "out").path.read_text()
    assert text.count("<td>4.0e-3</td>") == len(COMPONENTS)
    assert "discretisation" in text
    assert "<td>1.0e-1 rad</td>" in text
    assert "1 of 1 sweeps agree" in text
