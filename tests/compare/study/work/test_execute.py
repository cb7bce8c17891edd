"""The loop over any executor, and workers that die."""

import os
import signal
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace

import pytest

from compare.study.work.execute import Crew, carry_out, local_crew
from compare.study.work.perform import Result, perform_all
from tests.compare.study.studies import EVENTS_ONLY


def crew(task):
    return replace(local_crew(2), task=task)


def in_a_thread(task, threads=1):
    executor = ThreadPoolExecutor(threads)
    return Crew(executor.submit, task, 5, pytest.fail, executor.shutdown)


def quick(recipe, runs):
    return [Result({"run": run.id, "outcome": "done"}) for run in runs]


def is_bad(run):
    return run.parameters["beam.radius"] == 0.002 and run.parameters["profile.a"] == 0.3


def killed_once(recipe, runs):
    """The first run that finds no mark kills its worker, as the system does when memory is out."""
    with suppress(FileExistsError):
        os.close(os.open(recipe.base["mark"], os.O_CREAT | os.O_EXCL))
        os.kill(os.getpid(), signal.SIGKILL)
    return quick(recipe, runs)


def deadly(recipe, runs):
    if any(map(is_bad, runs)):
        os.kill(os.getpid(), signal.SIGKILL)
    return quick(recipe, runs)


def stuck(recipe, runs):
    """Hang where no Python code is asked any more."""
    if any(map(is_bad, runs)):
        signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT, signal.SIGTERM})
        while True:
            time.sleep(1000)
    return quick(recipe, runs)


@pytest.fixture
def plan(plan_of):
    return plan_of(EVENTS_ONLY)


def test_any_executor_gives_the_same_rows(plan):
    recipe = plan.study.recipe
    tables = []
    for hired in (in_a_thread(perform_all, 3), crew(perform_all)):
        rows = [result.row for result in carry_out(plan, recipe, hired)]
        tables.append(sorted(({**row, "seconds": 0} for row in rows), key=lambda row: row["run"]))
    assert len(tables[0]) == len(plan)
    assert tables[0] == tables[1]


def test_runs_are_made_as_they_are_needed(plan):
    made = []

    def watched():
        for run in plan:
            made.append(run)
            yield run

    recipe = replace(plan.study.recipe, beams=("chain",))  # whose runs are handed out singly
    results = carry_out(watched(), recipe, in_a_thread(quick))
    next(results)
    assert len(made) <= 6
    results.close()


def test_a_killed_worker_costs_nothing(plan, tmp_path):
    recipe = replace(plan.study.recipe, base={"mark": str(tmp_path / "mark")}, timeout=10)
    rows = [result.row for result in carry_out(plan, recipe, crew(killed_once))]
    assert {row["run"] for row in rows} == {run.id for run in plan}
    assert {row["outcome"] for row in rows} == {"done"}


@pytest.mark.slow
def test_a_run_that_kills_its_workers_is_the_only_one_given_up(plan):
    rows = [result.row for result in carry_out(plan, plan.study.recipe, crew(deadly))]
    assert len(rows) == len(plan)
    (bad,) = [row for row in rows if row["outcome"] != "done"]
    assert bad["outcome"] == "failed"
    assert bad["beam.radius"] == 0.002


@pytest.mark.slow
def test_a_stuck_run_is_ended(plan):
    recipe = replace(plan.study.recipe, timeout=0.2)
    rows = [result.row for result in carry_out(plan, recipe, crew(stuck))]
    assert len(rows) == len(plan)
    (bad,) = [row for row in rows if row["outcome"] != "done"]
    assert bad["outcome"] == "timeout"
