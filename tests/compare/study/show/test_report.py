"""The report of a study from rows whose laws are known."""

import itertools
import json

import numpy as np
import pandas as pd
import pytest

from analytic import CLAMP_READINGS, InputError
from compare.study.grid.plan import PLAN
from compare.study.keep.database import NAME, Database
from compare.study.show.results import WORST, StudyResults, asked, lines
from compare.study.show.sentences import headline, orders, outcomes, pareto_front, vanishing, varied
from compare.study.show.study_report import write_report

TWO_BEAMS = """
[study]
case = "catenary"
beams = ["chain", "naive"]
[axes]
mujoco.segments = [10, 20, 40]
mujoco.contour_points = [100, 400]
noise.seed = [1, 2, 3]
"""
PHASE_B = """
[study]
case = "parabola"
beams = []
[axes]
profile.a = [0.2, 0.4, 0.8, 1.6]
beam.radius = [0.0, 0.01]
"""


def results(plan, law):
    """Rows of a plan with the columns that `law` gives for a run's parameters."""
    rows = [{"run": run.id, "outcome": "done", "reason": "", **run.parameters,
             **law(run.parameters)} for run in plan]  # fmt: skip
    return StudyResults.of(plan, pd.DataFrame(rows))


def second_order(parameters):
    """The chain is of second order, the rod ten times worse and of first; seeds scatter by 1 %."""
    n, seed = parameters["mujoco.segments"], parameters["noise.seed"]
    error = n**-2.0 if parameters["mujoco.beam"] == "chain" else 1.0 / n
    error *= 1 + 0.01 * (seed - 2)
    return {f"disagreement_{name}_rms": error for name in CLAMP_READINGS} | {
        "seconds_candidate": n * (1 + (parameters["mujoco.beam"] == "rod"))
    }


@pytest.fixture
def refined(plan_of):
    return results(plan_of(TWO_BEAMS.replace("naive", "rod")), second_order)


@pytest.fixture
def phase_b(plan_of):
    def law(parameters):
        minimum = 1.5 - parameters["profile.a"] + parameters["beam.radius"]
        return {"contact_length_minimum": minimum, "phase_b_exists": minimum < 1}

    return results(plan_of(PHASE_B), law)


def test_a_line_is_of_one_beam_with_everything_else_held(refined):
    cut = lines(refined, "mujoco.segments", WORST)
    assert [line.beam for line in cut] == ["chain", "rod"]  # contour points change nothing
    for line, order in zip(cut, (2, 1), strict=True):
        np.testing.assert_allclose(line.table["median"], [10.0**-order, 20.0**-order, 40.0**-order])
        np.testing.assert_allclose(line.table["low"], 0.99 * line.table["median"])
        np.testing.assert_allclose(line.table["high"], 1.01 * line.table["median"])
    assert lines(refined, "mujoco.contour_points", WORST) == []


def test_orders_are_those_of_each_beam(refined):
    found = orders(refined).query("refined == 'mujoco.segments'").groupby("mujoco.beam")["order"]
    assert found.mean()["chain"] == pytest.approx(2)
    assert found.mean()["rod"] == pytest.approx(1)


def test_the_main_finding_is_a_sentence(refined, phase_b):
    (question,) = asked(refined)
    said = headline(refined, question)
    assert "With the chain, the worst reading's disagreement falls from 1.0e-2 to 6" in said
    assert "power -2" in said
    assert "With the rod" in said
    assert "power -1" in said
    assert "mujoco.segments (3 from 10 to 40)" in varied(refined)
    (question,) = asked(phase_b)
    said = headline(phase_b, question)
    assert said.startswith("4 of 8 runs have a Phase B")
    assert "profile.a = 0.5 to 0.51" in said


def test_what_depends_on_nothing_is_not_asked(plan_of):
    def constant(parameters):
        return {f"disagreement_{name}_rms": 0.1 for name in CLAMP_READINGS}

    assert asked(results(plan_of(TWO_BEAMS.replace("naive", "rod")), constant)) == []


def test_phase_b_vanishes_where_the_contact_length_passes_1(phase_b):
    found = vanishing(phase_b).set_index("beam.radius")["vanishes at"]
    assert found[0.0] == pytest.approx(0.5)
    assert found[0.01] == pytest.approx(0.51)


def test_no_run_beats_the_front():
    chance = np.random.default_rng(3)
    runs = pd.DataFrame(chance.random((200, 2)), columns=["cost", "error"])
    front = pareto_front(runs, "cost", "error").to_numpy()
    assert 1 < len(front) < 30
    for one, other in itertools.product(runs.to_numpy(), front):
        assert not (one < other).all()


def test_outcomes_count_what_is_missing(plan_of):
    plan = plan_of(PHASE_B)
    rows = pd.DataFrame(
        [{"run": run.id, "outcome": "failed", "reason": "broken"} for run in list(plan)[:3]]
    )
    found = outcomes(StudyResults.of(plan, rows)).set_index("outcome")
    assert found["runs"].to_dict() == {"failed": 3, "not done yet": 5}
    assert found.loc["failed", "example"] == "broken"


def test_a_page_of_an_unfinished_study(plan_of, tmp_path):
    plan = plan_of(PHASE_B)
    database = Database(tmp_path, pytest.fail)
    for number, run in enumerate(list(plan)[:5]):
        done = {"outcome": "done", "reason": ""} if number else {
            "outcome": "failed", "reason": "<script>alert(1)</script>"}  # fmt: skip
        numbers = {"contact_length_minimum": 1.2 - 0.1 * number, "phase_b_exists": number > 2}
        database.add({"run": run.id, **done, **run.parameters, **numbers})
    database.close()
    (tmp_path / "study.json").write_bytes(PLAN.dump_json(plan))
    warned = []
    page = write_report(tmp_path, warned.append).read_text()
    assert "4 of 8 runs are done" in page
    assert "<script>" not in page
    assert page.index("runs are done") < page.index("<svg")
    assert "3" in page[page.index("not done yet") :][:60]
    assert not warned


def test_nothing_done_says_why(plan_of, tmp_path):
    plan = plan_of(PHASE_B)
    Database(tmp_path, pytest.fail).close()
    (tmp_path / "study.json").write_text(json.dumps(PLAN.dump_python(plan, mode="json")))
    with pytest.raises(InputError, match="a run that is done"):
        write_report(tmp_path, pytest.fail)
    (tmp_path / NAME).write_bytes(b"PAR1")
    with pytest.raises(InputError, match=r"runs\.sqlite is damaged"):
        write_report(tmp_path, pytest.fail)
