"""Several sweeps side by side: known shifts must come out, each in its place."""

from dataclasses import replace

import numpy as np
import pytest

from analytic import CLAMP_READINGS, Readings
from compare import Tolerances
from compare.read.runs import EngineOutcome
from compare.show.page import html
from compare.show.side_by_side import (
    SideBySide,
    error_against_time,
    outcomes_table,
    reasons,
    side_by_side_document,
)
from tests.compare.command import vibrissa
from tests.compare.show import sweeps


@pytest.fixture(scope="module")
def exact() -> Readings:
    return sweeps.exact("parabola")


def shifted(exact: Readings, share: float, seconds: float) -> Readings:
    """With a moment that is too large by `share`."""
    table = exact.table.assign(moment_z=exact.table["moment_z"] * (1 + share))
    timed = {**exact.provenance, "seconds": seconds}
    return replace(exact, table=table, source="x", provenance=timed)


def test_known_shifts_come_out(exact):
    moment, foot_x = exact.values("moment_z"), exact.values("foot_x")
    ahead = foot_x - exact.snap_off > Tolerances().snap_off_window * np.ptp(foot_x)
    compared = moment[ahead & (exact.values("force_y") > 0)]
    rms = np.sqrt(np.mean(compared**2)) / np.abs(moment).max()
    found = SideBySide.of(exact, {"a": shifted(exact, 1e-3, 6.0), "b": shifted(exact, -2e-3, 12.0)})
    pairs = [*found.against.values(), *found.between.values()]
    assert [*found.against, *found.between] == ["a", "b", ("a", "b")]
    off = [one.disagreement["moment_z"].rms for one in pairs]
    np.testing.assert_allclose(off, rms * np.array([1e-3, 2e-3, 3e-3]), rtol=5e-3)
    for one in pairs:
        assert one.disagreement["force_x"].rms == one.disagreement["force_y"].rms == 0
        assert one.snap_off.difference == 0
    times = [one.seconds_a_station for one in found.outcomes]
    np.testing.assert_allclose(times, [0.1, 0.2])


def test_what_is_compared_is_there_and_given_once(exact, tmp_path):
    shifted(exact, 1e-3, 6.0).write(tmp_path / "near.parquet")
    compare = ("compare", "parabola", "near.parquet")
    vibrissa(*compare, "no.parquet", cwd=tmp_path).refused("no.parquet")
    vibrissa(*compare, "near.parquet", cwd=tmp_path).refused("each file once")


@pytest.fixture(scope="module")
def many(exact):
    """A vibrissa 1 % too stiff, of an engine that records no time and had three bad stations."""
    table = exact.table.assign(**{name: 1.01 * exact.table[name] for name in CLAMP_READINGS})
    about = {"engine": "Mine 1.2", "unsettled": {"it sleeps": 2, "it slides": 1}}
    mine = replace(exact, table=table, source="mine", provenance=about)
    asked = [EngineOutcome("mine", "other model", "1.2", "nothing", None)]
    return SideBySide.of(exact, {"mine": mine}, asked, case="parabola")


def test_one_without_readings_is_not_said_to_disagree(exact):
    asked = [EngineOutcome("mine"), EngineOutcome("lost", trouble="not installed")]
    page = side_by_side_document(SideBySide.of(exact, {"mine": exact}, asked))
    assert page.verdict.good is False
    assert page.verdict.claim == "1 of 2 agrees with the closed form, 1 gave no readings."


def test_pictures_fit_a_telephone_and_a_time_needs_another(exact):
    def pictures(*names):
        asked = [EngineOutcome(name, "other model") for name in names]
        found = SideBySide.of(exact, dict.fromkeys(names, shifted(exact, 1e-3, 6.0)), asked)
        return {one.name: one.layout for one in side_by_side_document(found).pictures()}

    assert pictures("mine") == {"apart": "three"}
    assert pictures("mine", "yours") == {"time": "middle", "apart": "three"}


def test_of_few_settled_stations_there_are_no_figures(exact):
    """One station in contact may agree to any digit."""
    bad = exact.table.assign(status="unsettled")
    bad.loc[:20, "status"] = "ok"
    found = SideBySide.of(exact, {"mine": replace(exact, table=bad)}, [EngineOutcome("mine")])
    (one,) = found.outcomes
    assert one.rms is None
    assert one.likely.startswith("no figures: ")
    assert "stations can be compared" in one.likely


@pytest.mark.slow
def test_cause_and_lack_of_time_are_in_table_page_and_picture(many):
    (row,) = outcomes_table({many.case: many.outcomes}).rows
    assert row[0] == "mine 1.2, other model"
    assert row[-1] == "none"
    assert row[1] == "disagrees"
    (listed,) = reasons(many.outcomes)
    (why,) = listed.said
    assert why.startswith("mine: likely ")
    assert why.endswith("3 stations unsettled, mostly as it sleeps")
    assert why in html(side_by_side_document(many)).replace("&#39;", "'")
    figure = error_against_time(many)
    assert len(figure.axes[0].lines) == len(CLAMP_READINGS)
    assert [text.get_text() for text in figure.axes[0].texts] == ["mine, no time"]
    figure.canvas.draw()
