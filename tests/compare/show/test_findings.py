"""The findings' page: planted numbers, and the sentences that they must lead to."""

import json
import shutil
from pathlib import Path

import pandas as pd
import pytest

from analytic import CASE_NAMES, InputError
from analytic.problem.files import write_whole
from compare import compare
from compare.show.findings import write_findings
from compare.show.findings.methods import method_sentences, read_methods
from compare.show.findings.page import page
from compare.show.findings.records import BudgetFile, ComparisonFile, RunRecord, read_records
from compare.show.findings.sentences import overview, sentences
from compare.show.page import document
from compare.show.report import budget_files
from tests.compare.planted import planted
from tests.compare.show import sweeps


def run(
    case="catenary", beam="chain", rms=1e-3, snap_off=1e-4, right=1.0, budget=None
) -> RunRecord:
    """A run of which only what the page shows is known; force_y is its worst reading."""
    agrees = rms <= 2e-3
    comparison = {
        "verdict": "agrees" if agrees else "disagrees",
        "disagreement": {
            "force_x": {"rms": rms / 3},
            "force_y": {"rms": rms},
            "moment_z": {"rms": rms / 2},
        },
        "snap_off": {"difference": snap_off},
        "phases": {"agreement": right},
        "candidate": {
            "source": f"mujoco {beam}",
            "beam": {"length": 2.0},
            "stations": 100,
            "provenance": {"case": case, "settings": {"beam": beam, "segments": 40}},
        },
    }
    return RunRecord(
        Path(f"{case}-{beam}"),
        ComparisonFile.model_validate(comparison),
        budget and BudgetFile.model_validate(budget.to_dict()),
    )


def methods_table(**medians):
    """A table of two methods on exact readings and with friction, in two phases."""
    rows = [
        {
            "case": "mine", "readings": readings, "method": method, "noise": noise, "phase": phase,
            "contacts": 10, "answered": 0.5 if method == "rare" else 1.0,
            "median": medians[method] * (1 if noise == 0 else 30),
        }
        for readings in ("exact", "friction")
        for method in medians
        for noise in (0.0, 0.01)
        for phase in ("tangent", "tip")
    ]  # fmt: skip
    return pd.DataFrame(rows)


def test_methods_that_survive_are_named(tmp_path):
    folder = tmp_path / "runs" / "one"
    folder.mkdir(parents=True)
    methods_table(good=1e-3, poor=0.2, rare=1e-3).to_csv(folder / "methods.csv", index=False)
    (record,) = read_methods(tmp_path / "runs")
    assert record.survivors("exact", 0.0) == ["good"]
    said = method_sentences(record)
    assert "exact: good; friction: good." in said
    assert "At 1 % of noise the best on exact readings: A good (3.0e-2), B good (3.0e-2)." in said
    assert record.cell("rare", "exact", 0.0) == "B 1.0e-3 (50%), A 1.0e-3 (50%)"
    assert record.cell("absent", "exact", 0.0) == ""
    text = page([run()], [], [record])
    assert "![What each method survives on readings of the case mine](methods-on-mine.png)" in text
    assert "| good |  | B 1.0e-3, A 1.0e-3 |" in text


@pytest.mark.parametrize("damage", ["", "a,b\n1,2\n", "\x00"])
def test_a_damaged_table_of_methods_is_one_line(tmp_path, damage):
    (tmp_path / "one").mkdir()
    (tmp_path / "one" / "methods.csv").write_text(damage)
    with pytest.raises(InputError, match=r"methods\.csv"):
        read_methods(tmp_path)


@pytest.mark.parametrize(
    ("runs", "said"),
    [
        ([run()], "The chain agrees with the closed form within the tolerances."),
        ([run(rms=3e-3)], "The chain does not agree with the closed form"),
        ([run()], "Its worst reading is off by 1.0e-3 rms in force_y."),
        ([run(), run(beam="rod", rms=1e-4)], "Both sweeps agree"),
        ([run(rms=1), run(beam="rod", rms=1)], "Neither agrees"),
        ([run(), run(beam="rod", rms=1)], "1 of 2 sweeps agree with the closed form within the "
         "tolerances, all but: rod."),
        ([run(), run(beam="rod"), run(beam="cable")], "All 3 sweeps agree"),
        ([run(), run(beam="rod", rms=1e-4)], "The rod is the closest (1.0e-4 rms in force_y, its "
         "worst reading), the chain the farthest (1.0e-3 in force_y)."),
        ([run(budget=planted())], "The largest part of the disagreement is discretisation for the "
         "chain (1.0e-3, of observed order 2.00)."),
        ([run(budget=planted("facets", 3e-4)), run(beam="rod", budget=planted(size=2e-3))],
         "is facets for the chain (3.0e-4) and discretisation for the rod (2.0e-3, of observed"),
        ([run(budget=planted("facets")), run(beam="rod", budget=planted("facets", 2e-3))],
         "is facets for the chain and the rod (1.0e-3 to 2.0e-3)."),
        ([run(budget=planted())], "The budget closes: at most 2.0e-5 is unexplained."),
        ([run(budget=planted(unexplained=3e-4, closes=False))],
         "The budget does not close: 3.0e-4 is unexplained."),
        ([run(budget=planted()), run(beam="rod", budget=planted(unexplained=3e-4, closes=False))],
         "1 of 2 budgets do not close (rod): up to 3.0e-4 is unexplained."),
        ([run(budget=planted(unexplained=3e-4, closes=False, undecided=True))],
         "The budget is undecided: 3.0e-4 is unexplained."),
        ([run(budget=planted()),
          run(beam="rod", budget=planted(unexplained=3e-4, closes=False, undecided=True))],
         "1 of 2 budgets do not close (rod: undecided): up to 3.0e-4 is unexplained."),
        ([run()], "The snap-off is found within 5.0e-5 L, and the clamp"),
        ([run(snap_off=None)], "No snap-off is found in both sweeps"),
        ([run(), run(beam="rod", snap_off=None)], "The snap-off is missing in 1 of 2 comparisons"),
        ([run(right=0.955)], "readings give the right phase of at least 95.5 % of stations."),
        ([run(right=None)], "The snap-off is found within 5.0e-5 L."),
    ],
)  # fmt: skip
def test_sentences(runs, said):
    assert said in sentences(runs)


def test_nothing_is_said_of_a_budget_that_there_is_not():
    text = sentences([run()]) + overview([run()])
    assert "budget" not in text
    assert "unexplained" not in text


def test_overview():
    runs = [
        run(budget=planted()),
        run(beam="rod", rms=4e-3, budget=planted(unexplained=3e-4, closes=False)),
    ]
    assert overview(runs) == (
        "1 of 2 sweeps agree with the closed form within the tolerances, all but: catenary, rod. "
        "The largest rms is 4.0e-3 of the largest magnitude (force_y, catenary, rod). "
        "1 of 2 budgets do not close (catenary, rod): up to 3.0e-4 is unexplained. "
        "No more than 5.0e-5 is unexplained in 1 of 2."
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    """Two runs as `write_report` leaves them, one with a budget."""
    made = tmp_path_factory.mktemp("runs")
    for case, budget in (("parabola", planted()), ("catenary", None)):
        exact, simulated = sweeps.exact(case), sweeps.candidate(case)
        run = made / f"{case}-chain"
        run.mkdir()
        contents = {"comparison.json": document(compare(exact, simulated).to_dict())}
        if budget is not None:
            contents |= budget_files(budget)
        for name, content in contents.items():
            write_whole(run / name, content)
        if budget is None:
            simulated.write(run / "mujoco-chain.parquet")
    (made / "a-study").mkdir()
    return made


@pytest.fixture
def runs(folder, tmp_path) -> Path:
    """A copy that a test may spoil; without sweeps, so that the page is made fast."""
    shutil.copytree(folder, tmp_path / "runs", ignore=shutil.ignore_patterns("*.parquet"))
    return tmp_path / "runs"


def test_page(folder, tmp_path):
    written = write_findings(folder, tmp_path)
    assert [path.name for path in written] == ["README.md", "budget-parabola-chain.png"]
    assert {path.name for path in tmp_path.iterdir()} == {path.name for path in written}
    assert written[1].stat().st_size < 40_000  # fifteen of them stay below 1 MB
    text = written[0].read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| catenary | chain")]
    rms = read_records(folder)[0].rms
    assert f"| 40 | {rms['force_x']:.1e}".replace("e-0", "e-") in rows[0]
    assert "not measured" in rows[0]
    assert text.index("## catenary") < text.index("## parabola")
    assert "](budget-parabola-chain.png)" in text
    tables = [line.count("|") for line in text.splitlines() if line.startswith("|")]
    assert set(tables) == {12, 9}  # every row has all its cells


def test_it_replaces_and_removes_only_what_it_has_written(runs, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "budget-of-mine.png").write_bytes(b"mine")
    write_findings(runs, out)
    assert (out / "budget-parabola-chain.png").exists()
    (runs / "parabola-chain").rename(runs / "odd (name) ü")
    assert {path.name for path in write_findings(runs, out)} == {
        "README.md", "budget-odd (name) ü.png"
    }  # fmt: skip
    assert not (out / "budget-parabola-chain.png").exists()
    (runs / "odd (name) ü" / "budget.json").unlink()
    write_findings(runs, out)
    assert {path.name for path in out.iterdir()} == {"README.md", "budget-of-mine.png"}
    assert (out / "budget-of-mine.png").read_bytes() == b"mine"


@pytest.mark.parametrize("name", ["README.md", "budget-parabola-chain.png"])
@pytest.mark.parametrize("content", [b"# My own\n", b"\xff\xfe"])
def test_files_of_others_stay(runs, tmp_path, name, content):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=rf"--out = .*{name}.*: must be a folder without"):
        write_findings(runs, tmp_path)
    assert (tmp_path / name).read_bytes() == content
    assert {path.name for path in tmp_path.iterdir()} == {name, "runs"}


def test_names_settings_and_blame_are_no_markup(tmp_path):
    nasty = "a|b <script>alert(1)</script>\n# *c* $x$"
    plain = r"a&#124;b &#60;script&#62;alert(1)&#60;/script&#62; \# \*c\* \$x\$"
    record = run(case=nasty, budget=planted())
    comparison = record.comparison.model_dump()
    comparison["candidate"]["provenance"]["settings"] = {"segments": nasty, "beam": nasty}
    (tmp_path / "odd").mkdir()
    (tmp_path / "odd" / "comparison.json").write_text(json.dumps(comparison))
    budget = planted().to_dict() | {"blame": nasty}
    (tmp_path / "odd" / "budget.json").write_text(json.dumps(budget))
    (tmp_path / "odd" / "budget.png").write_bytes(budget_files(planted())["budget.png"])
    text = write_findings(tmp_path, tmp_path)[0].read_text(encoding="utf-8")
    assert f"| {plain} | {plain} | {plain} |" in text
    assert "script>" not in text


def test_nothing_to_report(tmp_path):
    with pytest.raises(InputError, match="a folder with runs in it"):
        write_findings(tmp_path, tmp_path)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("file", "content"),
    [
        ("comparison.json", '{"verdict": '),
        ("comparison.json", "{}"),
        ("comparison.json", "[1]"),
        ("comparison.json", "[" * 100_000),
        ("comparison.json", '{"verdict": "agrees", "disagreement": {"force_x": 1}}'),
        ("budget.json", '{"blame": 1}'),
        ("budget.png", "no picture"),
    ],
)
def test_damaged_runs_are_named(runs, tmp_path, file, content):
    (runs / "parabola-chain" / file).write_text(content)
    with pytest.raises(InputError, match=f"parabola-chain/{file}.*a run") as caught:
        write_findings(runs, tmp_path / "out")
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 400
    assert not (tmp_path / "out").exists()


def test_a_run_of_which_nothing_could_be_compared():
    never = run(snap_off=None, right=None)
    for reading in ("force_x", "force_y", "moment_z"):
        getattr(never.comparison.disagreement, reading).rms = None
    assert "No station could be compared." in sentences([never])
    assert "catenary, chain" in overview([run(), never])


def test_all_named_cases_are_made():
    makefile = (Path(__file__).parents[3] / "Makefile").read_text()
    (line,) = (line for line in makefile.splitlines() if line.startswith("CASES :="))
    assert line.removeprefix("CASES :=").split() == list(CASE_NAMES)


def engines_left(folder, implementation=1e-9):
    """What a run in MuJoCo and a twin of it leaves, of which one has no readings."""
    readings = ("force_x", "force_y", "moment_z")
    rms = dict.fromkeys(readings, 2e-3)
    row = {"role": "twin", "version": "1.0", "trouble": None, "rms": rms, "snap_off_apart": None}
    row |= {"seconds_a_station": 0.01, "agrees": True}
    lost = {"trouble": "not finished after 20 s", "rms": None, "agrees": False}
    split = {"subject": "mujoco", "twin": "drake", "disagreement": rms, "model": rms}
    split |= {"implementation": dict.fromkeys(readings, implementation), "blame": "model"}
    split["others"] = {"exudyn": dict.fromkeys(readings, 5e-5) | {"force_x": None}}
    engines = [{"name": "mujoco", **row}, {"name": "drake", **row}, {"name": "slow", **row, **lost}]
    folder.mkdir(parents=True)
    content = {"case": "catenary", "engines": engines, "split": split}
    (folder / "engines.json").write_text(json.dumps(content))


@pytest.mark.parametrize(
    ("implementation", "says"),
    [
        (1e-9, "mujoco computes its model right: it and its twin drake are at most 1.0e-9 apart"),
        (3e-4, "are up to 3.0e-4 apart, above rounding in catenary"),
    ],
)
def test_runs_in_many_engines_are_split(tmp_path, implementation, says):
    """Without any run in MuJoCo alone, too."""
    engines_left(tmp_path / "runs" / "one", implementation)
    (written,) = write_findings(tmp_path / "runs", tmp_path / "out")
    text = " ".join(written.read_text().split())
    assert says in text
    assert "2.0e-3. exudyn's is it to 5.0e-5." in text
    assert "| catenary | slow 1.0 | twin | none | none | none |" in text
    assert "not finished after 20 s" in text
    assert "implementation: mujoco against drake" in text


def test_a_damaged_run_in_many_engines_is_a_line(tmp_path):
    (tmp_path / "runs" / "one").mkdir(parents=True)
    (tmp_path / "runs" / "one" / "engines.json").write_text('{"case": "catenary"}')
    with pytest.raises(InputError, match=r"engines\.json = damaged \(engines"):
        write_findings(tmp_path / "runs", tmp_path / "out")
