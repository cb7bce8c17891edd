"""Engines on one page: why one disagrees is said, and one without times is there all the same."""

from dataclasses import replace

import pytest

from analytic import CLAMP_READINGS, named_case, solve_sweep
from compare.read.runs import EngineOutcome
from compare.show.engines import ManyEngines, engines_document, error_against_time, outcomes_table
from compare.show.html import html

CASE = replace(named_case("tip-only"), sweep=replace(named_case("tip-only").sweep, stations=40))


@pytest.fixture(scope="module")
def many():
    """A vibrissa 1 % too stiff, of an engine that records no time and had three bad stations."""
    exact = solve_sweep(CASE)
    table = exact.table.assign(**{name: 1.01 * exact.table[name] for name in CLAMP_READINGS})
    about = {"engine": "Mine 1.2", "unsettled": {"it sleeps": 2, "it slides": 1}}
    mine = replace(exact, table=table, source="mine", provenance=about)
    asked = [EngineOutcome("mine", "other model", "1.2", "nothing", None)]
    return ManyEngines.of(CASE, exact, asked, {"mine": mine})


def test_the_cause_is_in_the_table_and_on_the_page(many):
    (row,) = outcomes_table({many.case.name: many.outcomes}).rows
    assert row[1] == "mine 1.2, other model"
    assert row[-1].startswith("disagrees; likely ")
    assert row[-1].endswith("3 stations unsettled, mostly as it sleeps")
    assert row[-1] in html(engines_document(many)).replace("&#39;", "'")


def test_one_without_times_is_in_table_and_picture(many):
    (row,) = outcomes_table({many.case.name: many.outcomes}).rows
    assert row[-2] == "none"
    figure = error_against_time(many)
    assert len(figure.axes[0].lines) == len(CLAMP_READINGS)
    assert [text.get_text() for text in figure.axes[0].texts] == ["mine, no time"]
    figure.canvas.draw()
